//! The cells behind a pixel as a table, from front to back.

use egui::{Align2, Rect, ScrollArea, Sense, Ui, pos2, vec2};
use renderer::{CellDetail, KnownValues, Placement};

use crate::overlay::look;
use crate::viewer::inspect::probe::Probed;
use crate::viewer::{theme, widgets};

use super::cell_classes::colour;

const ROW: f32 = 19.0;

/// Title, right edge in points (left edge for the class), and meaning.
const COLUMNS: [(&str, f32, &str); 7] = [
    ("Layer", 36.0, "Number of the cell along the rays, 16 slices each"),
    ("Depth", 140.0, "View depths where the cell begins and ends"),
    ("Class", 154.0, "What became of the cell"),
    ("Particles", 284.0, "Particles in the cell"),
    (
        "u",
        386.0,
        "Bounds of the quantity in its range, over all samples of the cell; where two fields are in view, of that of the opacity",
    ),
    (
        "Bricks",
        428.0,
        "Sampled bricks of 64; behind a plus, those on a slope, or sampled once for four slices",
    ),
    ("Charge", 484.0, "What the cell adds to the error of this pixel's rays, at most"),
];
const CLASS: usize = 2;

pub fn show(ui: &mut Ui, probed: &Probed, height: f32, hovered: Option<u32>, now: &mut Option<u32>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    header(ui);
    let cells = &probed.bundle.cells;
    ScrollArea::vertical()
        .max_height(height)
        .min_scrolled_height(height)
        .auto_shrink([false, true])
        .show_rows(ui, ROW, cells.len(), |ui, rows| {
            for cell in &cells[rows] {
                if row(ui, probed, cell, hovered) {
                    *now = Some(cell.cell.layer);
                }
            }
        });
}

fn header(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let mut left = 0.0;
    for (number, (title, edge, meaning)) in COLUMNS.into_iter().enumerate() {
        let (align, right) = match number {
            CLASS => (Align2::LEFT_CENTER, COLUMNS[CLASS + 1].1 - 56.0),
            _ => (Align2::RIGHT_CENTER, edge),
        };
        let place = pos2(rect.left() + edge, rect.center().y);
        ui.painter().text(place, align, title, theme::small_font(), theme::colours().muted);
        let area = Rect::from_x_y_ranges(rect.left() + left..=rect.left() + right, rect.y_range());
        ui.interact(area, ui.scope_id().with(title), Sense::hover()).on_hover_text(meaning);
        left = right;
    }
    ui.painter().hline(rect.x_range(), rect.bottom(), egui::Stroke::new(1.0, theme::colours().line));
}

/// A line for a cell. Returns whether the mouse is over it.
fn row(ui: &mut Ui, probed: &Probed, cell: &CellDetail, hovered: Option<u32>) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    if hovered == Some(cell.cell.layer) {
        ui.painter().rect_filled(rect, 2, theme::colours().raised);
    }
    let texts = texts(probed, cell);
    for (number, (text, (_, edge, _))) in texts.iter().zip(COLUMNS).enumerate() {
        let place = pos2(rect.left() + edge, rect.center().y);
        if number == CLASS {
            let swatch = Rect::from_center_size(place + vec2(5.0, 0.0), vec2(10.0, 10.0));
            ui.painter().rect_filled(swatch, 2, colour(cell.cell.class));
            let font = egui::FontId::proportional(12.5);
            ui.painter().text(
                place + vec2(17.0, 0.0),
                Align2::LEFT_CENTER,
                text,
                font,
                theme::colours().text,
            );
        } else {
            let ink = if text == NOTHING { theme::colours().faint } else { theme::colours().text };
            ui.painter().text(place, Align2::RIGHT_CENTER, text, theme::number_font(), ink);
        }
    }
    response.hovered()
}

/// Where there is nothing to say.
const NOTHING: &str = "–";

fn texts(probed: &Probed, cell: &CellDetail) -> [String; COLUMNS.len()] {
    let decimals = decimals(cell.depths);
    let [near, far] = cell.depths.map(|depth| format!("{depth:.decimals$}"));
    let cheap = || NOTHING.to_owned();
    let bricks = match (cell.cell.sampled.count(), cell.cell.coarse.count()) {
        (0, 0) => cheap(),
        (sampled, 0) => sampled.to_string(),
        (sampled, coarse) => format!("{sampled}+{coarse}"),
    };
    let charged = cell.charged(probed.column());
    [
        cell.cell.layer.to_string(),
        format!("{near}–{far}"),
        look(cell.cell.class).name.to_owned(),
        widgets::count(u64::from(cell.cell.particles)),
        bounds(cell.values, &probed.placement),
        bricks,
        if charged > 0.0 { format!("{charged:.1e}") } else { cheap() },
    ]
}

/// Decimals by which the ends of a cell are told apart, so that all lines have about as many.
fn decimals([near, far]: [f64; 2]) -> usize {
    let step = (far - near).max(f64::MIN_POSITIVE);
    (1.0 - step.log10().floor()).clamp(0.0, 6.0) as usize
}

/// On the axis of the transfer function.
fn bounds(values: KnownValues, placement: &Placement) -> String {
    match values {
        KnownValues::Unknown => NOTHING.to_owned(),
        KnownValues::Empty => "empty".to_owned(),
        KnownValues::Between { low, high, .. } => {
            let [low, high] = [low, high].map(|device| placement.u(f64::from(device)));
            format!("{low:.3}–{high:.3}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_a_cell_are_told_apart() {
        assert_eq!(decimals([4.821, 4.885]), 3);
        assert_eq!(decimals([5.2, 5.29]), 3);
        assert_eq!(decimals([100.0, 180.0]), 0);
        assert_eq!(decimals([1e-9, 2e-9]), 6);
    }

    #[test]
    fn bounds_are_short() {
        let between = KnownValues::Between { low: 0.12345, high: 1.0, covered: true };
        assert_eq!(
            [between, KnownValues::Empty, KnownValues::Unknown]
                .map(|values| bounds(values, &Placement::default())),
            ["0.123–1.000", "empty", "–"]
        );
    }
}
