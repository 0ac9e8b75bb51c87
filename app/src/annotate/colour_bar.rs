//! The colour bar: which colour is which value.

use crate::image_file::to_srgb;

use super::Subject;
use super::drawing::{Drawing, END, MIDDLE};
use super::ticks::ticks;

/// Colours along the bar.
const STEPS: usize = 65;
/// Sizes in letters: the bar's width and largest height, and its distance from the picture's edge.
const WIDTH: f32 = 0.95;
const HEIGHT: f32 = 16.0;
const EDGE: f32 = 1.4;

/// Draws it at the right edge, in a picture that has room for it.
pub fn draw(drawing: &mut Drawing, subject: &Subject, label: &str) {
    let Some(range) = subject.range else { return };
    let sheet = drawing.sheet;
    let em = sheet.em;
    let height = (HEIGHT * em).min(sheet.height - 7.0 * em);
    if height < 5.0 * em || sheet.width < 16.0 * em {
        return;
    }
    let right = (sheet.width - EDGE * em).round();
    let left = right - (WIDTH * em).round();
    let top = (0.5 * (sheet.height - height)).round();
    let bottom = (top + height).round();
    drawing.gradient([left, top], [right, bottom], colours(subject));
    let letters = drawing.palette().letters;
    for tick in ticks(range, subject.scale) {
        let y = bottom - tick.share * (bottom - top);
        drawing.line([left - 0.35 * em, y], [left, y], 0.6, letters);
        drawing.text([left - 0.6 * em, y], [END, MIDDLE], 0.92, &tick.label, letters);
    }
    let name = if label.is_empty() { subject.quantity.as_deref().unwrap_or_default() } else { label };
    drawing.text([right, top - 1.0 * em], [END, END], 1.0, name, letters);
}

/// sRGB from u = 0 to u = 1.
fn colours(subject: &Subject) -> Vec<[u8; 3]> {
    let colour = |step: usize| {
        let [r, g, b, _] = subject.transfer.sample(step as f32 / (STEPS - 1) as f32);
        [r, g, b].map(|channel| (255.0 * to_srgb(channel.clamp(0.0, 1.0))).round() as u8)
    };
    (0..STEPS).map(colour).collect()
}
