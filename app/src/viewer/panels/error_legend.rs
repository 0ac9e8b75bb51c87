//! The legend over a picture of errors: which colour is which error.

use egui::{Rect, Ui, pos2, vec2};

use crate::viewer::inspect::measurement::Measured;
use crate::viewer::picture::error_map;

use super::legend;

/// Height of the colour of errors above the tolerance, and its distance from the others.
const ABOVE: f32 = 12.0;
const GAP: f32 = 12.0;

pub fn show(ui: &Ui, measured: &Measured, picture: Rect) {
    let Some(bar) = legend::place(picture) else { return };
    legend::gradient(ui, bar, error_map::colour);
    legend::ticks(ui, bar, [0.0, measured.tolerance]);
    let corner = pos2(bar.left(), bar.top() - GAP - ABOVE);
    let above = Rect::from_min_size(corner, vec2(bar.width(), ABOVE));
    ui.painter().rect_filled(above, 0, error_map::ABOVE);
    legend::frame(ui, above);
    legend::beside(ui, above, above.center().y, "above");
    legend::title(ui, above, "measured error");
}
