//! The transfer function: colour and opacity of every value, edited on a canvas and by numbers.

use egui::{Key, PointerButton, Rect, Response, RichText, Sense, Ui, pos2, vec2};
use renderer::ControlPoint;

use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

use super::presets::{PRESETS, default_points};
use super::transfer_canvas::{self as canvas, Axes};

/// What the editor remembers between frames.
#[derive(Default)]
pub struct TransferEditor {
    selected: Option<usize>,
    /// The node that the mouse holds.
    held: Option<usize>,
    log: bool,
}

const CANVAS_HEIGHT: f32 = 132.0;
const STRIP_HEIGHT: f32 = 12.0;

impl TransferEditor {
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) {
        let points = &mut session.view.transfer.points;
        // A file may hold them in any order.
        points.sort_by(|a, b| a.u.total_cmp(&b.u));
        self.selected = self.selected.filter(|index| *index < points.len());
        self.header(ui, points);
        let bars = session.analysis.as_ref().map_or(&[][..], |analysis| &analysis.bars);
        self.canvas(ui, points, bars);
        self.ticks(ui, session);
        self.fields(ui, session);
        reference_length(ui, session);
    }

    fn header(&mut self, ui: &mut Ui, points: &mut Vec<ControlPoint>) {
        ui.horizontal(|ui| {
            let before = points.clone();
            ui.menu_button("Presets", |ui| {
                for preset in &PRESETS {
                    if ui.button(preset.name).on_hover_text(preset.hint).clicked() {
                        *points = preset.points();
                    }
                }
                ui.separator();
                if ui.button("Default").clicked() {
                    *points = default_points();
                }
            });
            if ui.button("Invert").on_hover_text("Mirror the function").clicked() {
                points.reverse();
                points.iter_mut().for_each(|point| point.u = 1.0 - point.u);
            }
            if *points != before {
                self.selected = None;
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.checkbox(&mut self.log, "Log opacity")
                    .on_hover_text("Logarithmic opacity axis: fine control near zero");
            });
        });
    }

    fn canvas(&mut self, ui: &mut Ui, points: &mut Vec<ControlPoint>, bars: &[u64]) {
        let size = vec2(ui.available_width(), CANVAS_HEIGHT + STRIP_HEIGHT + 8.0);
        let (outer, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        let response = response.accessible_name("Transfer function");
        let inner = Rect::from_min_size(outer.min, vec2(outer.width(), CANVAS_HEIGHT)).shrink(7.0);
        let axes = Axes { rect: inner, log: self.log };
        let strip = Rect::from_min_max(
            pos2(inner.left(), outer.bottom() - STRIP_HEIGHT),
            pos2(inner.right(), outer.bottom()),
        );
        widgets::Areas::mark(ui, "transfer", inner);
        self.edit(ui, &response, &axes, points);
        let under = response.hover_pos().and_then(|cursor| axes.hit(points, cursor));
        let painter = ui.painter_at(outer);
        canvas::paint(&painter, &axes, strip, points, bars);
        canvas::paint_nodes(&painter, &axes, points, self.selected, under);
        if under.is_none() && self.held.is_none() {
            response.on_hover_text_at_pointer("Double click adds a point, right click removes one");
        } else {
            ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        }
    }

    fn edit(&mut self, ui: &Ui, response: &Response, axes: &Axes, points: &mut Vec<ControlPoint>) {
        let cursor = response.interact_pointer_pos();
        if response.drag_started_by(PointerButton::Primary) {
            let pressed = ui.input(|input| input.pointer.press_origin());
            self.held = pressed.and_then(|place| axes.hit(points, place));
            self.selected = self.held.or(self.selected);
        }
        if let (Some(index), Some(cursor)) = (self.held, cursor)
            && response.dragged()
            && index < points.len()
        {
            let (u, opacity) = axes.at(cursor);
            canvas::move_node(points, index, u, opacity);
        }
        if response.drag_stopped() {
            self.held = None;
        }
        let hit = cursor.and_then(|cursor| axes.hit(points, cursor));
        if response.double_clicked()
            && hit.is_none()
            && let Some(cursor) = cursor
        {
            let (u, opacity) = axes.at(cursor);
            self.selected = Some(canvas::add_node(points, u, opacity));
        } else if response.clicked() {
            self.selected = hit;
        }
        if response.secondary_clicked()
            && let Some(index) = hit
        {
            self.remove(points, index);
        }
        let delete =
            |input: &egui::InputState| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace);
        if let Some(index) = self.selected
            && !ui.ctx().egui_wants_keyboard_input()
            && ui.input(delete)
        {
            self.remove(points, index);
        }
    }

    fn remove(&mut self, points: &mut Vec<ControlPoint>, index: usize) {
        // The last one is the whole function.
        if points.len() > 1 {
            points.remove(index);
            self.selected = None;
        }
    }

    /// The values at both ends and in the middle.
    fn ticks(&self, ui: &mut Ui, session: &Session) {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 14.0), Sense::hover());
        let Some([low, high]) = session.range() else { return };
        let rect = rect.shrink2(vec2(7.0, 0.0));
        let ticks = [
            (rect.left_top(), egui::Align2::LEFT_TOP, low),
            (rect.center_top(), egui::Align2::CENTER_TOP, 0.5 * low + 0.5 * high),
            (rect.right_top(), egui::Align2::RIGHT_TOP, high),
        ];
        for (place, align, value) in ticks {
            let font = egui::FontId::monospace(11.0);
            ui.painter().text(place, align, widgets::on_axis(value, high - low), font, theme::MUTED);
        }
    }

    /// Numbers of the selected node.
    fn fields(&mut self, ui: &mut Ui, session: &mut Session) {
        let range = session.range();
        let points = &mut session.view.transfer.points;
        let Some(index) = self.selected else {
            ui.label(RichText::new("Select a point to edit its numbers.").color(theme::FAINT));
            return;
        };
        let (mut u, mut opacity) = (points[index].u, points[index].opacity);
        widgets::row(ui, "Position", |ui| {
            ui.add(egui::DragValue::new(&mut u).range(0.0..=1.0).speed(0.002).fixed_decimals(3));
            if let Some([low, high]) = range {
                let value = low + f64::from(u) * (high - low);
                let text = format!("= {}", widgets::short(value));
                ui.label(RichText::new(text).font(theme::number_font()).color(theme::MUTED));
            }
        });
        widgets::row(ui, "Opacity", |ui| {
            let speed = if self.log { 0.02 * opacity.max(0.001) } else { 0.003 };
            let field = egui::DragValue::new(&mut opacity).range(0.0..=1.0).speed(speed);
            ui.add(field.min_decimals(3).max_decimals(5));
        });
        canvas::move_node(points, index, u, opacity);
        widgets::row(ui, "Colour", |ui| {
            ui.color_edit_button_rgb(&mut points[index].rgb);
            if ui.button("Step").on_hover_text("Add a second point at the same place").clicked() {
                points.insert(index + 1, points[index]);
                self.selected = Some(index + 1);
            }
            let removable = points.len() > 1;
            if ui.add_enabled(removable, egui::Button::new("Remove")).clicked() {
                self.remove(points, index);
            }
        });
    }
}

/// The length of path that the opacities belong to.
fn reference_length(ui: &mut Ui, session: &mut Session) {
    let automatic = session.picture.as_ref().map(|picture| picture.facts.reference_length);
    let length = &mut session.view.transfer.reference_length;
    let hint = "Length of path that the opacities belong to: shorter makes everything denser";
    widgets::row(ui, "Per length", |ui| {
        let mut by_hand = length.is_some();
        let mut value = length.or(automatic).unwrap_or(1.0);
        let scale = automatic.unwrap_or(value);
        let field = widgets::number(&mut value, scale).range(scale * 1e-6..=scale * 1e6);
        if ui.add(field).on_hover_text(hint).changed() {
            *length = Some(value);
        }
        if ui.checkbox(&mut by_hand, "fixed").on_hover_text("Otherwise 1/30 of the run's diagonal").changed()
        {
            *length = by_hand.then_some(value);
        }
    });
}
