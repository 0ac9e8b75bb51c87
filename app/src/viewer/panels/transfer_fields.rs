//! Numbers of the transfer function: those of the selected node, of what lies outside the range, and the
//! length that opacities belong to.

use egui::{RichText, Ui};
use renderer::OutsideView;

use crate::viewer::session::{Role, Session};
use crate::viewer::{theme, widgets};

use super::transfer_edit as edit;

/// A node of the function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Node {
    Opacity(usize),
    Colour(usize),
}

/// Numbers of the selected node. `fine`: whether opacities are dragged in proportion to their size.
pub fn node(ui: &mut Ui, session: &mut Session, selected: &mut Option<Node>, fine: bool) {
    match *selected {
        None => {
            let hint = "Select a node to edit its numbers; double click adds one, right click removes it.";
            ui.label(RichText::new(hint).small().color(theme::colours().faint));
        }
        Some(Node::Opacity(index)) => opacity_node(ui, session, selected, index, fine),
        Some(Node::Colour(index)) => colour_node(ui, session, selected, index),
    }
}

fn opacity_node(ui: &mut Ui, session: &mut Session, selected: &mut Option<Node>, index: usize, fine: bool) {
    let point = session.view.transfer.points[index];
    let moved = place(ui, session, session.role_of_opacity(), point.u);
    let transfer = &mut session.view.transfer;
    widgets::row(ui, "Opacity", |ui| {
        // Three things side by side.
        (ui.spacing_mut().interact_size.x, ui.spacing_mut().item_spacing.x) = (56.0, 4.0);
        let mut opacity = point.opacity;
        let field = ui.add(opacity_number(&mut opacity, fine)).accessible_name("Opacity");
        if field.changed() || moved.is_some() {
            edit::move_opacity(transfer, index, moved.unwrap_or(point.u), opacity);
        }
        if ui.button("Step").on_hover_text("Add a second node at the same value").clicked() {
            *selected = Some(Node::Opacity(edit::add_opacity(transfer, point.u, point.opacity)));
        }
        let removable = transfer.points.len() > 1;
        if ui.add_enabled(removable, egui::Button::new("Remove")).clicked() {
            edit::remove_opacity(transfer, index);
            *selected = None;
        }
    });
}

fn colour_node(ui: &mut Ui, session: &mut Session, selected: &mut Option<Node>, index: usize) {
    let Some(nodes) = edit::colour_nodes(&session.view.transfer) else { return };
    let moved = place(ui, session, Role::Colour, nodes[index].u);
    let transfer = &mut session.view.transfer;
    if let Some(u) = moved {
        edit::move_colour(transfer, index, u);
    }
    widgets::row(ui, "Colour", |ui| {
        let mut rgb = nodes[index].rgb;
        if ui.color_edit_button_rgb(&mut rgb).accessible_name("Colour").changed() {
            edit::paint_colour(transfer, index, rgb);
        }
        if ui.add_enabled(nodes.len() > 1, egui::Button::new("Remove")).clicked() {
            edit::remove_colour(transfer, index);
            *selected = None;
        }
    });
}

/// An opacity to as many digits as it has, however small it is. `fine`: whether it is dragged in proportion to
/// its size.
fn opacity_number(opacity: &mut f32, fine: bool) -> egui::DragValue<'_> {
    let speed = if fine { 0.02 * opacity.max(1e-5) } else { 0.003 };
    let number = egui::DragValue::new(opacity).range(0.0..=1.0).speed(speed).max_decimals(9);
    number.custom_formatter(|opacity, _| widgets::short(opacity))
}

/// Where a node is: its value of the field that has a role, and that as a share of the range. Returns the share
/// where it was changed.
fn place(ui: &mut Ui, session: &Session, role: Role, u: f32) -> Option<f32> {
    let (range, scale) = (session.range_of(role), session.scale(role));
    let mut moved = None;
    widgets::row(ui, "Value", |ui| {
        if let Some(range @ [low, high]) = range.filter(|[low, high]| low < high) {
            let mut value = scale.value(range, f64::from(u));
            let field = widgets::number(&mut value, high - low).range(low..=high);
            if ui.add(field).accessible_name("Value").changed() {
                moved = Some(scale.u(range, value).clamp(0.0, 1.0) as f32);
            }
        }
        ui.label(RichText::new("u").color(theme::colours().muted));
        let mut share = u;
        let field = egui::DragValue::new(&mut share).range(0.0..=1.0).speed(0.002).fixed_decimals(3);
        let hint = "The same place as a share of the range: 0 at its low end, 1 at its high one";
        if ui.add(field).on_hover_text(hint).accessible_name("u").changed() {
            moved = Some(share);
        }
    });
    moved
}

/// What values outside the range look like.
pub fn outside(ui: &mut Ui, session: &mut Session) {
    let ends = session.view.transfer.function().map(|function| [0.0, 1.0].map(|u| function.sample(u)));
    let ends = ends.unwrap_or_default();
    let quantity = &mut session.view.quantity;
    // With a field of its own, the opacity knows nothing of this range.
    let with_opacity = quantity.opacity.is_none();
    for (label, side, end) in
        [("Below range", &mut quantity.below, ends[0]), ("Above range", &mut quantity.above, ends[1])]
    {
        widgets::row(ui, label, |ui| {
            // Three things side by side.
            ui.spacing_mut().interact_size.x = 68.0;
            let mut on = side.is_some();
            let hint = "Show values outside the range in a colour of their own; otherwise they look as those \
                        at its end";
            if ui.checkbox(&mut on, "").on_hover_text(hint).accessible_name(label).changed() {
                let [r, g, b, opacity] = end;
                *side = on.then_some(OutsideView { rgb: [r, g, b], opacity });
            }
            let Some(OutsideView { rgb, opacity }) = side else {
                ui.label(RichText::new("as the end").color(theme::colours().faint));
                return;
            };
            // The button rounds what it is given.
            let mut shown = *rgb;
            let button = ui.color_edit_button_rgb(&mut shown);
            if button.accessible_name(format!("{label}: colour")).changed() {
                *rgb = shown.map(|channel| channel.clamp(0.0, 1.0));
            }
            if with_opacity {
                let field = ui.add(opacity_number(opacity, false));
                field.on_hover_text("Opacity").accessible_name(format!("{label}: opacity"));
            }
        });
    }
}

/// The length of path that the opacities belong to.
pub fn reference_length(ui: &mut Ui, session: &mut Session) {
    let automatic = session.picture.as_ref().map(|picture| picture.facts.reference_length);
    let length = &mut session.view.transfer.reference_length;
    let hint = "Length of path that the opacities belong to: shorter makes everything denser";
    widgets::row(ui, "Per length", |ui| {
        let mut by_hand = length.is_some();
        let mut value = length.or(automatic).unwrap_or(1.0);
        let scale = automatic.unwrap_or(value);
        let field = widgets::number(&mut value, scale).range(scale * 1e-6..=scale * 1e6);
        if ui.add(field).on_hover_text(hint).accessible_name("Per length").changed() {
            *length = Some(value);
        }
        if ui.checkbox(&mut by_hand, "fixed").on_hover_text("Otherwise 1/30 of the run's diagonal").changed()
        {
            *length = by_hand.then_some(value);
        }
    });
}
