//! The picture in the window, and what the mouse does over it.

use egui::{
    Color32, ColorImage, CursorIcon, PointerButton, Pos2, Rect, Response, Sense, Stroke, StrokeKind,
    TextureHandle, TextureOptions, Ui, pos2, vec2,
};
use glam::{DVec2, DVec3};

use crate::viewer::inspect::pointer;
use crate::viewer::orbit_camera::{OrbitCamera, Screen};
use crate::viewer::panels::probe;
use crate::viewer::picture::handles::Handles;
use crate::viewer::picture::layers::Layers;
use crate::viewer::picture::overlay::Overlay;
use crate::viewer::session::{Session, Tool};
use crate::viewer::widgets::Areas;
use crate::viewer::{accessible, theme};

/// The picture as a texture, and what the mouse does over it.
pub struct PictureView {
    pub layers: Layers,
    pub handles: Handles,
    texture: Option<TextureHandle>,
    pub motion: Motion,
    /// Speed of flying, in shares of the scene's radius a second.
    speed: f64,
}

/// What the mouse and the keys do to the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motion {
    #[default]
    Orbit,
    /// Where the camera looks.
    Fly,
    /// At one height.
    Walk,
}

impl Motion {
    /// Turns `motion` on, or off where it is on.
    pub fn toggle(&mut self, motion: Motion) {
        *self = if *self == motion { Motion::Orbit } else { motion };
    }
}

/// Factor of a zoom for each point of the wheel: one notch is about a tenth.
const WHEEL: f64 = 0.002;
const FLY_SPEEDS: [f64; 2] = [0.01, 10.0];

impl PictureView {
    pub fn new() -> PictureView {
        PictureView {
            layers: Layers::default(),
            handles: Handles::default(),
            texture: None,
            motion: Motion::Orbit,
            speed: 0.5,
        }
    }

    /// Has in the texture what is to be seen: nearest pixels at full resolution, which is the screen's
    /// own; smooth below.
    fn refresh(&mut self, context: &egui::Context, overlay: &Overlay) {
        let Some(image) = self.layers.refresh(overlay) else { return };
        let options = if image.divisor == 1 { TextureOptions::NEAREST } else { TextureOptions::LINEAR };
        let pixels = image.pixels.iter().map(|&[r, g, b, _]| Color32::from_rgb(r, g, b)).collect();
        let image = ColorImage::new(image.size, pixels);
        match &mut self.texture {
            Some(texture) => texture.set(image, options),
            None => self.texture = Some(context.load_texture("picture", image, options)),
        }
    }

    /// Forgets the picture, when another run is opened.
    pub fn clear(&mut self) {
        self.texture = None;
        self.layers = Layers::default();
    }

    /// Room for a picture in `rect`, in physical pixels.
    pub fn room(rect: Rect, pixels_per_point: f32) -> [u32; 2] {
        [rect.width(), rect.height()].map(|side| (side * pixels_per_point).floor().max(0.0) as u32)
    }

    /// Shows the picture and moves the camera. Returns the picture's place.
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) -> Rect {
        let outer = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(outer, Sense::click_and_drag());
        accessible::drawing(&response, "Picture");
        ui.painter().rect_filled(outer, 0, theme::colours().ground);
        let rect = place(outer, session.fitted(), ui.pixels_per_point());
        Areas::mark(ui, "picture", rect);
        self.refresh(ui.ctx(), &session.overlay);
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            ui.painter().image(texture.id(), rect, whole, Color32::WHITE);
        }
        if !session.fits_window {
            // Where the saved picture ends.
            ui.painter().rect_stroke(rect, 0, Stroke::new(1.0, theme::colours().line), StrokeKind::Outside);
        }
        self.steer(ui, &response, rect, session);
        self.handles.show(ui, rect, session);
        match session.looking.tool {
            Some(Tool::Inspect) => probe::pick(ui, &response, rect, session),
            Some(Tool::Pick | Tool::Measure) => pointer::point(ui, &response, rect, session),
            None => {}
        }
        pointer::show(ui, rect, session);
        probe::mark(ui, rect, session);
        rect
    }

    /// Turns mouse and keys into movements of the camera.
    fn steer(&mut self, ui: &Ui, response: &Response, rect: Rect, session: &mut Session) {
        let Some(camera) = &mut session.camera else { return };
        let before = *camera;
        let screen = Screen { width: f64::from(rect.width()), height: f64::from(rect.height()) };
        let cursor = |position: Pos2| {
            DVec2::new(f64::from(position.x - rect.left()), f64::from(position.y - rect.top()))
        };
        let delta = response.drag_delta();
        let delta = DVec2::new(f64::from(delta.x), f64::from(delta.y));
        let modifiers = ui.input(|input| input.modifiers);
        let left = response.dragged_by(PointerButton::Primary);
        let other =
            response.dragged_by(PointerButton::Secondary) || response.dragged_by(PointerButton::Middle);
        match () {
            () if left && modifiers.shift && modifiers.command => {
                if let Some(to) = response.interact_pointer_pos().map(cursor) {
                    camera.roll_with(to - delta, to, screen);
                }
            }
            () if other || (left && modifiers.shift) => camera.pan(delta, screen),
            () if left && modifiers.command => camera.zoom((delta.y * 0.01).exp(), None, screen),
            () if left && self.motion != Motion::Orbit => camera.look(delta, screen),
            () if left => camera.orbit(delta, screen),
            () => {}
        }
        if left || other {
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        if response.double_clicked()
            && session.looking.tool.is_none()
            && let Some(position) = response.interact_pointer_pos()
        {
            camera.centre_on(cursor(position), screen);
        }
        if let Some(position) = response.hover_pos() {
            let (wheel, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = (-f64::from(wheel) * WHEEL).exp() / f64::from(pinch.max(1e-3));
            if factor != 1.0 && self.motion != Motion::Orbit {
                self.speed = (self.speed / factor).clamp(FLY_SPEEDS[0], FLY_SPEEDS[1]);
            } else if factor != 1.0 {
                camera.zoom(factor, Some(cursor(position)), screen);
            }
        }
        if self.motion != Motion::Orbit && !ui.ctx().egui_wants_keyboard_input() {
            self.fly(ui, camera);
        }
        if *camera != before {
            session.steered(std::time::Instant::now());
        }
    }

    fn fly(&self, ui: &Ui, camera: &mut OrbitCamera) {
        use egui::Key;
        let (steps, seconds) = ui.input(|input| {
            let axis = |plus: Key, minus: Key| {
                f64::from(u8::from(input.key_down(plus))) - f64::from(u8::from(input.key_down(minus)))
            };
            let steps = DVec3::new(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S));
            let faster = if input.modifiers.shift { 4.0 } else { 1.0 };
            let steps = if input.modifiers.command { DVec3::ZERO } else { faster * steps };
            (steps, f64::from(input.stable_dt.min(0.1)))
        });
        if steps != DVec3::ZERO {
            let steps = steps * self.speed * seconds;
            match self.motion {
                Motion::Walk => camera.walk(steps),
                Motion::Fly | Motion::Orbit => camera.fly(steps),
            }
            ui.ctx().request_repaint();
        }
    }

    /// Zooms to the centre by one step.
    pub fn zoom(&self, session: &mut Session, closer: bool) {
        let [width, height] = session.fitted().map(f64::from);
        if let Some(camera) = &mut session.camera {
            camera.zoom(if closer { 0.8 } else { 1.25 }, None, Screen { width, height });
        }
        session.steered(std::time::Instant::now());
    }

    /// Speed of flying, in scene radii a second.
    pub fn speed(&self) -> f64 {
        self.speed
    }
}

/// The picture's place in the middle of `outer`, on whole physical pixels.
fn place(outer: Rect, [width, height]: [u32; 2], pixels_per_point: f32) -> Rect {
    let size = vec2(width as f32, height as f32) / pixels_per_point;
    let corner = outer.min + 0.5 * (outer.size() - size).max(egui::Vec2::ZERO);
    let corner = (corner.to_vec2() * pixels_per_point).round() / pixels_per_point;
    Rect::from_min_size(corner.to_pos2(), size)
}
