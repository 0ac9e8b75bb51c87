//! The window itself: winit's events to egui, egui's shapes to the screen.

use std::num::NonZeroU32;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow};
use egui::{ViewportId, ViewportInfo};
use egui_wgpu::winit::Painter;
use egui_wgpu::{RendererOptions, WgpuConfiguration, WgpuSetup};
use egui_winit::accesskit_winit;
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Fullscreen, Window, WindowId};

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

pub fn run(options: Options) -> anyhow::Result<()> {
    let events = EventLoop::<Event>::with_user_event().build();
    let events = events.map_err(no_display)?;
    let mut app =
        App { state: State::Waiting(Some(Box::new(options))), proxy: events.create_proxy(), failure: None };
    events.run_app(&mut app).map_err(no_display)?;
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
    proxy: EventLoopProxy<Event>,
    next: Option<Instant>,
    title: String,
}

/// egui and what draws it; made anew when its device is lost.
struct Glass {
    painter: Painter,
    input: egui_winit::State,
    context: egui::Context,
    info: ViewportInfo,
    lost: Arc<AtomicBool>,
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
        if let State::Open(open) = &self.state {
            // Ending a picture in work takes a moment that nobody needs to watch.
            open.window.set_visible(false);
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
        let glass = Glass::new(events, &window, &proxy)?;
        let sender = proxy.clone();
        // The window is gone when nobody listens.
        let wake: Wake = Arc::new(move || drop(sender.send_event(Event::Wake)));
        let desk = Desk::new(options, wake);
        window.set_visible(true);
        window.request_redraw();
        Ok(Open { glass, desk, window, proxy, next: None, title: String::new() })
    }

    fn handle(&mut self, events: &ActiveEventLoop, event: &WindowEvent) -> anyhow::Result<()> {
        match event {
            WindowEvent::RedrawRequested => return self.redraw(events),
            WindowEvent::CloseRequested | WindowEvent::Destroyed => {
                events.exit();
                return Ok(());
            }
            WindowEvent::Resized(size) => {
                if let (Some(width), Some(height)) =
                    (NonZeroU32::new(size.width), NonZeroU32::new(size.height))
                {
                    self.glass.painter.on_window_resized(ViewportId::ROOT, width, height);
                }
                self.window.request_redraw();
            }
            _ => {}
        }
        if self.glass.input.on_window_event(&self.window, event).repaint {
            self.window.request_redraw();
        }
        Ok(())
    }

    fn redraw(&mut self, events: &ActiveEventLoop) -> anyhow::Result<()> {
        if self.glass.lost.load(Ordering::Relaxed) {
            self.glass = Glass::new(events, &self.window, &self.proxy)?;
            self.desk
                .session
                .messages
                .warn("the window's graphics device was lost and has been opened again");
            self.desk.forget_textures();
        }
        let delay = self.glass.draw(&self.window, &mut self.desk);
        for order in std::mem::take(&mut self.desk.orders) {
            match order {
                Order::Quit => events.exit(),
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
        self.next = [asked, self.desk.due()].into_iter().flatten().min();
        Ok(())
    }
}

impl Glass {
    fn new(
        events: &ActiveEventLoop,
        window: &Arc<Window>,
        proxy: &EventLoopProxy<Event>,
    ) -> anyhow::Result<Glass> {
        let context = egui::Context::default();
        theme::apply(&context);
        let configuration = WgpuConfiguration {
            wgpu_setup: WgpuSetup::from_display_handle(events.owned_display_handle()),
            ..WgpuConfiguration::default()
        };
        let options = RendererOptions::default();
        let mut painter = pollster::block_on(Painter::new(context.clone(), configuration, false, options));
        pollster::block_on(painter.set_window(ViewportId::ROOT, Some(Arc::clone(window)))).context(
            "adapter: no graphics adapter can draw in this window: install a Vulkan, Metal or DirectX 12 \
             driver (on Debian without a GPU: apt install mesa-vulkan-drivers)",
        )?;
        let lost = Arc::new(AtomicBool::new(false));
        if let Some(state) = painter.render_state() {
            watch(&state.device, &lost, proxy);
        }
        let scale = window.scale_factor() as f32;
        let largest = painter.max_texture_side();
        let mut input =
            egui_winit::State::new(context.clone(), ViewportId::ROOT, events, Some(scale), None, largest);
        input.init_accesskit(events, window, proxy.clone());
        Ok(Glass { painter, input, context, info: ViewportInfo::default(), lost })
    }

    /// Draws one frame of the window. Returns after what time egui wants the next one.
    fn draw(&mut self, window: &Arc<Window>, desk: &mut Desk) -> Duration {
        egui_winit::update_viewport_info(&mut self.info, &self.context, window, false);
        let mut raw = self.input.take_egui_input(window);
        raw.viewports.insert(ViewportId::ROOT, self.info.clone());
        let mut output = self.context.run_ui(raw, |ui| desk.frame(ui, window));
        self.input.handle_platform_output(window, output.platform_output);
        let primitives = self.context.tessellate(output.shapes, output.pixels_per_point);
        let ground = theme::GROUND.to_normalized_gamma_f32();
        self.painter.paint_and_update_textures(
            ViewportId::ROOT,
            output.pixels_per_point,
            ground,
            &primitives,
            &mut output.textures_delta,
            Vec::new(),
            window,
        );
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

/// Notes the loss of a device, and keeps errors of the driver from ending the program.
fn watch(device: &wgpu::Device, lost: &Arc<AtomicBool>, proxy: &EventLoopProxy<Event>) {
    let (flag, sender) = (Arc::clone(lost), proxy.clone());
    device.set_device_lost_callback(move |reason, _| {
        // A device that is dropped on purpose is not lost.
        if reason != wgpu::DeviceLostReason::Destroyed {
            flag.store(true, Ordering::Relaxed);
            drop(sender.send_event(Event::Wake));
        }
    });
    device.on_uncaptured_error(Arc::new(|error: wgpu::Error| log::error!("window: {error}")));
}
