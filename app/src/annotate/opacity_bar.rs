//! The bar of the opacity, where another field than the colour's decides it: how opaque which value is, as a
//! curve from nothing at the left to the largest opacity at the right. Those that are used are mostly small,
//! and no shade of grey would tell them apart.

use crate::numbers::short;

use super::Subject;
use super::bars::Bar;
use super::drawing::{Drawing, MIDDLE, START};

/// Places along the bar.
const STEPS: usize = 129;
/// In letters.
const WIDTH: f32 = 2.6;

pub fn draw(drawing: &mut Drawing, subject: &Subject, bar: &Bar) {
    let opacity = |step: usize| subject.transfer.sample(step as f32 / (STEPS - 1) as f32)[3];
    let opacities: Vec<f32> = (0..STEPS).map(opacity).collect();
    let most = opacities.iter().copied().fold(0.0, f32::max);
    let shares = opacities.iter().map(|opacity| if most > 0.0 { opacity / most } else { 0.0 });
    let corners @ [[left, _], [right, bottom]] = bar.corners(drawing.sheet, WIDTH);
    drawing.area(corners[0], corners[1], shares.collect());
    bar.rule(drawing, corners);
    let (em, letters) = (drawing.sheet.em, drawing.palette().letters);
    let ends = [(left, 0.0), (right, f64::from(most))];
    for (x, opacity) in ends.into_iter().take(if most > 0.0 { 2 } else { 1 }) {
        let at = [x, bottom + 0.4 * em];
        drawing.text(at, [MIDDLE, START], 0.8, &short(opacity), letters);
    }
}
