//! A bar of colours over the picture: which colour is which value of what lies over it.

use crate::viewer::{theme, widgets};
use egui::epaint::Mesh;
use egui::{Align2, Color32, Rect, Shape, Stroke, StrokeKind, Ui, pos2, vec2};

/// Space above and below the bar.
const INSET: f32 = 56.0;
const TICKS: u32 = 4;

/// Where the bar is, in a picture that has room for it.
pub fn place(picture: Rect) -> Option<Rect> {
    let height = (picture.height() - 2.0 * INSET).min(220.0);
    let middle = picture.right() - 24.0;
    let bar = Rect::from_center_size(pos2(middle, picture.center().y), vec2(12.0, height));
    (height >= 80.0 && picture.width() >= 260.0).then_some(bar)
}

/// The bar, in the colour of each share of its height.
pub fn gradient(ui: &Ui, bar: Rect, colour: impl Fn(f32) -> Color32) {
    let mut mesh = Mesh::default();
    let steps = 64;
    for step in 0..=steps {
        let u = step as f32 / steps as f32;
        let y = bar.bottom() - u * bar.height();
        mesh.colored_vertex(pos2(bar.left(), y), colour(u));
        mesh.colored_vertex(pos2(bar.right(), y), colour(u));
        if step > 0 {
            let next = 2 * step;
            mesh.add_triangle(next - 2, next - 1, next);
            mesh.add_triangle(next - 1, next, next + 1);
        }
    }
    ui.painter().add(Shape::mesh(mesh));
    frame(ui, bar);
}

/// A line around a part of a legend.
pub fn frame(ui: &Ui, part: Rect) {
    ui.painter().rect_stroke(part, 1, Stroke::new(1.0, Color32::from_white_alpha(70)), StrokeKind::Outside);
}

/// Values beside the bar.
pub fn ticks(ui: &Ui, bar: Rect, [low, high]: [f64; 2]) {
    // Where all values are one, so are the ticks.
    let ticks = if low < high { TICKS } else { 0 };
    for tick in 0..=ticks {
        let u = if ticks == 0 { 0.5 } else { f64::from(tick) / f64::from(ticks) };
        let y = bar.bottom() - u as f32 * bar.height();
        beside(ui, bar, y, &widgets::on_axis(low + u * (high - low), high - low));
    }
}

/// A text on the left of the bar.
pub fn beside(ui: &Ui, bar: Rect, y: f32, text: &str) {
    outlined(ui, pos2(bar.left() - 7.0, y), Align2::RIGHT_CENTER, text, theme::number_font());
}

/// What the values are.
pub fn title(ui: &Ui, bar: Rect, text: &str) {
    let font = egui::FontId::proportional(13.0);
    outlined(ui, bar.right_top() + vec2(2.0, -12.0), Align2::RIGHT_BOTTOM, text, font);
}

/// Text that can be read on any picture.
fn outlined(ui: &Ui, place: egui::Pos2, align: Align2, text: &str, font: egui::FontId) {
    for offset in [vec2(1.0, 1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0), vec2(-1.0, -1.0)] {
        ui.painter().text(place + offset, align, text, font.clone(), Color32::from_black_alpha(150));
    }
    ui.painter().text(place, align, text, font, theme::DARK.text);
}
