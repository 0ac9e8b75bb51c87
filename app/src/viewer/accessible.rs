//! What widgets that paint themselves tell screen readers, and how they show that they have the keyboard.

use egui::accesskit::{Action, ActionData, Role};
use egui::{Rect, Response, Stroke, StrokeKind, Ui, WidgetInfo};

use super::theme;

/// A button called `name`.
pub fn button(ui: &Ui, response: &Response, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    ring(ui, response, response.rect);
}

/// A button called `name` that is on or off.
pub fn switch(ui: &Ui, response: &Response, name: &str, on: bool) {
    response.widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), on, name));
    ring(ui, response, response.rect);
}

/// The title of a part that folds away.
pub fn title(ui: &Ui, response: &Response, name: &str, open: bool) {
    response.widget_info(|| WidgetInfo::labeled(Role::DisclosureTriangle, ui.is_enabled(), name));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_expanded(open));
    ring(ui, response, response.rect);
}

/// Something drawn, called `name`, whose settings are in words elsewhere.
pub fn drawing(response: &Response, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, name));
}

/// A slider called `name` at `value` of 0 to `last`, in steps of one. Returns where a screen reader wants it.
pub fn slider(ui: &Ui, response: &Response, name: &str, value: usize, last: usize) -> Option<usize> {
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), value as f64, name));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(0.0);
        node.set_max_numeric_value(last as f64);
        node.set_numeric_value_step(1.0);
        for action in [Action::SetValue, Action::Increment, Action::Decrement] {
            node.add_action(action);
        }
    });
    ring(ui, response, response.rect);
    ui.input(|input| {
        let times = |action| input.num_accesskit_action_requests(response.id, action);
        let set =
            input.accesskit_action_requests(response.id, Action::SetValue).find_map(|request| match request
                .data
            {
                Some(ActionData::NumericValue(value)) => Some(value.clamp(0.0, last as f64).round() as usize),
                _ => None,
            });
        let stepped = (value + times(Action::Increment)).saturating_sub(times(Action::Decrement)).min(last);
        Some(set.unwrap_or(stepped)).filter(|&wanted| wanted != value)
    })
}

/// A line around what has the keyboard.
fn ring(ui: &Ui, response: &Response, rect: Rect) {
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 4, Stroke::new(1.5, theme::colours().accent), StrokeKind::Inside);
    }
}
