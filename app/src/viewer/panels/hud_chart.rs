//! The chart of the performance display: a bar for each picture, stage over stage, and below it lanes of
//! resolution and error.

use egui::{Align2, Color32, Painter, Rect, Sense, Stroke, Ui, pos2, vec2};

use crate::viewer::session::{Costs, Entry, Stage};
use crate::viewer::{theme, widgets};

/// Heights of the bars, of a lane, and of the space between, in points.
const BARS: f32 = 104.0;
const LANE: f32 = 14.0;
const GAP: f32 = 5.0;
/// Room for what is written at the left.
const LEFT: f32 = 62.0;
/// What takes more than so many times the median is cut off at the upper end.
const USUAL: f64 = 4.0;
/// Steps of the scale.
const TICKS: u8 = 2;

/// The colour of a stage.
pub fn colour(stage: Stage) -> Color32 {
    match stage {
        Stage::Upload => Color32::from_rgb(0x6f, 0x8f, 0xd8),
        Stage::Grid => Color32::from_rgb(0x4f, 0xb3, 0xbf),
        Stage::Analysis => Color32::from_rgb(0xe8, 0xb9, 0x5b),
        Stage::RayCast => Color32::from_rgb(0xd9, 0x6b, 0x45),
        Stage::Prepare => Color32::from_rgb(0x9a, 0x84, 0xb8),
        Stage::Other => Color32::from_rgb(0x5a, 0x64, 0x70),
        Stage::Read => Color32::from_rgb(0xa9, 0xb2, 0xbd),
    }
}

/// Shows the chart. Returns the number of the picture under the mouse. `limit` is the time that a picture
/// is to keep, in milliseconds.
pub fn show(ui: &mut Ui, costs: &Costs, limit: Option<f64>, hovered: Option<usize>) -> Option<usize> {
    let size = vec2(ui.available_width(), BARS + 2.0 * (GAP + LANE));
    let (outer, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Times of the last pictures"));
    let below =
        |rect: Rect| rect.translate(vec2(0.0, rect.height() + GAP)).with_max_y(rect.bottom() + GAP + LANE);
    let bars =
        Rect::from_min_max(pos2(outer.left() + LEFT, outer.top()), pos2(outer.right(), outer.top() + BARS));
    let resolution = below(bars).with_min_y(bars.bottom() + GAP);
    let error = below(resolution);
    let painter = ui.painter();
    for rect in [bars, resolution, error] {
        painter.rect_filled(rect, 2, Color32::from_black_alpha(120));
    }
    let columns = Columns { left: bars.left(), width: bars.width(), count: costs.entries().len() };
    if let Some(number) = hovered.filter(|number| *number < columns.count) {
        let band = Rect::from_x_y_ranges(columns.of(number), bars.top()..=error.bottom());
        painter.rect_filled(band, 0, Color32::from_white_alpha(40));
    }
    let top = scale(costs);
    ticks(painter, bars, top);
    for (number, entry) in costs.entries().enumerate() {
        let place = columns.of(number);
        stack(painter, bars, place, entry, top);
        // A fifth less for each halving: 1/16 is still to be seen.
        let share = 1.0 - 0.2 * f64::from(entry.divisor.max(1)).log2();
        lane(painter, resolution, place, share, theme::DARK.accent.gamma_multiply(0.75));
        if let (Some(tolerance), Some(predicted)) = (entry.tolerance, entry.predicted) {
            let colour = if entry.is_raised() { theme::DARK.warning } else { theme::DARK.muted };
            lane(painter, error, place, predicted / tolerance, colour.gamma_multiply(0.8));
        }
    }
    if let Some(limit) = limit.filter(|limit| *limit <= top) {
        let y = bars.bottom() - (limit / top) as f32 * bars.height();
        let ends = [pos2(bars.left(), y), pos2(bars.right(), y)];
        painter.extend(egui::Shape::dashed_line(&ends, Stroke::new(1.0, theme::DARK.warning), 4.0, 3.0));
    }
    for (rect, text) in [(resolution, "Resolution"), (error, "Error share")] {
        caption(painter, rect, rect.center().y, text);
    }
    let over = response.hover_pos().filter(|place| bars.x_range().contains(place.x))?;
    columns.at(over.x)
}

/// Places of the pictures, the newest at the right end.
struct Columns {
    left: f32,
    width: f32,
    count: usize,
}

impl Columns {
    fn step(&self) -> f32 {
        self.width / Costs::MOST as f32
    }

    fn of(&self, number: usize) -> egui::Rangef {
        let left = self.left + self.width - (self.count - number) as f32 * self.step();
        egui::Rangef::new(left, left + self.step())
    }

    fn at(&self, x: f32) -> Option<usize> {
        let from_right = ((self.left + self.width - x) / self.step()).floor() as usize + 1;
        self.count.checked_sub(from_right)
    }
}

/// Milliseconds at the upper end: a round number above all pictures, but for those that take much longer
/// than most. Full pictures at rest would flatten those of a movement.
fn scale(costs: &Costs) -> f64 {
    let mut totals: Vec<f64> = costs.entries().map(Entry::total).collect();
    totals.sort_by(f64::total_cmp);
    let median = totals.get(totals.len() / 2).copied().unwrap_or(1.0);
    let longest = totals.last().copied().unwrap_or(1.0);
    round_up(longest.min(USUAL * median).max(1e-3))
}

/// The next number of the form 1, 2, 3, 4, 5, 6, 8 times a power of ten.
fn round_up(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let found = steps.into_iter().find(|step| step * power >= value * (1.0 - 1e-9));
    found.unwrap_or(10.0) * power
}

fn ticks(painter: &Painter, rect: Rect, top: f64) {
    for tick in 0..=TICKS {
        let share = f32::from(tick) / f32::from(TICKS);
        let y = rect.bottom() - share * rect.height();
        painter.hline(rect.x_range(), y, Stroke::new(1.0, Color32::from_white_alpha(22)));
        let value = widgets::short(f64::from(share) * top);
        let text = if tick == TICKS { format!("{value} ms") } else { value };
        // Inside the height of the chart.
        caption(painter, rect, y.clamp(rect.top() + 6.0, rect.bottom() - 6.0), &text);
    }
}

fn caption(painter: &Painter, rect: Rect, y: f32, text: &str) {
    let place = pos2(rect.left() - 6.0, y);
    painter.text(place, Align2::RIGHT_CENTER, text, egui::FontId::proportional(10.5), theme::DARK.muted);
}

/// The stages of a picture over one another.
fn stack(painter: &Painter, rect: Rect, place: egui::Rangef, entry: &Entry, top: f64) {
    let height = |milliseconds: f64| (milliseconds / top) as f32 * rect.height();
    let mut bottom = rect.bottom();
    for stage in Stage::ALL {
        let above = (bottom - height(entry.of(stage))).max(rect.top());
        let part = Rect::from_x_y_ranges(place, above..=bottom);
        match stage {
            // Beside the others in time, and not one of them.
            Stage::Read => painter.rect_filled(part, 0, colour(stage).gamma_multiply(0.35)),
            _ => painter.rect_filled(part, 0, colour(stage)),
        };
        bottom = above;
    }
    if entry.total() > top {
        let cap = Rect::from_x_y_ranges(place, rect.top()..=rect.top() + 2.0);
        painter.rect_filled(cap, 0, Color32::WHITE);
    }
}

/// A share of the height of a lane.
fn lane(painter: &Painter, rect: Rect, place: egui::Rangef, share: f64, colour: Color32) {
    let top = rect.bottom() - share.clamp(0.0, 1.0) as f32 * rect.height();
    painter.rect_filled(Rect::from_x_y_ranges(place, top..=rect.bottom()), 0, colour);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_ends_at_a_round_number() {
        assert_eq!([0.9, 1.0, 11.0, 47.0, 61.0, 99.0].map(round_up), [1.0, 1.0, 20.0, 50.0, 80.0, 100.0]);
        assert_eq!(scale(&Costs::default()), 1.0);
    }

    #[test]
    fn the_newest_picture_is_at_the_right_end() {
        let columns = Columns { left: 0.0, width: 240.0, count: 3 };
        assert_eq!((columns.at(239.0), columns.at(235.0), columns.at(100.0)), (Some(2), Some(0), None));
        assert_eq!((columns.of(2).max, columns.of(0).min), (240.0, 234.0));
    }
}
