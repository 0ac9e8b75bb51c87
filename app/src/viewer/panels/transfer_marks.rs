//! Values along the axes of the transfer-function editor, and what the fields are called.

use egui::{Align2, FontId, Rect, Ui, pos2, vec2};

use crate::annotate::ticks;
use crate::viewer::session::{Role, Session};
use crate::viewer::theme;

/// Distance of the axis' ends from those of its rectangle.
const MARGIN: f32 = 7.0;
/// Width of a digit, and the least distance between two values.
const DIGIT: f32 = 6.8;
const APART: f32 = 10.0;

/// Values of the field that has a role, at the upper edge of `rect`.
pub fn show(ui: &Ui, session: &Session, role: Role, rect: Rect) {
    let Some(range) = session.range_of(role) else { return };
    let rect = rect.shrink2(vec2(MARGIN, 0.0));
    let font = FontId::monospace(11.0);
    let mut free = f32::NEG_INFINITY;
    let marks = ticks(range, session.scale(role));
    // The ends first: what lies between goes where there is room.
    let width = |text: &str| DIGIT * text.chars().count() as f32;
    let last = marks.last().map_or(0.0, |mark| width(&mark.label));
    for mark in &marks {
        let wide = width(&mark.label);
        let left = (rect.left() + mark.share * rect.width() - 0.5 * wide)
            .clamp(rect.left(), (rect.right() - wide).max(rect.left()));
        let is_last = std::ptr::eq(mark, marks.last().unwrap_or(mark));
        if left < free || (!is_last && left + wide + APART > rect.right() - last) {
            continue;
        }
        let place = pos2(left, rect.top());
        ui.painter().text(place, Align2::LEFT_TOP, &mark.label, font.clone(), theme::colours().muted);
        free = left + wide + APART;
    }
}

/// What an axis is of, at the lower edge of `rect`.
pub fn caption(ui: &Ui, rect: Rect, text: &str) {
    let place = pos2(rect.left() + MARGIN, rect.bottom() - 2.0);
    ui.painter().text(place, Align2::LEFT_BOTTOM, text, FontId::proportional(11.5), theme::colours().muted);
}
