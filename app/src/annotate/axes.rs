//! Small axes in the lower left corner: which way the scene is turned.

use glam::DVec3;

use super::Subject;
use super::drawing::{Drawing, MIDDLE};

/// Sizes in letters: from the corner to the axes' origin, their length, and the distance of their names.
const CORNER: f32 = 3.2;
const LENGTH: f32 = 1.75;
const NAME: f32 = 2.4;
/// Least height of a picture that has room for them.
const ROOM: f32 = 10.0;

pub fn draw(drawing: &mut Drawing, subject: &Subject) {
    let sheet = drawing.sheet;
    let em = sheet.em;
    if sheet.height < ROOM * em || sheet.width < ROOM * em {
        return;
    }
    let origin = [CORNER * em, sheet.height - CORNER * em];
    let projection = &subject.projection;
    let mut axes: Vec<(DVec3, &str, [u8; 4])> = [(DVec3::X, "X"), (DVec3::Y, "Y"), (DVec3::Z, "Z")]
        .into_iter()
        .zip(drawing.palette().axes)
        .map(|((axis, name), colour)| (axis, name, colour))
        .collect();
    // The farthest first: those in front are drawn over it.
    axes.sort_by(|a, b| b.0.dot(projection.forward).total_cmp(&a.0.dot(projection.forward)));
    for (axis, name, colour) in axes {
        let [x, y] = [axis.dot(projection.right) as f32, -axis.dot(projection.up) as f32];
        let at = |length: f32| [origin[0] + length * em * x, origin[1] + length * em * y];
        drawing.line(origin, at(LENGTH), 1.1, colour);
        if x.hypot(y) >= 0.3 {
            drawing.text(at(NAME), [MIDDLE, MIDDLE], 0.9, name, colour);
        }
    }
}
