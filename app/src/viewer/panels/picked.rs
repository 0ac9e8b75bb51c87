//! The card of the particle that was picked: where it is, all its values, and whether it is followed.

use egui::{Align, Layout, Pos2, Rect, RichText, ScrollArea, Ui, pos2};

use crate::viewer::icons::{self, Icon};
use crate::viewer::inspect::tracked::{Mark, Tracked};
use crate::viewer::session::Session;
use crate::viewer::theme;
use crate::viewer::widgets;

const WIDTH: f32 = 268.0;
/// From the edges of the picture, and from its right edge.
const MARGIN: f32 = 16.0;
const BESIDE_BAR: f32 = 140.0;
/// Of the list of values.
const HEIGHT: f32 = 260.0;

/// Shows the card over the picture, where a particle was picked.
pub fn show(ui: &Ui, session: &mut Session, picture: Rect) {
    if session.looking.picked.is_none() {
        return;
    }
    let at = corner(session, picture);
    widgets::card(ui, ["Picked particle", "picked"], at, WIDTH, |ui| card(ui, session));
}

/// Where the card opens: on the side of the picture where the particle is not.
fn corner(session: &Session, picture: Rect) -> Pos2 {
    let size = [picture.width(), picture.height()].map(f64::from);
    let picked = session.looking.picked.as_ref();
    let place = picked.and_then(|picked| session.projection(size)?.project(picked.particle.position()));
    let left = picture.left() + MARGIN;
    // Beside the colour bar, which stands at the right edge.
    let right = (picture.right() - WIDTH - BESIDE_BAR).max(left);
    let on_the_left = place.is_some_and(|place| place.at.x < 0.5 * size[0]);
    pos2(if on_the_left { right } else { left }, picture.top() + MARGIN)
}

/// What is on the card.
pub fn card(ui: &mut Ui, session: &mut Session) {
    let scale = session.scene_bounds().map_or(0.0, |scene| scene.diagonal());
    let Some(picked) = &mut session.looking.picked else { return };
    let open = header(ui, &picked.particle);
    if picked.particle.lost {
        let text = "This frame has no such particle; shown as it was last.";
        ui.label(RichText::new(text).small().color(theme::colours().warning));
    }
    ScrollArea::vertical().max_height(HEIGHT).show(ui, |ui| values(ui, &picked.particle, scale));
    ui.add_space(4.0);
    let hint = match picked.particle.mark {
        Mark::Id(_) => "Finds it by its id in every frame; otherwise the card closes with the frame",
        Mark::Row(_) => {
            "Takes the same row of every frame: the file has no ids, so another frame may have another particle there"
        }
    };
    ui.checkbox(&mut picked.follow, "Follow through the frames").on_hover_text(hint);
    let mut keep = picked.in_the_middle;
    let hint = "Turns the camera to it, and takes the camera along from frame to frame";
    let changed = ui.checkbox(&mut keep, "Keep in the middle").on_hover_text(hint).changed();
    if changed {
        session.keep_in_the_middle(keep);
    }
    if !open {
        session.looking.picked = None;
    }
}

/// Title and cross. Returns whether the card stays.
fn header(ui: &mut Ui, picked: &Tracked) -> bool {
    let (title, known) = match picked.mark {
        Mark::Id(id) => (format!("Particle {id}"), "known by its id"),
        Mark::Row(row) => (format!("Row {row}"), "known by its row: the file has no ids"),
    };
    let open = ui
        .horizontal(|ui| {
            ui.label(RichText::new(title).heading().strong());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                !icons::button(ui, Icon::Cross, "Close (Escape)", true).clicked()
            })
            .inner
        })
        .inner;
    let text = format!("Frame {}, row {}, {known}", picked.index, picked.row);
    ui.label(RichText::new(text).small().color(theme::colours().muted));
    open
}

fn values(ui: &mut Ui, picked: &Tracked, scale: f64) {
    let frame = &picked.frame;
    for (axis, x) in ["x", "y", "z"].into_iter().zip(picked.position().to_array()) {
        widgets::fact(ui, axis, widgets::on_scale(x, scale));
    }
    for field in frame.fields() {
        let column = &field.column;
        let row = (0..column.components()).map(|c| column.get(picked.row, c));
        match column.components() {
            // In full: an id of which digits are missing is no id.
            1 if crate::frames::names::canonical(&field.name) == "id" => {
                widgets::fact(ui, &field.name, format!("{}", column.get(picked.row, 0)));
            }
            1 => {
                widgets::fact(ui, &field.name, widgets::short(column.get(picked.row, 0)));
            }
            _ => {
                widgets::fact(ui, &field.name, widgets::short(column.magnitude(picked.row)));
                let parts: Vec<String> = row.map(widgets::short).collect();
                widgets::fact(ui, "", parts.join("  "));
            }
        }
    }
}
