//! What adaptive sampling brought for the picture in view: predicted error, cells by class, samples.

use egui::{Align2, Color32, Rect, Sense, Ui, pos2, vec2};
use renderer::CellClasses;

use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

use super::sampling::plain;

/// Classes of cells, from the dearest to the cheapest: name, colour, meaning, and how many there are.
type Class = (&'static str, Color32, &'static str, fn(&CellClasses) -> u64);

const CLASSES: [Class; 5] = [
    ("Full", Color32::from_rgb(0xe0, 0x8e, 0x45), "Sampled as a whole", |c| c.full),
    (
        "Mixed",
        Color32::from_rgb(0xe9, 0xcf, 0x7c),
        "Sampled in some bricks, shown by one colour each in the others",
        |c| c.mixed,
    ),
    ("Super-pixel", theme::ACCENT, "Shown by single colours, without a sample", |c| c.super_pixel),
    ("Transparent", Color32::from_rgb(0x8b, 0x95, 0xa5), "With nothing to be seen in them", |c| {
        c.transparent
    }),
    ("Occluded", Color32::from_rgb(0x50, 0x58, 0x65), "Behind what lets no light through", |c| c.occluded),
];

pub fn show(ui: &mut Ui, session: &Session) {
    let Some(picture) = &session.picture else { return };
    let stats = &picture.stats;
    ui.scope(|ui| {
        let predicted = match picture.sampling.tolerance {
            Some(tolerance) => format!("{} of {tolerance}", plain(stats.predicted_error)),
            None => "0, sampled in full".into(),
        };
        widgets::fact(ui, "Predicted error", predicted)
            .on_hover_text("The largest that any pixel may have, of the tolerance that it may use up");
        let evaluations = &stats.evaluations;
        widgets::fact(ui, "Evaluations", widgets::large(evaluations.done)).on_hover_text(format!(
            "Kernel weights computed for one particle at one place; {} of them to find out what may be left \
             out",
            widgets::large(evaluations.bounds)
        ));
    });
    ui.add_space(4.0);
    let counts = CLASSES.map(|(.., count)| count(&stats.cells_by_class));
    stacked(ui, &counts);
    legend(ui, &counts);
}

/// One bar, divided as the cells are.
fn stacked(ui: &mut Ui, counts: &[u64; CLASSES.len()]) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 10.0), Sense::hover());
    ui.painter().rect_filled(rect, 2, theme::WELL);
    let mut left = rect.left();
    for ((_, colour, ..), share) in CLASSES.iter().zip(shares(counts)) {
        let right = left + share as f32 * rect.width();
        let part = Rect::from_min_max(pos2(left, rect.top()), pos2(right, rect.bottom()));
        ui.painter().rect_filled(part, 2, *colour);
        left = right;
    }
}

/// What the colours are: name, count and share of each class.
fn legend(ui: &mut Ui, counts: &[u64; CLASSES.len()]) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for (((name, colour, meaning, _), count), share) in CLASSES.iter().zip(counts).zip(shares(counts)) {
            let (rect, line) = ui.allocate_exact_size(vec2(ui.available_width(), 18.0), Sense::hover());
            let swatch = Rect::from_center_size(rect.left_center() + vec2(5.0, 0.0), vec2(10.0, 10.0));
            let painter = ui.painter();
            painter.rect_filled(swatch, 2, *colour);
            let font = egui::TextStyle::Body.resolve(ui.style());
            let name_at = rect.left_center() + vec2(18.0, 0.0);
            painter.text(name_at, Align2::LEFT_CENTER, name, font, theme::MUTED);
            let number = |place, text: String| {
                painter.text(place, Align2::RIGHT_CENTER, text, theme::number_font(), theme::TEXT);
            };
            number(rect.right_center() - vec2(64.0, 0.0), widgets::count(*count));
            number(rect.right_center(), widgets::percent(share));
            line.on_hover_text(*meaning);
        }
    });
}

/// Of all cells that hold particles.
fn shares(counts: &[u64; CLASSES.len()]) -> [f64; CLASSES.len()] {
    let all = counts.iter().sum::<u64>().max(1) as f64;
    counts.map(|count| count as f64 / all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_of_all_cells() {
        assert_eq!(shares(&[1, 0, 2, 1, 0]), [0.25, 0.0, 0.5, 0.25, 0.0]);
        assert_eq!(shares(&[0; 5]), [0.0; 5]);
    }
}
