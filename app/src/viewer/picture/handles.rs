//! Clips in the picture: their outlines, and handles to drag them by.

mod clip_box;
mod clip_plane;
mod reach;

use egui::{Color32, CursorIcon, Id, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};
use glam::DVec2;
use renderer::{Bounds, ClipBox, ClipPlane};

use crate::projection::Projection;
use crate::viewer::session::Session;
use crate::viewer::theme;
use crate::viewer::widgets::Areas;

/// The handles, and the one that is dragged.
pub struct Handles {
    /// Whether they are wanted.
    pub shown: bool,
    grab: Option<Grab>,
}

/// A clip as it was when its handle was taken hold of, and where that was.
#[derive(Clone, Copy)]
enum Grab {
    Box(clip_box::Part, ClipBox, DVec2),
    Plane(clip_plane::Part, ClipPlane, DVec2),
}

/// Of a dot, in points, and of the place around it that can be taken hold of.
const DOT: f32 = 5.5;
const REACH: f32 = 18.0;
/// Of the axes x, y, z, as in the corner of the picture.
const AXES: [Color32; 3] =
    [Color32::from_rgb(226, 106, 98), Color32::from_rgb(122, 190, 110), Color32::from_rgb(98, 152, 226)];

const SIDES: [[&str; 2]; 3] =
    [["Box side −X", "Box side +X"], ["Box side −Y", "Box side +Y"], ["Box side −Z", "Box side +Z"]];
const MIDDLE: &str = "Middle of the box";
const FOOT: &str = "Foot of the plane's arrow";
const TIP: &str = "Tip of the plane's arrow";

impl Default for Handles {
    fn default() -> Handles {
        Handles { shown: true, grab: None }
    }
}

impl Handles {
    /// Shows the clips that are on over the picture, and moves what is dragged.
    pub fn show(&mut self, ui: &mut Ui, picture: Rect, session: &mut Session) {
        let Some((projection, scene)) = session
            .projection([picture.width(), picture.height()].map(f64::from))
            .zip(session.scene_bounds())
        else {
            return;
        };
        if !self.shown {
            return;
        }
        if !ui.input(|input| input.pointer.any_down()) {
            self.grab = None;
        }
        let place = Over { picture, projection, scene };
        // Only what the program knows of a scene can be large: a clip of the user's may be anything.
        let select = &mut session.view.select;
        if let Some(clip) = select.clip_box.as_mut().filter(|clip| clip.on) {
            self.clip_box(ui, &place, clip);
        }
        if let Some(clip) = select.clip_plane.as_mut().filter(|clip| clip.on) {
            self.clip_plane(ui, &place, clip);
        }
    }

    fn clip_box(&mut self, ui: &mut Ui, over: &Over, clip: &mut ClipBox) {
        if let Some(Grab::Box(part, before, from)) = self.grab
            && let Some(to) = over.cursor(ui)
            && let Some(dragged) = part.drag(&before, &over.projection, [from, to])
        {
            *clip = dragged;
        }
        let painter = ui.painter_at(over.picture);
        for (ends, hidden) in clip_box::edges(clip, &over.projection) {
            over.line(&painter, ends, if hidden { 0.35 } else { 1.0 });
        }
        for part in clip_box::Part::all() {
            let (name, colour) = match part {
                clip_box::Part::Side(axis, end) => (SIDES[axis][usize::from(end)], AXES[axis]),
                clip_box::Part::Middle => (MIDDLE, theme::DARK.text),
            };
            let Some(at) = over.projection.project(part.place(clip)) else { continue };
            if let Some(from) = self.dot(ui, over, at.at, name, colour) {
                self.grab = Some(Grab::Box(part, *clip, from));
            }
        }
    }

    fn clip_plane(&mut self, ui: &mut Ui, over: &Over, clip: &mut ClipPlane) {
        if let Some(Grab::Plane(part, before, from)) = self.grab
            && let Some(to) = over.cursor(ui)
            && let Some(dragged) = part.drag(&before, &over.scene, &over.projection, [from, to])
        {
            *clip = dragged;
        }
        let Some(arrow) = clip_plane::Arrow::new(clip, &over.scene) else { return };
        let painter = ui.painter_at(over.picture);
        let corners = clip_plane::outline(clip, &over.scene);
        for (corner, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            if let Some(ends) = over.projection.segment(*corner, *next) {
                over.line(&painter, ends, 1.0);
            }
        }
        let Some(ends) = over.projection.segment(arrow.foot, arrow.tip()) else { return };
        over.line(&painter, ends, 1.0);
        let [foot, tip] = ends;
        if let Some(from) = self.dot(ui, over, foot, FOOT, theme::DARK.text) {
            self.grab = Some(Grab::Plane(clip_plane::Part::Foot, *clip, from));
        }
        if let Some(from) = self.dot(ui, over, tip, TIP, theme::DARK.accent) {
            self.grab = Some(Grab::Plane(clip_plane::Part::Tip, *clip, from));
        }
    }

    /// A dot to take hold of. Returns where the cursor is when that happens.
    fn dot(&self, ui: &mut Ui, over: &Over, at: DVec2, name: &'static str, colour: Color32) -> Option<DVec2> {
        let centre = over.on_screen(at);
        if !over.picture.expand(DOT).contains(centre) {
            return None;
        }
        let rect = Rect::from_center_size(centre, vec2(REACH, REACH));
        let response = ui.interact(rect, Id::unique(("handle", name)), Sense::drag()).accessible_name(name);
        Areas::mark(ui, name, rect);
        let active = response.hovered() || response.dragged();
        if active {
            let icon = if response.dragged() { CursorIcon::Grabbing } else { CursorIcon::Grab };
            ui.ctx().set_cursor_icon(icon);
        }
        let painter = ui.painter_at(over.picture);
        let radius = if active { DOT + 1.5 } else { DOT };
        painter.circle_filled(centre, radius + 1.5, Color32::from_black_alpha(190));
        painter.circle_filled(centre, radius, if active { Color32::WHITE } else { colour });
        let started = response.drag_started_by(egui::PointerButton::Primary);
        response.on_hover_text(hint(name));
        started.then(|| over.cursor(ui)).flatten()
    }
}

fn hint(name: &str) -> &'static str {
    match name {
        MIDDLE => "Drag to move the clip box",
        FOOT => "Drag to move the clip plane along its normal",
        TIP => "Drag to turn the clip plane; the arrow points to the side that is kept",
        _ => "Drag to move this side of the clip box",
    }
}

/// The picture that handles are over.
struct Over {
    picture: Rect,
    projection: Projection,
    scene: Bounds,
}

impl Over {
    fn on_screen(&self, at: DVec2) -> Pos2 {
        self.picture.min + vec2(at.x as f32, at.y as f32)
    }

    fn cursor(&self, ui: &Ui) -> Option<DVec2> {
        let place = ui.input(|input| input.pointer.latest_pos())? - self.picture.min;
        Some(DVec2::new(f64::from(place.x), f64::from(place.y)))
    }

    /// A light line in a dark one, which is seen on any ground.
    fn line(&self, painter: &Painter, ends: [DVec2; 2], strength: f32) {
        let ends = ends.map(|end| self.on_screen(end)).map(|Pos2 { x, y }| pos2(x, y));
        let dark = Color32::from_black_alpha(150).gamma_multiply(strength);
        let light = Color32::from_white_alpha(225).gamma_multiply(strength);
        painter.add(Shape::line_segment(ends, Stroke::new(3.0, dark)));
        painter.add(Shape::line_segment(ends, Stroke::new(1.2, light)));
    }
}
