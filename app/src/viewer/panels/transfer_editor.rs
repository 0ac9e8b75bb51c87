//! The transfer function: colour and opacity of every value, edited on a canvas and by numbers.

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Key, PointerButton, PopupCloseBehavior, Pos2, Rect, Response, Sense, Ui, pos2, vec2};
use renderer::TransferView;

use crate::annotate::ticks;
use crate::viewer::session::Session;
use crate::viewer::{accessible, theme, widgets};

use super::presets::Presets;
use super::transfer_canvas::{self as canvas, Axes, Strip};
use super::transfer_edit as edit;
use super::transfer_fields::{self as fields, Node};

/// What the editor remembers between frames.
#[derive(Default)]
pub struct TransferEditor {
    pub presets: Presets,
    selected: Option<Node>,
    /// The node that the mouse holds.
    held: Option<Node>,
    /// Whether the opacity axis is logarithmic.
    log: bool,
    /// Whether counts are shown in proportion, rather than by their logarithms.
    plain_counts: bool,
}

const CANVAS_HEIGHT: f32 = 132.0;
const STRIP_HEIGHT: f32 = 12.0;
/// Room for the nodes of colour below the strip.
const NODES_HEIGHT: f32 = 13.0;

impl TransferEditor {
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) {
        let transfer = &mut session.view.transfer;
        edit::sort(transfer);
        let nodes = edit::colour_nodes(transfer).map_or(0, |nodes| nodes.len());
        self.selected = self.selected.filter(|node| match node {
            Node::Opacity(index) => *index < transfer.points.len(),
            Node::Colour(index) => *index < nodes,
        });
        if super::colour_menu::show(ui, transfer) && matches!(self.selected, Some(Node::Colour(_))) {
            self.selected = None;
        }
        self.header(ui, transfer);
        let bars = session.analysis.as_ref().map_or(&[][..], |analysis| &analysis.bars);
        self.canvas(ui, &mut session.view.transfer, bars);
        marks(ui, session);
        fields::node(ui, session, &mut self.selected, self.log);
        fields::outside(ui, session);
        fields::reference_length(ui, session);
    }

    fn header(&mut self, ui: &mut Ui, transfer: &mut TransferView) {
        ui.horizontal(|ui| {
            let before = transfer.clone();
            self.presets.show(ui, transfer);
            let hint = "Mirror the function: what was shown of low values is shown of high ones";
            if ui.button("Mirror").on_hover_text(hint).clicked() {
                edit::reverse_colours(transfer);
                edit::reverse_opacities(transfer);
            }
            if *transfer != before {
                self.selected = None;
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
                MenuButton::new("Axes").config(config).ui(ui, |ui| {
                    ui.checkbox(&mut self.log, "Logarithmic opacity").on_hover_text("Fine control near zero");
                    let mut log_counts = !self.plain_counts;
                    let hint = "Rare values are seen as well as common ones";
                    if ui.checkbox(&mut log_counts, "Logarithmic counts").on_hover_text(hint).changed() {
                        self.plain_counts = !log_counts;
                    }
                });
            });
        });
    }

    fn canvas(&mut self, ui: &mut Ui, transfer: &mut TransferView, bars: &[u64]) {
        let height = CANVAS_HEIGHT + 8.0 + STRIP_HEIGHT + NODES_HEIGHT;
        let size = vec2(ui.available_width(), height);
        let (outer, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        accessible::drawing(&response, "Transfer function");
        let inner = Rect::from_min_size(outer.min, vec2(outer.width(), CANVAS_HEIGHT)).shrink(7.0);
        let axes = Axes { rect: inner, log: self.log };
        let top = outer.top() + CANVAS_HEIGHT + 8.0;
        let strip = Strip {
            rect: Rect::from_x_y_ranges(inner.x_range(), top..=top + STRIP_HEIGHT),
            nodes: top + STRIP_HEIGHT + 0.5 * NODES_HEIGHT,
        };
        widgets::Areas::mark(ui, "transfer", inner);
        widgets::Areas::mark(ui, "colours", strip.rect);
        self.edit(ui, &response, &axes, &strip, transfer);
        let under = response.hover_pos().and_then(|cursor| hit(transfer, &axes, &strip, cursor));
        let painter = ui.painter_at(outer.expand(2.0));
        canvas::paint(&painter, &axes, &strip, transfer, bars, self.plain_counts);
        canvas::paint_nodes(&painter, &axes, &strip, transfer, [self.selected, under]);
        if under.is_some() || self.held.is_some() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        } else if let Some(cursor) = response.hover_pos() {
            let named = transfer.map.as_ref().and_then(|map| map.name.as_deref());
            let hint = match named.filter(|_| strip.holds(cursor)) {
                Some(name) => format!("The colours of {name}; to edit them, choose “own nodes” above"),
                None if strip.holds(cursor) => "Double click adds a colour, right click removes one".into(),
                None => "Double click adds a node of opacity, right click removes one".into(),
            };
            response.on_hover_text_at_pointer(hint);
        }
    }

    fn edit(
        &mut self,
        ui: &Ui,
        response: &Response,
        axes: &Axes,
        strip: &Strip,
        transfer: &mut TransferView,
    ) {
        let cursor = response.interact_pointer_pos();
        if response.drag_started_by(PointerButton::Primary) {
            let pressed = ui.input(|input| input.pointer.press_origin());
            self.held = pressed.and_then(|place| hit(transfer, axes, strip, place));
            self.selected = self.held.or(self.selected);
        }
        if let (Some(node), Some(cursor)) = (self.held, cursor)
            && response.dragged()
        {
            let (u, opacity) = axes.at(cursor);
            match node {
                Node::Opacity(index) if index < transfer.points.len() => {
                    edit::move_opacity(transfer, index, u, opacity);
                }
                Node::Colour(index) => edit::move_colour(transfer, index, u),
                Node::Opacity(_) => {}
            }
        }
        if response.drag_stopped() {
            self.held = None;
        }
        let under = cursor.and_then(|cursor| hit(transfer, axes, strip, cursor));
        match cursor.filter(|_| under.is_none() && response.double_clicked()) {
            Some(cursor) => self.add(axes, strip, transfer, cursor),
            None if response.clicked() => self.selected = under,
            None => {}
        }
        let delete =
            |input: &egui::InputState| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace);
        let deleted = self.selected.filter(|_| !ui.ctx().egui_wants_keyboard_input() && ui.input(delete));
        match under.filter(|_| response.secondary_clicked()).or(deleted) {
            Some(Node::Opacity(index)) => edit::remove_opacity(transfer, index),
            Some(Node::Colour(index)) => edit::remove_colour(transfer, index),
            None => return,
        }
        self.selected = None;
    }

    fn add(&mut self, axes: &Axes, strip: &Strip, transfer: &mut TransferView, cursor: Pos2) {
        let (u, opacity) = axes.at(cursor);
        self.selected = match strip.holds(cursor) {
            true => edit::add_colour(transfer, u).map(Node::Colour),
            false => Some(Node::Opacity(edit::add_opacity(transfer, u, opacity))),
        };
    }
}

/// The node under the cursor.
fn hit(transfer: &TransferView, axes: &Axes, strip: &Strip, cursor: Pos2) -> Option<Node> {
    match strip.holds(cursor) {
        true => strip.hit(&edit::colour_nodes(transfer)?, cursor).map(Node::Colour),
        false => axes.hit(&transfer.points, cursor).map(Node::Opacity),
    }
}

/// Values along the axis.
fn marks(ui: &mut Ui, session: &Session) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 14.0), Sense::hover());
    let Some(range) = session.range() else { return };
    let rect = rect.shrink2(vec2(7.0, 0.0));
    let font = egui::FontId::monospace(11.0);
    let mut free = f32::NEG_INFINITY;
    let marks = ticks(range, session.view.quantity.scale);
    // The ends first: what lies between goes where there is room.
    let width = |text: &str| 6.8 * text.chars().count() as f32;
    let last = marks.last().map_or(0.0, |mark| width(&mark.label));
    for mark in &marks {
        let wide = width(&mark.label);
        let left = (rect.left() + mark.share * rect.width() - 0.5 * wide)
            .clamp(rect.left(), (rect.right() - wide).max(rect.left()));
        let is_last = std::ptr::eq(mark, marks.last().unwrap_or(mark));
        if left < free || (!is_last && left + wide + 10.0 > rect.right() - last) {
            continue;
        }
        ui.painter().text(
            pos2(left, rect.top()),
            egui::Align2::LEFT_TOP,
            &mark.label,
            font.clone(),
            theme::colours().muted,
        );
        free = left + wide + 10.0;
    }
}
