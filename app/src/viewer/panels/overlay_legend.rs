//! The legend of what lies over the picture.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};
use renderer::CellClass;

use crate::overlay::look;
use crate::viewer::inspect::measurement::State;
use crate::viewer::picture::error_map;
use crate::viewer::picture::layers::Layers;
use crate::viewer::picture::overlay::{Kind, Which};
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

use super::{cells, error_legend, legend};

/// Shows it, where something lies over the picture.
pub fn show(ui: &Ui, session: &Session, layers: &Layers, measurement: Option<&State>, picture: Rect) -> bool {
    let overlay = &session.overlay;
    if !layers.is_over(overlay) {
        return false;
    }
    match (overlay.kind, measurement) {
        (Kind::Classes, _) if overlay.which == Which::Share => share(ui, overlay.class, picture),
        (Kind::Classes, _) => classes(ui, session, layers, picture),
        (Kind::Predicted, _) => predicted(ui, layers.tolerance().unwrap_or(0.0), picture),
        (Kind::Measured, Some(State::Done(measured))) => error_legend::show(ui, measured, picture),
        (Kind::Measured | Kind::Off, _) => {}
    }
    true
}

fn predicted(ui: &Ui, tolerance: f64, picture: Rect) {
    let Some(bar) = legend::place(picture) else { return };
    legend::gradient(ui, bar, error_map::colour);
    legend::ticks(ui, bar, [0.0, tolerance]);
    legend::title(ui, bar, "predicted error");
}

fn share(ui: &Ui, class: CellClass, picture: Rect) {
    let Some(bar) = legend::place(picture) else { return };
    legend::gradient(ui, bar, error_map::colour);
    for quarter in 0..=4_u8 {
        let share = f32::from(quarter) / 4.0;
        let y = bar.bottom() - share * bar.height();
        legend::beside(ui, bar, y, &format!("{:.0} %", 100.0 * share));
    }
    legend::title(ui, bar, &format!("cells: {}", look(class).name.to_lowercase()));
}

/// Width, height of a line, and margin.
const SIZE: [f32; 3] = [178.0, 19.0, 10.0];

/// The classes in view with their share of the bundles that they cover.
fn classes(ui: &Ui, session: &Session, layers: &Layers, picture: Rect) {
    let Some(counts) = layers.covered(&session.overlay) else { return };
    let shown: Vec<(CellClass, u64)> =
        CellClass::ALL.into_iter().zip(*counts).filter(|(_, count)| *count > 0).collect();
    let [width, step, margin] = SIZE;
    let height = step * (shown.len() + 1) as f32 + 2.0 * margin;
    if picture.height() < height + 40.0 || picture.width() < 2.0 * width {
        return;
    }
    let middle = pos2(picture.right() - 12.0 - 0.5 * width, picture.center().y);
    let ground = Rect::from_center_size(middle, vec2(width, height));
    ui.painter().rect_filled(ground, 6, Color32::from_black_alpha(190));
    let inside = ground.shrink(margin);
    let line = |row: usize| inside.left_top() + vec2(0.0, step * (row as f32 + 0.5));
    ui.painter().text(line(0), Align2::LEFT_CENTER, title(session), theme::small_font(), theme::DARK.muted);
    let all = counts.iter().sum::<u64>().max(1) as f64;
    for (row, (class, count)) in shown.into_iter().enumerate() {
        let look = look(class);
        let place = line(row + 1);
        let [r, g, b] = look.rgb;
        let swatch = Rect::from_center_size(place + vec2(5.5, 0.0), vec2(11.0, 11.0));
        ui.painter().rect_filled(swatch, 2, Color32::from_rgb(r, g, b));
        let font = egui::FontId::proportional(13.0);
        ui.painter().text(place + vec2(19.0, 0.0), Align2::LEFT_CENTER, look.name, font, theme::DARK.text);
        let right = pos2(inside.right(), place.y);
        let share = widgets::percent(count as f64 / all);
        ui.painter().text(right, Align2::RIGHT_CENTER, share, theme::number_font(), theme::DARK.text);
    }
}

fn title(session: &Session) -> String {
    let overlay = &session.overlay;
    match (&overlay.which, &session.picture) {
        (Which::Slice, Some(picture)) => {
            let stats = &picture.stats;
            let layer = overlay.layer((stats.slices / u64::from(renderer::CELL_SLICES)) as u32);
            format!("Slice at depth {}", widgets::short(cells::depth_of(stats, layer)))
        }
        _ => "Front-most cells".to_owned(),
    }
}
