//! The scale bar: a round length at the target's depth. In perspective it holds for no other.

use renderer::AnnotationsView;

use super::Subject;
use super::drawing::{Drawing, END, MIDDLE, START};
use super::stamp::with_unit;
use super::ticks::round_below;

/// Sizes in letters: the bar's largest length, its place when there are axes beside it or not, and the
/// picture that has room for it.
const LENGTH: f32 = 12.0;
const BESIDE_AXES: f32 = 7.5;
const ALONE: f32 = 1.4;
const ROOM: [f32; 2] = [24.0, 10.0];

pub fn draw(drawing: &mut Drawing, subject: &Subject, look: &AnnotationsView) {
    let sheet = drawing.sheet;
    let em = sheet.em;
    let depth = subject.target_depth;
    let length_of_pixel = subject.projection.length_at(depth);
    let most = f64::from((LENGTH * em).min(0.3 * sheet.width)) * length_of_pixel;
    let room = sheet.width >= ROOM[0] * em && sheet.height >= ROOM[1] * em;
    if !room || most <= 0.0 || !most.is_finite() {
        return;
    }
    let length = round_below(most);
    let left = (if look.axes { BESIDE_AXES } else { ALONE }) * em;
    let right = left + (length / length_of_pixel) as f32;
    let y = (sheet.height - 2.7 * em).round();
    let letters = drawing.palette().letters;
    for x in [left, right] {
        drawing.line([x, y - 0.4 * em], [x, y + 0.4 * em], 1.0, letters);
    }
    drawing.line([left, y], [right, y], 1.0, letters);
    let label = with_unit(length, &look.length_unit);
    drawing.text([0.5 * (left + right), y - 0.35 * em], [MIDDLE, END], 1.0, &label, letters);
    let holds = format!("at the target's depth, {}", with_unit(depth, &look.length_unit));
    drawing.text([left, y + 0.55 * em], [START, START], 0.8, &holds, letters);
}
