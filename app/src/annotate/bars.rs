//! The bars at the right edge: which colour is which value, and how opaque which value is where another field
//! decides that. Two stand one above the other.

use renderer::{AnnotationsView, Scale};

use super::drawing::{Drawing, END, MIDDLE, Sheet};
use super::ticks::{Tick, ticks};
use super::{Subject, colour_bar, opacity_bar};

/// Sizes in letters: the largest height of a bar and the least, and its distance from the picture's edge.
const HEIGHT: f32 = 16.0;
const LEAST: f32 = 5.0;
const EDGE: f32 = 1.4;
/// What stays free above and below, and between two bars; and the width of a picture that has room for them.
const AROUND: f32 = 7.0;
const BETWEEN: f32 = 4.4;
const ROOM: f32 = 16.0;
/// Least distance between two values.
const LINE: f32 = 1.15;

/// Draws those that `look` asks for, as many as the picture has room for.
pub fn draw(drawing: &mut Drawing, subject: &Subject, look: &AnnotationsView) {
    let colour = subject.range.filter(|_| look.colour_bar);
    let opacity = subject.opacity.as_ref().filter(|_| look.opacity_bar);
    let count = usize::from(colour.is_some()) + usize::from(opacity.is_some());
    let mut places = places(drawing.sheet, count).into_iter();
    if let (Some(range), Some(place)) = (colour, colour.and_then(|_| places.next())) {
        let name = titled(&look.quantity_label, subject.quantity.as_deref().unwrap_or_default());
        colour_bar::draw(drawing, subject, &Bar { place, range, scale: subject.scale, name });
    }
    if let (Some(axis), Some(place)) = (opacity, places.next()) {
        let name = titled(&look.opacity_label, &format!("{} (opacity)", axis.name));
        opacity_bar::draw(drawing, subject, &Bar { place, range: axis.range, scale: axis.scale, name });
    }
}

/// A bar that is to be drawn.
pub struct Bar {
    place: [f32; 2],
    range: [f64; 2],
    scale: Scale,
    name: String,
}

impl Bar {
    /// Upper left and lower right corner, where it is `width` letters wide.
    pub fn corners(&self, sheet: Sheet, width: f32) -> [[f32; 2]; 2] {
        let right = (sheet.width - EDGE * sheet.em).round();
        let [top, bottom] = self.place;
        [[right - (width * sheet.em).round(), top], [right, bottom]]
    }

    /// Values to the left of the bar, and its name above it.
    pub fn rule(&self, drawing: &mut Drawing, [[left, top], [right, bottom]]: [[f32; 2]; 2]) {
        let (em, letters) = (drawing.sheet.em, drawing.palette().letters);
        let ticks = ticks(self.range, self.scale);
        for tick in roomy(&ticks, LINE * em / (bottom - top)) {
            let y = bottom - tick.share * (bottom - top);
            drawing.line([left - 0.35 * em, y], [left, y], 0.6, letters);
            drawing.text([left - 0.6 * em, y], [END, MIDDLE], 0.92, &tick.label, letters);
        }
        drawing.text([right, top - 1.0 * em], [END, END], 1.0, &self.name, letters);
    }
}

/// Those ticks that are no closer than `apart` to the ones before and to the last one: both ends stay.
fn roomy(ticks: &[Tick], apart: f32) -> Vec<&Tick> {
    let Some((last, others)) = ticks.split_last() else { return Vec::new() };
    let mut kept: Vec<&Tick> = Vec::new();
    for tick in others {
        let free = kept.last().is_none_or(|before| tick.share - before.share >= apart);
        if kept.is_empty() || (free && last.share - tick.share >= apart) {
            kept.push(tick);
        }
    }
    kept.push(last);
    kept
}

fn titled(label: &str, otherwise: &str) -> String {
    if label.is_empty() { otherwise } else { label }.to_owned()
}

/// Upper and lower end of each of `count` bars, or of fewer where there is no room.
fn places(sheet: Sheet, count: usize) -> Vec<[f32; 2]> {
    let em = sheet.em;
    let of = |count: usize| {
        let between = BETWEEN * em * (count - 1) as f32;
        let height = (HEIGHT * em).min((sheet.height - AROUND * em - between) / count as f32);
        let first = 0.5 * (sheet.height - between - count as f32 * height);
        let place = |row: usize| {
            let top = (first + row as f32 * (height + BETWEEN * em)).round();
            [top, (top + height).round()]
        };
        (height >= LEAST * em && sheet.width >= ROOM * em).then(|| (0..count).map(place).collect())
    };
    (1..=count).rev().find_map(of).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_would_touch_are_left_out() {
        let all = ticks([10.0, 1100.0], Scale::Log);
        let labels = |apart| roomy(&all, apart).iter().map(|tick| &*tick.label).collect::<Vec<_>>();
        assert_eq!(labels(0.01).len(), all.len());
        assert_eq!(labels(0.2), ["10", "50", "200", "1100"]);
        assert_eq!(labels(0.9), ["10", "1100"]);
    }

    #[test]
    fn two_bars_stand_apart_and_give_way_to_one_where_there_is_no_room() {
        for height in [240.0, 300.0, 480.0, 1080.0, 2160.0] {
            let sheet = Sheet::new([1.6 * height, height], 1.0);
            let [above, below] = places(sheet, 2)[..] else { panic!("no room at {height}") };
            assert!(above[0] > 2.0 * sheet.em && below[1] < height - 2.0 * sheet.em);
            assert!(below[0] - above[1] >= (BETWEEN - 0.1) * sheet.em, "{above:?} {below:?}");
            assert_eq!(places(sheet, 1).len(), 1);
        }
        assert_eq!(places(Sheet::new([300.0, 150.0], 1.0), 2).len(), 1);
        assert_eq!(places(Sheet::new([300.0, 60.0], 1.0), 2).len(), 0);
        assert_eq!(places(Sheet::new([100.0, 900.0], 1.0), 2).len(), 0);
    }
}
