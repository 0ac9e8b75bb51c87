//! A clip box in the picture: its edges, a dot on each side to drag it by, and one in the middle.

use glam::{DVec2, DVec3};
use renderer::ClipBox;

use crate::projection::Projection;
use crate::viewer::picture::handles::reach::along;

/// What of a box is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The side at which the axis 0 to 2 begins (`false`) or ends (`true`).
    Side(usize, bool),
    Middle,
}

impl Part {
    pub fn all() -> impl Iterator<Item = Part> {
        let sides = (0..3).flat_map(|axis| [false, true].map(|end| Part::Side(axis, end)));
        sides.chain([Part::Middle])
    }

    /// Where it is in the world.
    pub fn place(self, clip: &ClipBox) -> DVec3 {
        let (middle, half) = clip.middle();
        match self {
            Part::Side(axis, end) => middle + half[axis] * outward(clip, axis, end),
            Part::Middle => middle,
        }
    }

    /// `clip`, as it was when the drag began, with this part dragged from one cursor to another.
    pub fn drag(self, clip: &ClipBox, projection: &Projection, [from, to]: [DVec2; 2]) -> Option<ClipBox> {
        let place = self.place(clip);
        let mut dragged = *clip;
        match self {
            Part::Side(axis, end) => {
                let outward = outward(clip, axis, end);
                let way = along(projection, to, place, outward)? - along(projection, from, place, outward)?;
                let way = way.max(clip.min[axis] - clip.max[axis]);
                let corner = if end { &mut dragged.max } else { &mut dragged.min };
                corner[axis] += if end { way } else { -way };
                // The box turns around its middle, which is another one now: the opposite side stays.
                let (middle, _) = clip.middle();
                let shift = middle + 0.5 * way * outward - dragged.middle().0;
                if clip.rotation_degrees != DVec3::ZERO {
                    (dragged.min, dragged.max) = (dragged.min + shift, dragged.max + shift);
                }
            }
            Part::Middle => {
                let depth = projection.project(place)?.depth;
                let shift = projection.unproject(to, depth) - projection.unproject(from, depth);
                (dragged.min, dragged.max) = (clip.min + shift, clip.max + shift);
            }
        }
        (dragged.min.is_finite() && dragged.max.is_finite()).then_some(dragged)
    }
}

/// The unit vector out of a side.
fn outward(clip: &ClipBox, axis: usize, end: bool) -> DVec3 {
    let direction = clip.axes().col(axis);
    if end { direction } else { -direction }
}

/// The twelve edges in the picture, and whether each is behind the box.
pub fn edges(clip: &ClipBox, projection: &Projection) -> Vec<([DVec2; 2], bool)> {
    let (middle, half) = clip.middle();
    let axes = clip.axes();
    let corner = |signs: [f64; 3]| middle + axes * (half * DVec3::from_array(signs));
    let to_eye = projection.eye - middle;
    let mut edges = Vec::new();
    for axis in 0..3 {
        for [a, b] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
            let [mut from, mut to] = [[0.0; 3]; 2];
            (from[axis], to[axis]) = (-1.0, 1.0);
            let others = [(axis + 1) % 3, (axis + 2) % 3];
            for (other, sign) in others.into_iter().zip([a, b]) {
                (from[other], to[other]) = (sign, sign);
            }
            // An edge is hidden where both of its sides face away from the eye.
            let faces_away = |other: usize, sign: f64| sign * axes.col(other).dot(to_eye) < half[other];
            let hidden = faces_away(others[0], a) && faces_away(others[1], b);
            if let Some(ends) = projection.segment(corner(from), corner(to)) {
                edges.push((ends, hidden));
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::picture::handles::reach::tests::projection;

    fn clip(rotation_degrees: DVec3) -> ClipBox {
        let (min, max) = (DVec3::new(-0.5, -0.4, -0.3), DVec3::new(0.5, 0.6, 0.7));
        ClipBox { min, max, rotation_degrees, invert: false, on: true }
    }

    #[test]
    fn a_side_follows_the_cursor_and_the_others_stay() {
        let p = projection();
        for rotation in [DVec3::ZERO, DVec3::new(20.0, -35.0, 70.0)] {
            let clip = clip(rotation);
            for part in Part::all().filter(|part| *part != Part::Middle) {
                let Part::Side(axis, end) = part else { continue };
                let wish = part.place(&clip) + 0.2 * outward(&clip, axis, end);
                let cursors = [part.place(&clip), wish].map(|point| p.project(point).unwrap().at);
                let dragged = part.drag(&clip, &p, cursors).unwrap();
                assert!(part.place(&dragged).distance(wish) < 1e-9, "{part:?}");
                let opposite = Part::Side(axis, !end);
                assert!(opposite.place(&dragged).distance(opposite.place(&clip)) < 1e-9, "{part:?}");
            }
        }
    }

    #[test]
    fn a_box_is_never_turned_inside_out() {
        let (p, clip) = (projection(), clip(DVec3::ZERO));
        let side = Part::Side(0, true);
        let cursors =
            [side.place(&clip), DVec3::new(-2.0, 0.0, 0.0)].map(|point| p.project(point).unwrap().at);
        let dragged = side.drag(&clip, &p, cursors).unwrap();
        assert_eq!((dragged.min, dragged.max.x), (clip.min, clip.min.x));
    }

    #[test]
    fn the_middle_moves_all_of_it() {
        let (p, clip) = (projection(), clip(DVec3::ZERO));
        let from = p.project(clip.middle().0).unwrap().at;
        let moved = Part::Middle.drag(&clip, &p, [from, from + DVec2::new(30.0, -10.0)]).unwrap();
        let to = p.project(moved.middle().0).unwrap().at;
        assert!(to.distance(from + DVec2::new(30.0, -10.0)) < 1e-9);
        assert!((moved.max - moved.min).distance(clip.max - clip.min) < 1e-12);
    }

    #[test]
    fn from_outside_three_edges_are_hidden() {
        let edges = edges(&clip(DVec3::new(5.0, 10.0, 0.0)), &projection());
        assert_eq!((edges.len(), edges.iter().filter(|(_, hidden)| *hidden).count()), (12, 3));
    }
}
