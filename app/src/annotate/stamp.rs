//! The time and number of the frame, in the upper left corner.

use renderer::AnnotationsView;

use crate::numbers::short;

use super::Subject;
use super::drawing::{Drawing, START};

/// Width that it takes, in letters, unless units are long.
pub const ROOM: f32 = 8.0;

pub fn draw(drawing: &mut Drawing, subject: &Subject, look: &AnnotationsView) {
    let time =
        subject.time.filter(|_| look.time).map(|time| format!("t = {}", with_unit(time, &look.time_unit)));
    let frame = look.frame_number.then(|| format!("frame {}", subject.frame));
    let em = drawing.sheet.em;
    let letters = drawing.palette().letters;
    for (row, text) in [time, frame].into_iter().flatten().enumerate() {
        let at = [1.3 * em, (1.1 + 1.35 * row as f32) * em];
        drawing.text(at, [START, START], 1.0, &text, letters);
    }
}

/// A number with its unit, where there is one.
pub fn with_unit(value: f64, unit: &str) -> String {
    match unit.trim() {
        "" => short(value),
        unit => format!("{} {unit}", short(value)),
    }
}
