//! The colour bar: which colour is which value.

use crate::image_file::to_srgb;

use super::Subject;
use super::bars::Bar;
use super::drawing::Drawing;

/// Colours along the bar.
const STEPS: usize = 65;
/// In letters.
const WIDTH: f32 = 0.95;

pub fn draw(drawing: &mut Drawing, subject: &Subject, bar: &Bar) {
    let corners = bar.corners(drawing.sheet, WIDTH);
    drawing.gradient(corners[0], corners[1], colours(subject));
    bar.rule(drawing, corners);
}

/// sRGB from u = 0 to u = 1.
fn colours(subject: &Subject) -> Vec<[u8; 3]> {
    let colour = |step: usize| {
        let [r, g, b, _] = subject.transfer.sample(step as f32 / (STEPS - 1) as f32);
        [r, g, b].map(|channel| (255.0 * to_srgb(channel.clamp(0.0, 1.0))).round() as u8)
    };
    (0..STEPS).map(colour).collect()
}
