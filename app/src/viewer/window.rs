//! The window itself: winit's events to egui, egui's shapes to the screen.

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use egui::epaint::ImageDelta;
use egui::{TextureId, TextureOptions, ViewportId, ViewportInfo};
use egui_winit::accesskit_winit;
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::{KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Fullscreen, Window, WindowId};

use super::brush::Brush;
use super::desk::{Desk, Order};
use super::{Options, Wake, theme};

/// What comes to the window from elsewhere.
enum Event {
    /// Another thread has something new.
    Wake,
    Accessibility(accesskit_winit::Event),
}

impl From<accesskit_winit::Event> for Event {
    fn from(event: accesskit_winit::Event) -> Event {
        Event::Accessibility(event)
    }
}

/// Why there is no window, and what to do about it.
fn no_display(error: impl std::fmt::Display) -> anyhow::Error {
    // winit puts the place in its own source first.
    let text = error.to_string();
    let why = text.rsplit(": ").next().unwrap_or_default().trim_end_matches('.');
    anyhow!(
        "display: no window can be opened ({why}): run it in a graphical session, or draw without a window: \
         sphcast render FILE --out picture.png"
    )
}

/// Why the window is gone.
fn display_gone() -> anyhow::Error {
    anyhow!(
        "display: the desktop has closed the connection: the session is kept, and the start page offers it when \
         sphcast is started again"
    )
}

pub fn run(options: Options) -> anyhow::Result<()> {
    let events = EventLoop::<Event>::with_user_event().build();
    let events = events.map_err(no_display)?;
    let mut app =
        App { state: State::Waiting(Some(Box::new(options))), proxy: events.create_proxy(), failure: None };
    let ended = events.run_app(&mut app);
    let was_open = matches!(app.state, State::Open(_));
    ended.map_err(|error| if was_open { display_gone() } else { no_display(error) })?;
    app.failure.map_or(Ok(()), Err)
}

struct App {
    state: State,
    proxy: EventLoopProxy<Event>,
    /// Why the window had to close.
    failure: Option<anyhow::Error>,
}

enum State {
    /// Until the system says that windows may be opened.
    Waiting(Option<Box<Options>>),
    Open(Box<Open>),
}

/// An open window.
struct Open {
    // In this order they are dropped: the surface goes before its window.
    glass: Glass,
    desk: Desk,
    window: Arc<Window>,
    wake: Wake,
    next: Option<Instant>,
    title: String,
}

/// egui and what draws it.
struct Glass {
    brush: Brush,
    input: egui_winit::State,
    context: egui::Context,
    info: ViewportInfo,
}

impl ApplicationHandler<Event> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        let State::Waiting(options) = &mut self.state else { return };
        let Some(options) = options.take() else { return };
        match Open::new(events, *options, self.proxy.clone()) {
            Ok(open) => self.state = State::Open(Box::new(open)),
            Err(error) => {
                self.failure = Some(error);
                events.exit();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let State::Open(open) = &mut self.state else { return };
        if let Err(error) = open.handle(events, &event) {
            self.failure = Some(error);
            events.exit();
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, event: Event) {
        let State::Open(open) = &mut self.state else { return };
        if let Event::Accessibility(event) = event {
            open.glass.accessibility(event);
        }
        open.window.request_redraw();
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let State::Open(open) = &mut self.state else { return };
        match open.next {
            Some(next) if next <= Instant::now() => {
                open.next = None;
                open.window.request_redraw();
            }
            Some(next) => events.set_control_flow(ControlFlow::WaitUntil(next)),
            None => events.set_control_flow(ControlFlow::Wait),
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        if let State::Open(open) = &mut self.state {
            // Ending a picture in work takes a moment that nobody needs to watch.
            open.window.set_visible(false);
            open.desk.close();
        }
    }
}

impl Open {
    fn new(events: &ActiveEventLoop, options: Options, proxy: EventLoopProxy<Event>) -> anyhow::Result<Open> {
        let attributes = Window::default_attributes()
            .with_title("sphcast")
            .with_inner_size(LogicalSize::new(1280.0, 800.0))
            .with_min_inner_size(LogicalSize::new(640.0, 420.0))
            .with_visible(false);
        let window = Arc::new(events.create_window(attributes).map_err(no_display)?);
        let sender = proxy.clone();
        // The window is gone when nobody listens.
        let wake: Wake = Arc::new(move || drop(sender.send_event(Event::Wake)));
        let glass = Glass::new(events, &window, proxy, &wake)?;
        let desk = Desk::new(options, Wake::clone(&wake));
        window.set_visible(true);
        window.request_redraw();
        Ok(Open { glass, desk, window, wake, next: None, title: String::new() })
    }

    fn handle(&mut self, events: &ActiveEventLoop, event: &WindowEvent) -> anyhow::Result<()> {
        match event {
            WindowEvent::RedrawRequested => return self.redraw(events),
            WindowEvent::CloseRequested => {
                self.desk.quit();
                self.window.request_redraw();
                return Ok(());
            }
            WindowEvent::Destroyed => {
                events.exit();
                return Ok(());
            }
            WindowEvent::Resized(size) => {
                self.glass.brush.resize(*size);
                self.window.request_redraw();
            }
            WindowEvent::KeyboardInput { event, .. } if self.desk.log_events && takes_device(event) => {
                self.glass.brush.lose();
            }
            _ => {}
        }
        if self.glass.input.on_window_event(&self.window, event).repaint {
            self.window.request_redraw();
        }
        Ok(())
    }

    fn redraw(&mut self, events: &ActiveEventLoop) -> anyhow::Result<()> {
        if self.glass.brush.is_lost() {
            self.glass.renew_brush(events, &self.window, &self.wake)?;
            self.desk.picture_lost();
        }
        let delay = self.glass.draw(&self.window, &mut self.desk);
        for order in std::mem::take(&mut self.desk.orders) {
            match order {
                Order::Quit => events.exit(),
                Order::PasteCamera => self.desk.paste_camera(self.glass.input.clipboard_text()),
                Order::Copy(text) => self.glass.input.set_clipboard_text(text),
                Order::FullScreen => {
                    let full = self.window.fullscreen().is_none().then_some(Fullscreen::Borderless(None));
                    self.window.set_fullscreen(full);
                }
            }
        }
        let title = self.desk.title();
        if title != self.title {
            self.window.set_title(&title);
            self.title = title;
        }
        if delay.is_zero() {
            self.window.request_redraw();
        }
        let asked = Instant::now().checked_add(delay).filter(|_| delay < Duration::from_secs(3600));
        self.next = [asked, self.desk.due].into_iter().flatten().min();
        Ok(())
    }
}

impl Glass {
    fn new(
        events: &ActiveEventLoop,
        window: &Arc<Window>,
        proxy: EventLoopProxy<Event>,
        wake: &Wake,
    ) -> anyhow::Result<Glass> {
        let context = egui::Context::default();
        theme::apply(&context);
        let brush = Brush::new(&context, events, window, wake)?;
        let scale = window.scale_factor() as f32;
        let largest = brush.largest_texture();
        let mut input =
            egui_winit::State::new(context.clone(), ViewportId::ROOT, events, Some(scale), None, largest);
        input.init_accesskit(events, window, proxy);
        Ok(Glass { brush, input, context, info: ViewportInfo::default() })
    }

    /// Goes on with another device. All else stays: what is open and where, the keyboard, screen readers.
    fn renew_brush(
        &mut self,
        events: &ActiveEventLoop,
        window: &Arc<Window>,
        wake: &Wake,
    ) -> anyhow::Result<()> {
        self.brush.let_go_of_window();
        self.brush = Brush::new(&self.context, events, window, wake)?;
        if let Some(largest) = self.brush.largest_texture() {
            self.input.set_max_texture_side(largest);
        }
        // egui hands a painter only the letters that are new to it.
        let letters = ImageDelta::full(self.context.fonts(|fonts| fonts.image()), TextureOptions::LINEAR);
        self.context.tex_manager().write().set(TextureId::default(), letters);
        Ok(())
    }

    /// Draws one frame of the window. Returns after what time egui wants the next one.
    fn draw(&mut self, window: &Arc<Window>, desk: &mut Desk) -> Duration {
        egui_winit::update_viewport_info(&mut self.info, &self.context, window, false);
        let mut raw = self.input.take_egui_input(window);
        raw.viewports.insert(ViewportId::ROOT, self.info.clone());
        let mut output = self.context.run_ui(raw, |ui| desk.frame(ui, window));
        self.input.handle_platform_output(window, output.platform_output);
        let primitives = self.context.tessellate(output.shapes, output.pixels_per_point);
        self.brush.paint(window, output.pixels_per_point, &primitives, &mut output.textures_delta);
        let root = output.viewport_output.get(&ViewportId::ROOT);
        root.map_or(Duration::MAX, |viewport| viewport.repaint_delay)
    }

    fn accessibility(&mut self, event: accesskit_winit::Event) {
        use accesskit_winit::WindowEvent::{AccessibilityDeactivated, ActionRequested, InitialTreeRequested};
        match event.window_event {
            InitialTreeRequested => self.context.enable_accesskit(),
            ActionRequested(request) => self.input.on_accesskit_action_request(request),
            AccessibilityDeactivated => self.context.disable_accesskit(),
        }
    }
}

/// Whether this is the key by which a test takes the window's device away.
fn takes_device(event: &KeyEvent) -> bool {
    event.state.is_pressed() && event.logical_key == Key::Named(NamedKey::F12)
}
