//! The cells of the picture in view by class, as counts and shares.

use egui::{Align2, Color32, Rect, Sense, Ui, pos2, vec2};
use renderer::{CellClass, CellClasses};

use crate::overlay::look;
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

pub fn show(ui: &mut Ui, session: &Session) {
    let Some(picture) = &session.picture else { return };
    let entries = entries(&picture.stats.cells_by_class);
    stacked(ui, &entries);
    legend(ui, &entries);
}

/// A class with its count and its share of all cells.
struct Entry {
    class: CellClass,
    count: u64,
    share: f64,
}

/// All classes; of the sampling levels those that there are.
fn entries(classes: &CellClasses) -> Vec<Entry> {
    let all = CellClass::ALL.map(|class| classes.count(class)).iter().sum::<u64>().max(1) as f64;
    CellClass::ALL
        .into_iter()
        .map(|class| (class, classes.count(class)))
        .filter(|(class, count)| *count > 0 || !matches!(class, CellClass::ZAdaptive(_)))
        .map(|(class, count)| Entry { class, count, share: count as f64 / all })
        .collect()
}

/// The colour of a class.
pub fn colour(class: CellClass) -> Color32 {
    let [r, g, b] = look(class).rgb;
    Color32::from_rgb(r, g, b)
}

/// One bar, divided as the cells are.
fn stacked(ui: &mut Ui, entries: &[Entry]) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 10.0), Sense::hover());
    ui.painter().rect_filled(rect, 2, theme::colours().well);
    let mut left = rect.left();
    for Entry { class, share, .. } in entries {
        let right = left + *share as f32 * rect.width();
        let part = Rect::from_min_max(pos2(left, rect.top()), pos2(right, rect.bottom()));
        ui.painter().rect_filled(part, 2, colour(*class));
        left = right;
    }
}

/// What the colours are: name, count and share of each class.
fn legend(ui: &mut Ui, entries: &[Entry]) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for Entry { class, count, share } in entries {
            let (rect, line) = ui.allocate_exact_size(vec2(ui.available_width(), 18.0), Sense::hover());
            let swatch = Rect::from_center_size(rect.left_center() + vec2(5.0, 0.0), vec2(10.0, 10.0));
            let painter = ui.painter();
            painter.rect_filled(swatch, 2, colour(*class));
            let font = egui::TextStyle::Body.resolve(ui.style());
            let name_at = rect.left_center() + vec2(18.0, 0.0);
            painter.text(name_at, Align2::LEFT_CENTER, look(*class).name, font, theme::colours().muted);
            let number = |place, text: String| {
                painter.text(place, Align2::RIGHT_CENTER, text, theme::number_font(), theme::colours().text);
            };
            number(rect.right_center() - vec2(64.0, 0.0), widgets::count(*count));
            number(rect.right_center(), widgets::percent(*share));
            line.on_hover_text(look(*class).meaning);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_of_all_cells() {
        let classes = CellClasses { full: 1, super_pixel: 2, transparent: 1, ..CellClasses::default() };
        let shares =
            |classes: &CellClasses| entries(classes).iter().map(|entry| entry.share).collect::<Vec<f64>>();
        assert_eq!(shares(&classes), [0.25, 0.0, 0.5, 0.25, 0.0]);
        assert_eq!(shares(&CellClasses::default()), [0.0; 5]);
        let levels = CellClasses { z_adaptive: [0, 3, 0, 1], ..CellClasses::default() };
        assert_eq!(shares(&levels), [0.0, 0.0, 0.75, 0.25, 0.0, 0.0, 0.0]);
    }
}
