//! The colour legend over the picture: which colour is which value.

use egui::epaint::Mesh;
use egui::{Align2, Color32, Rect, Shape, Stroke, StrokeKind, Ui, pos2, vec2};
use renderer::TransferFunction;

use crate::scene::Selection;
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

use super::transfer_canvas::to_screen;

/// Space above and below the bar.
const INSET: f32 = 56.0;
const TICKS: u32 = 4;

pub fn show(ui: &Ui, session: &Session, picture: Rect) {
    let (Some([low, high]), Some((_, frame))) = (session.range(), session.frame()) else { return };
    let Ok(transfer) = TransferFunction::new(&session.view.transfer.points) else { return };
    let name = session.view.quantity.name.clone().or_else(|| Selection::default_of(frame).name());
    let height = (picture.height() - 2.0 * INSET).min(220.0);
    if height < 80.0 || picture.width() < 260.0 {
        return;
    }
    let middle = picture.right() - 24.0;
    let bar = Rect::from_center_size(pos2(middle, picture.center().y), vec2(12.0, height));
    let mut mesh = Mesh::default();
    let steps = 64;
    for step in 0..=steps {
        let u = step as f32 / steps as f32;
        let [r, g, b, _] = transfer.sample(u);
        let y = bar.bottom() - u * bar.height();
        mesh.colored_vertex(pos2(bar.left(), y), to_screen([r, g, b]));
        mesh.colored_vertex(pos2(bar.right(), y), to_screen([r, g, b]));
        if step > 0 {
            let next = 2 * step;
            mesh.add_triangle(next - 2, next - 1, next);
            mesh.add_triangle(next - 1, next, next + 1);
        }
    }
    ui.painter().add(Shape::mesh(mesh));
    ui.painter().rect_stroke(bar, 1, Stroke::new(1.0, Color32::from_white_alpha(70)), StrokeKind::Outside);
    // Where all values are one, so are the ticks.
    let ticks = if low < high { TICKS } else { 0 };
    for tick in 0..=ticks {
        let u = if ticks == 0 { 0.5 } else { f64::from(tick) / f64::from(ticks) };
        let y = bar.bottom() - u as f32 * bar.height();
        let text = widgets::on_axis(low + u * (high - low), high - low);
        outlined(ui, pos2(bar.left() - 7.0, y), Align2::RIGHT_CENTER, &text, theme::number_font());
    }
    if let Some(name) = name {
        let font = egui::FontId::proportional(13.0);
        outlined(ui, bar.right_top() + vec2(2.0, -12.0), Align2::RIGHT_BOTTOM, &name, font);
    }
}

/// Text that can be read on any picture.
fn outlined(ui: &Ui, place: egui::Pos2, align: Align2, text: &str, font: egui::FontId) {
    for offset in [vec2(1.0, 1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0), vec2(-1.0, -1.0)] {
        ui.painter().text(place + offset, align, text, font.clone(), Color32::from_black_alpha(150));
    }
    ui.painter().text(place, align, text, font, theme::TEXT);
}
