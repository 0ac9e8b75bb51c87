//! The inspector: the cells behind one pixel, as a plot and as a table.

use egui::{Align, Layout, Pos2, RichText, Ui, pos2, vec2};
use renderer::{Bound, CellClass, CellDetail};

use crate::viewer::icons::{self, Icon};
use crate::viewer::inspect::probe::Probed;
use crate::viewer::session::Session;
use crate::viewer::theme;
use crate::viewer::widgets;

use super::sampling::plain;
use super::{inspector_plot, inspector_table};

/// What the inspector remembers between frames.
#[derive(Default)]
pub struct Inspector {
    /// The layer of the cell under the mouse.
    pub hovered: Option<u32>,
}

/// Size of the contents, in points.
const WIDTH: f32 = 492.0;
/// Of the table: what a window of usual height leaves, and the least.
const TABLE_HEIGHTS: [f32; 2] = [216.0, 80.0];
/// Height of everything else, with some of the window to spare.
const OTHERS: f32 = 410.0;
const MARGIN: f32 = 16.0;

impl Inspector {
    /// Shows the window, beside what it is about, where a pixel was chosen.
    pub fn show(&mut self, ui: &Ui, session: &mut Session, picture: egui::Rect) {
        let Some([x, y]) = session.probe else { return };
        let scale = ui.ctx().pixels_per_point();
        let place = picture.min + vec2(x as f32, y as f32) / scale;
        let mut open = true;
        widgets::card(ui, ["Inspector", "inspector"], corner(place, picture), WIDTH, |ui| {
            open = header(ui, [x, y]);
            self.contents(ui, session);
        });
        if !open {
            session.probe = None;
        }
    }

    fn contents(&mut self, ui: &mut Ui, session: &Session) {
        let probed = session.picture.as_ref().and_then(|picture| picture.probed.as_ref());
        let Some(probed) = probed else {
            ui.add_sized(
                vec2(WIDTH, 60.0),
                egui::Label::new(RichText::new("Looking…").color(theme::colours().muted)),
            );
            return;
        };
        facts(ui, probed);
        if probed.bundle.cells.is_empty() {
            let text =
                RichText::new("No particle reaches the rays of this bundle.").color(theme::colours().muted);
            ui.add_sized(vec2(WIDTH, 60.0), egui::Label::new(text));
            return;
        }
        let mut hovered = None;
        inspector_plot::show(ui, session, probed, self.hovered, &mut hovered);
        ui.add_space(6.0);
        let [most, least] = TABLE_HEIGHTS;
        let height = (ui.ctx().content_rect().height() - OTHERS).clamp(least, most);
        inspector_table::show(ui, probed, height, self.hovered, &mut hovered);
        if hovered != self.hovered {
            self.hovered = hovered;
            ui.ctx().request_repaint();
        }
    }
}

/// Title and cross. Returns whether the window stays open.
fn header(ui: &mut Ui, [x, y]: [u32; 2]) -> bool {
    ui.horizontal(|ui| {
        ui.label(RichText::new(format!("Pixel {x}, {y}")).heading().strong());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            !icons::button(ui, Icon::Cross, "Close (Escape)", true).clicked()
        })
        .inner
    })
    .inner
}

/// Where the window opens: on the side of the picture where the pixel is not.
fn corner(pixel: Pos2, picture: egui::Rect) -> Pos2 {
    let outer = WIDTH + 2.0 * MARGIN;
    let left = picture.left() + MARGIN;
    let right = (picture.right() - outer - MARGIN).max(left);
    pos2(if pixel.x < picture.center().x { right } else { left }, picture.top() + MARGIN)
}

/// The bundle in a few words.
fn facts(ui: &mut Ui, probed: &Probed) {
    let bundle = &probed.bundle;
    let [x, y] = bundle.bundle;
    let particles: u64 = bundle.cells.iter().map(|cell| u64::from(cell.cell.particles)).sum();
    let occluded = bundle.cells.iter().filter(|cell| cell.cell.class == CellClass::Occluded).count();
    let coarse = match probed.divisor {
        1 => String::new(),
        divisor => format!(" at 1/{divisor} resolution"),
    };
    let first = format!(
        "Bundle {x}, {y}{coarse}  ·  {} of {} cells filled, {occluded} occluded  ·  {} particle references",
        bundle.cells.len(),
        bundle.layers,
        widgets::count(particles),
    );
    let charged = plain(f64::from(bundle.charged[probed.column()]));
    let second = match (bundle.budget.map(|budget| plain(f64::from(budget))), bundle.bound) {
        (None, _) => "Sampled in full: nothing is charged to the budget".to_owned(),
        (Some(budget), Bound::Difference) => {
            format!("Charged to the rays of this pixel: {charged} of {budget}")
        }
        (Some(budget), Bound::Paper) => {
            format!("Charged to the rays of this bundle, by their interval as a whole: {charged} of {budget}")
        }
    };
    for text in [first, second] {
        ui.label(RichText::new(text).small().color(theme::colours().muted));
    }
    ui.add_space(4.0);
}

/// What lies in front of a cell and in it is charged to a column, cell by cell.
pub fn cumulative(cells: &[CellDetail], column: usize) -> Vec<f32> {
    let add = |sum: &mut f32, cell: &CellDetail| {
        *sum += cell.charged(column);
        Some(*sum)
    };
    cells.iter().scan(0.0, add).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::Rect;

    #[test]
    fn the_window_opens_beside_its_pixel() {
        let picture = Rect::from_min_size(pos2(0.0, 40.0), vec2(1200.0, 700.0));
        let of_left = corner(pos2(100.0, 100.0), picture);
        let of_right = corner(pos2(1100.0, 100.0), picture);
        assert!(of_left.x > 600.0 && of_right.x < 100.0, "{of_left:?} {of_right:?}");
        // In a narrow picture it begins at the left in any case.
        let narrow = Rect::from_min_size(pos2(0.0, 40.0), vec2(400.0, 300.0));
        assert_eq!(corner(pos2(10.0, 50.0), narrow), corner(pos2(390.0, 50.0), narrow));
    }
}
