//! The transfer function: colour and opacity of every value, edited on a canvas and by numbers.

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Key, PointerButton, PopupCloseBehavior, Pos2, Rect, Response, RichText, Sense, Ui, vec2};
use renderer::TransferView;

use crate::viewer::session::{Role, Session};
use crate::viewer::{accessible, theme, widgets};

use super::presets::Presets;
use super::transfer_canvas::{self as canvas, Axes, Behind, Strip};
use super::transfer_edit as edit;
use super::transfer_fields::{self as fields, Node};
use super::transfer_marks as marks;

/// What the editor remembers between frames.
#[derive(Default)]
pub struct TransferEditor {
    pub presets: Presets,
    selected: Option<Node>,
    held: Option<Held>,
    /// Whether the opacity axis is logarithmic.
    log: bool,
    /// Whether counts are shown in proportion, rather than by their logarithms.
    plain_counts: bool,
    /// Whether the histogram is that of all frames in memory.
    all_frames: bool,
}

/// The node that the mouse holds.
#[derive(Clone, Copy)]
struct Held {
    node: Node,
    /// Where the node would be if it could be anywhere.
    place: Pos2,
    cursor: Pos2,
}

const CANVAS_HEIGHT: f32 = 132.0;
const STRIP_HEIGHT: f32 = 12.0;
/// Between the canvas and the strip; and where values and a caption stand there.
const GAP: f32 = 8.0;
const WIDE_GAP: f32 = 40.0;
/// Room for the nodes of colour below the strip.
const NODES_HEIGHT: f32 = 13.0;
/// Share of the mouse's way that a node goes while Shift is held.
const FINE: f32 = 0.1;

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
        self.header(ui, session);
        self.canvas(ui, session);
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 14.0), Sense::hover());
        marks::show(ui, session, Role::Colour, rect);
        fields::node(ui, session, &mut self.selected, self.log);
        fields::outside(ui, session);
        fields::reference_length(ui, session);
    }

    fn header(&mut self, ui: &mut Ui, session: &mut Session) {
        let several = session.playback.count() > 1;
        let transfer = &mut session.view.transfer;
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
                MenuButton::new("Axes").config(config).ui(ui, |ui| self.axes_menu(ui, several));
            });
        });
    }

    fn axes_menu(&mut self, ui: &mut Ui, several: bool) {
        ui.checkbox(&mut self.log, "Logarithmic opacity").on_hover_text("Fine control near zero");
        let mut log_counts = !self.plain_counts;
        let hint = "Rare values are seen as well as common ones";
        if ui.checkbox(&mut log_counts, "Logarithmic counts").on_hover_text(hint).changed() {
            self.plain_counts = !log_counts;
        }
        if several {
            ui.separator();
            ui.label(RichText::new("Histogram of").small().color(theme::colours().muted));
            ui.radio_value(&mut self.all_frames, false, "This frame");
            let hint = "Of the frames in memory, marked on the timeline; none is read for it";
            ui.radio_value(&mut self.all_frames, true, "All loaded frames").on_hover_text(hint);
        }
    }

    /// The histogram that is asked for.
    fn behind(&self, session: &mut Session) -> Behind {
        let role = session.role_of_opacity();
        session.wants_pool |= self.pools(session);
        let histogram = match self.pools(session) {
            true => session.pool.histogram().map(|(histogram, _)| histogram),
            false => session.distribution(role).and_then(|found| found.histogram.clone()),
        };
        let (range, scale) = (session.range_of(role), session.scale(role));
        let edges = histogram.as_ref().zip(range).map(|(histogram, range)| histogram.edges(range, scale));
        Behind {
            edges: edges.unwrap_or_default(),
            bars: histogram.map(|histogram| histogram.bars).unwrap_or_default(),
            plain_counts: self.plain_counts,
            colourless: role == Role::Opacity,
        }
    }

    /// Whether the histogram is that of all frames in memory.
    fn pools(&self, session: &Session) -> bool {
        self.all_frames && session.playback.count() > 1
    }

    /// What stands over the canvas: the field of the opacity, and what the histogram is of, where that is not
    /// as usual.
    fn caption(&self, session: &Session) -> Option<String> {
        let name = session.opacity_field().and_then(|name| name.or_else(|| session.shown_quantity()));
        let by = name.map(|name| format!("Opacity by {name}"));
        let of = self.pools(session).then(|| {
            let frames = session.pool.histogram().map_or(0, |(_, frames)| frames);
            format!("Histogram of {frames} frame{}", if frames == 1 { "" } else { "s" })
        });
        let parts: Vec<String> = [by, of].into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join(" · "))
    }

    fn canvas(&mut self, ui: &mut Ui, session: &mut Session) {
        let behind = self.behind(session);
        if let Some(caption) = self.caption(session) {
            let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 14.0), Sense::hover());
            marks::caption(ui, rect, &caption);
        }
        let gap = if behind.colourless { WIDE_GAP } else { GAP };
        let height = CANVAS_HEIGHT + gap + STRIP_HEIGHT + NODES_HEIGHT;
        let size = vec2(ui.available_width(), height);
        let (outer, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        accessible::drawing(&response, "Transfer function");
        let inner = Rect::from_min_size(outer.min, vec2(outer.width(), CANVAS_HEIGHT)).shrink(7.0);
        let axes = Axes { rect: inner, log: self.log };
        let top = outer.top() + CANVAS_HEIGHT + gap;
        let strip = Strip {
            rect: Rect::from_x_y_ranges(inner.x_range(), top..=top + STRIP_HEIGHT),
            nodes: top + STRIP_HEIGHT + 0.5 * NODES_HEIGHT,
        };
        widgets::Areas::mark(ui, "transfer", inner);
        widgets::Areas::mark(ui, "colours", strip.rect);
        let transfer = &mut session.view.transfer;
        self.edit(ui, &response, &axes, &strip, transfer);
        let under = response.hover_pos().and_then(|cursor| hit(transfer, &axes, &strip, cursor));
        let painter = ui.painter_at(outer.expand(2.0));
        canvas::paint(&painter, &axes, &strip, transfer, &behind);
        canvas::paint_nodes(&painter, &axes, &strip, transfer, &behind, [self.selected, under]);
        if behind.colourless {
            let between = Rect::from_x_y_ranges(outer.x_range(), outer.top() + CANVAS_HEIGHT + 2.0..=top);
            marks::show(ui, session, Role::Opacity, between);
            let colour = session.shown_quantity().unwrap_or_default();
            marks::caption(ui, between, &format!("Colour by {colour}"));
        }
        self.explain(ui, session, response, &strip, under.is_some());
    }

    /// What the mouse can do here.
    fn explain(&self, ui: &Ui, session: &Session, response: Response, strip: &Strip, on_node: bool) {
        if on_node || self.held.is_some() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
            return;
        }
        let Some(cursor) = response.hover_pos() else { return };
        let named = session.view.transfer.map.as_ref().and_then(|map| map.name.as_deref());
        let hint = match named.filter(|_| strip.holds(cursor)) {
            Some(name) => format!("The colours of {name}; to edit them, choose “own nodes” above"),
            None if strip.holds(cursor) => "Double click adds a colour, right click removes one".into(),
            None => {
                "Double click adds a node of opacity, right click removes one; Shift moves it finely".into()
            }
        };
        response.on_hover_text_at_pointer(hint);
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
            self.held = pressed.and_then(|cursor| {
                let node = hit(transfer, axes, strip, cursor)?;
                Some(Held { node, place: place(transfer, axes, strip, node)?, cursor })
            });
            self.selected = self.held.map(|held| held.node).or(self.selected);
        }
        if let (Some(held), Some(cursor)) = (&mut self.held, cursor.filter(|_| response.dragged())) {
            let speed = if ui.input(|input| input.modifiers.shift) { FINE } else { 1.0 };
            let way = speed * (cursor - held.cursor);
            (held.place, held.cursor) = (held.place + way, cursor);
            // A press that has not moved yet leaves the last digit of a number alone.
            if way != egui::Vec2::ZERO {
                put(transfer, axes, *held);
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

/// Where a node is on the screen.
fn place(transfer: &TransferView, axes: &Axes, strip: &Strip, node: Node) -> Option<Pos2> {
    match node {
        Node::Opacity(index) => transfer.points.get(index).map(|point| axes.place(point)),
        Node::Colour(index) => edit::colour_nodes(transfer)?.get(index).map(|node| strip.place(node.u)),
    }
}

/// Moves a node to where it is held.
fn put(transfer: &mut TransferView, axes: &Axes, held: Held) {
    let (u, opacity) = axes.at(held.place);
    match held.node {
        Node::Opacity(index) if index < transfer.points.len() => {
            edit::move_opacity(transfer, index, u, opacity);
        }
        Node::Colour(index) => edit::move_colour(transfer, index, u),
        Node::Opacity(_) => {}
    }
}
