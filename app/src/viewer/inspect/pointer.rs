//! Pointing into the picture: what is seen under the mouse, the particle that was picked, and a
//! distance, drawn over it.

use egui::{
    Align2, Color32, CursorIcon, FontId, Painter, PointerButton, Pos2, Rect, Response, Stroke, Ui, vec2,
};
use glam::DVec3;

use crate::projection::Projection;
use crate::viewer::inspect::pointing::{Pointed, Seen};
use crate::viewer::inspect::tracked::Mark;
use crate::viewer::session::{End, Session, Tool};
use crate::viewer::{theme, widgets};

/// Of the ring around a particle, in points.
const RING: f32 = 7.0;

/// Takes the place under the mouse, and the one that was clicked on.
pub fn point(ui: &Ui, response: &Response, picture: Rect, session: &mut Session) {
    let share = |place: Pos2| {
        let share = (place - picture.min) / picture.size();
        [share.x, share.y].map(f64::from)
    };
    let free = response.hovered() && !ui.input(|input| input.pointer.any_down());
    let hover = response.hover_pos().filter(|place| free && picture.contains(*place));
    session.looking.hover = hover.map(share);
    if hover.is_some() {
        ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
    }
    let clicked = response.clicked_by(PointerButton::Primary);
    let place = response.interact_pointer_pos().filter(|place| clicked && picture.contains(*place));
    if let Some(place) = place {
        session.looking.click(share(place));
    }
}

/// Draws all that is to be seen of it.
pub fn show(ui: &Ui, picture: Rect, session: &Session) {
    let Some(projection) = session.projection([picture.width(), picture.height()].map(f64::from)) else {
        return;
    };
    let over = Over { painter: ui.painter_at(picture), picture, projection };
    let looking = &session.looking;
    let pointed = looking.pointed.as_ref().filter(|_| looking.hover.is_some());
    let target = pointed.and_then(|pointed| pointed.seen.as_ref());
    distance(&over, session, target);
    if let Some(picked) = looking.picked.as_ref().map(|picked| &picked.particle).filter(|picked| !picked.lost)
        && let Some(at) = over.place(picked.position())
    {
        over.ring(at, RING + 2.0, theme::DARK.accent, 2.0);
        let name = match picked.mark {
            Mark::Id(id) => format!("id {id}"),
            Mark::Row(row) => format!("row {row}"),
        };
        over.text(at + vec2(RING + 6.0, 0.0), Align2::LEFT_CENTER, &name);
    }
    if let (Some(pointed), Some(cursor)) = (pointed, ui.input(|input| input.pointer.latest_pos())) {
        over.around(target);
        tip(&over, cursor, &words(session, pointed));
    }
}

/// What is told beside the mouse.
fn words(session: &Session, pointed: &Pointed) -> String {
    let Some(Seen { point, value, opacity, near }) = &pointed.seen else {
        return "Nothing is to be seen here".to_owned();
    };
    let quantity = session.shown_quantity().unwrap_or_else(|| "value".to_owned());
    let scale = session.scene_bounds().map_or(0.0, |scene| scene.diagonal());
    let place = point.to_array().map(|x| widgets::on_scale(x, scale)).join(", ");
    let nearest = near.first().map_or_else(String::new, |near| {
        let frame = &pointed.shot.frame;
        let id = frame.field("id").map(|ids| ids.column.get(near.row, 0));
        match id {
            Some(id) => format!("\nnearest: id {id}, {} away", widgets::on_scale(near.distance, scale)),
            None => format!("\nnearest: row {}, {} away", near.row, widgets::on_scale(near.distance, scale)),
        }
    });
    let opacity = opacity.as_ref();
    let opacity = opacity
        .map_or_else(String::new, |(name, value)| format!("\n{name} {} (opacity)", widgets::short(*value)));
    let met = widgets::count(pointed.met as u64);
    format!(
        "{quantity} {}{opacity}\nat {place}{nearest}\n{met} particles along the ray",
        widgets::short(*value)
    )
}

/// A card beside the mouse, inside the picture.
fn tip(over: &Over, cursor: Pos2, text: &str) {
    let galley = over.painter.layout_no_wrap(text.to_owned(), theme::small_font(), theme::DARK.text);
    let size = galley.size() + vec2(16.0, 12.0);
    let mut corner = cursor + vec2(16.0, 16.0);
    if corner.x + size.x > over.picture.right() {
        corner.x = cursor.x - 12.0 - size.x;
    }
    if corner.y + size.y > over.picture.bottom() {
        corner.y = cursor.y - 12.0 - size.y;
    }
    let card = Rect::from_min_size(corner.max(over.picture.min), size);
    over.painter.rect_filled(card, 5, Color32::from_black_alpha(200));
    over.painter.galley(card.min + vec2(8.0, 6.0), galley, theme::DARK.text);
}

/// The line between the ends of a distance; to what is under the mouse while there is one end.
fn distance(over: &Over, session: &Session, target: Option<&Seen>) {
    let looking = &session.looking;
    let at_particles = looking.distance.at_particles;
    let next = target.filter(|_| looking.holds(Tool::Measure)).map(|seen| match seen.near.first() {
        Some(near) if at_particles => near.position,
        _ => seen.point,
    });
    if looking.distance.ends.iter().any(End::is_lost) {
        return;
    }
    let mut ends: Vec<DVec3> = looking.distance.ends.iter().map(End::position).collect();
    if ends.len() == 1 {
        ends.extend(next);
    }
    for end in &ends {
        if let Some(at) = over.place(*end) {
            over.painter.circle_filled(at, 4.5, Color32::from_black_alpha(190));
            over.painter.circle_filled(at, 3.0, theme::DARK.warning);
        }
    }
    if let [from, to] = ends[..]
        && let Some([a, b]) = over.projection.segment(from, to)
    {
        let [a, b] = [a, b].map(|at| over.on_screen(at));
        over.painter.line_segment([a, b], Stroke::new(3.5, Color32::from_black_alpha(170)));
        over.painter.line_segment([a, b], Stroke::new(1.5, theme::DARK.warning));
        over.text(
            a + 0.5 * (b - a) + vec2(0.0, -10.0),
            Align2::CENTER_BOTTOM,
            &widgets::short(from.distance(to)),
        );
    }
}

/// The picture that is drawn over.
struct Over {
    painter: Painter,
    picture: Rect,
    projection: Projection,
}

impl Over {
    fn on_screen(&self, at: glam::DVec2) -> Pos2 {
        self.picture.min + vec2(at.x as f32, at.y as f32)
    }

    fn place(&self, point: DVec3) -> Option<Pos2> {
        self.projection.project(point).map(|place| self.on_screen(place.at))
    }

    /// A light ring in a dark one, which is seen on any ground.
    fn ring(&self, at: Pos2, radius: f32, colour: Color32, width: f32) {
        self.painter.circle_stroke(at, radius, Stroke::new(width + 2.0, Color32::from_black_alpha(190)));
        self.painter.circle_stroke(at, radius, Stroke::new(width, colour));
    }

    /// The place that is seen, and the particles around it.
    fn around(&self, seen: Option<&Seen>) {
        let Some(Seen { point, near, .. }) = seen else { return };
        for (number, near) in near.iter().enumerate().rev() {
            let Some(at) = self.place(near.position) else { continue };
            match number {
                0 => self.ring(at, RING, Color32::WHITE, 1.5),
                _ => {
                    self.painter.circle_filled(at, 2.4, Color32::from_black_alpha(190));
                    self.painter.circle_filled(at, 1.4, Color32::from_white_alpha(220));
                }
            }
        }
        if let Some(at) = self.place(*point) {
            for (stroke, colour) in [(3.0, Color32::from_black_alpha(190)), (1.2, Color32::WHITE)] {
                self.painter
                    .line_segment([at - vec2(5.0, 0.0), at + vec2(5.0, 0.0)], Stroke::new(stroke, colour));
                self.painter
                    .line_segment([at - vec2(0.0, 5.0), at + vec2(0.0, 5.0)], Stroke::new(stroke, colour));
            }
        }
    }

    /// Text on a dark ground.
    fn text(&self, at: Pos2, align: Align2, text: &str) {
        let galley =
            self.painter.layout_no_wrap(text.to_owned(), FontId::proportional(12.5), theme::DARK.text);
        let rect = align.anchor_size(at, galley.size());
        self.painter.rect_filled(rect.expand2(vec2(4.0, 1.0)), 3, Color32::from_black_alpha(170));
        self.painter.galley(rect.min, galley, theme::DARK.text);
    }
}
