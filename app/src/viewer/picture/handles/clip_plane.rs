//! A clip plane in the picture: where it cuts the scene, and an arrow to the side that is kept, whose
//! foot moves the plane and whose tip turns it.

use glam::{DVec2, DVec3};
use renderer::{Bounds, ClipPlane};

use crate::projection::Projection;
use crate::viewer::picture::handles::reach::{along, around};

/// What of a plane is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Foot,
    Tip,
}

/// The arrow: from its foot to its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrow {
    pub foot: DVec3,
    /// A unit vector to the side that is kept.
    pub direction: DVec3,
    pub length: f64,
}

impl Arrow {
    /// The arrow of a plane through a scene of these bounds; `None` for a plane without a direction.
    pub fn new(clip: &ClipPlane, scene: &Bounds) -> Option<Arrow> {
        let normal = clip.direction()?;
        let direction = if clip.invert { -normal } else { normal };
        let middle = scene.centre();
        let foot = middle + (clip.point - middle).dot(normal) * normal;
        // Amid the cut where there is one, so that the arrow stands on what is to be seen.
        let outline = outline(clip, scene);
        let foot = match outline.len() {
            0 => foot,
            corners => outline.iter().fold(DVec3::ZERO, |sum, corner| sum + *corner / corners as f64),
        };
        Some(Arrow { foot, direction, length: 0.22 * scene.diagonal() })
    }

    pub fn tip(&self) -> DVec3 {
        self.foot + self.length * self.direction
    }
}

impl Part {
    /// `clip`, as it was when the drag began, with this part dragged from one cursor to another.
    pub fn drag(
        self,
        clip: &ClipPlane,
        scene: &Bounds,
        projection: &Projection,
        [from, to]: [DVec2; 2],
    ) -> Option<ClipPlane> {
        let Arrow { foot, direction, length } = Arrow::new(clip, scene)?;
        let dragged = match self {
            Part::Foot => {
                let way = along(projection, to, foot, direction)? - along(projection, from, foot, direction)?;
                ClipPlane { point: foot + way * direction, ..*clip }
            }
            Part::Tip => {
                let far = direction.dot(foot - projection.eye) > 0.0;
                let direction = around(projection, to, foot, length, far)?;
                ClipPlane { point: foot, normal: if clip.invert { -direction } else { direction }, ..*clip }
            }
        };
        dragged.point.is_finite().then_some(dragged)
    }
}

/// Corners, one after the other, of the part of the plane that lies in the box around the scene; none
/// where it passes by.
pub fn outline(clip: &ClipPlane, scene: &Bounds) -> Vec<DVec3> {
    let Some(normal) = clip.direction() else { return Vec::new() };
    let corner = |bits: usize| {
        DVec3::from_array(
            [0, 1, 2].map(|axis| if bits >> axis & 1 == 0 { scene.min[axis] } else { scene.max[axis] }),
        )
    };
    let height = |point: DVec3| (point - clip.point).dot(normal);
    let mut corners = Vec::new();
    for bits in 0..8 {
        for axis in (0..3).filter(|axis| bits >> axis & 1 == 0) {
            let (a, b) = (corner(bits), corner(bits | 1 << axis));
            let (below, above) = (height(a), height(b));
            if (below < 0.0) != (above < 0.0) {
                corners.push(a + below / (below - above) * (b - a));
            }
        }
    }
    // Around their middle, in the order of their angles.
    let count = corners.len().max(1) as f64;
    let middle = corners.iter().fold(DVec3::ZERO, |sum, corner| sum + *corner / count);
    let across = normal.any_orthonormal_vector();
    let along = normal.cross(across);
    let angle = |corner: &DVec3| (*corner - middle).dot(along).atan2((*corner - middle).dot(across));
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::picture::handles::reach::tests::projection;

    const SCENE: Bounds = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };

    fn plane(normal: DVec3, invert: bool) -> ClipPlane {
        ClipPlane { point: DVec3::new(0.2, 0.1, 0.0), normal, invert, on: true }
    }

    #[test]
    fn the_foot_moves_the_plane_along_its_normal() {
        let p = projection();
        for invert in [false, true] {
            let clip = plane(DVec3::new(3.0, 1.0, 0.0), invert);
            let arrow = Arrow::new(&clip, &SCENE).unwrap();
            let wish = arrow.foot + 0.3 * arrow.direction;
            let cursors = [arrow.foot, wish].map(|point| p.project(point).unwrap().at);
            let dragged = Part::Foot.drag(&clip, &SCENE, &p, cursors).unwrap();
            let shift = (dragged.point - clip.point).dot(arrow.direction);
            assert!((shift - 0.3).abs() < 1e-9 && dragged.normal == clip.normal, "{shift}");
        }
    }

    #[test]
    fn the_tip_turns_the_plane_around_the_foot() {
        let p = projection();
        for invert in [false, true] {
            let clip = plane(DVec3::new(0.2, 0.3, 1.0), invert);
            let arrow = Arrow::new(&clip, &SCENE).unwrap();
            let wish = (arrow.direction + 0.3 * p.right).normalize();
            let [from, to] =
                [arrow.tip(), arrow.foot + arrow.length * wish].map(|point| p.project(point).unwrap().at);
            let dragged = Part::Tip.drag(&clip, &SCENE, &p, [from, to]).unwrap();
            let found = Arrow::new(&dragged, &SCENE).unwrap();
            assert!(found.direction.distance(wish) < 1e-6, "{} is not {wish}", found.direction);
        }
    }

    #[test]
    fn the_outline_is_the_cut_through_the_scene() {
        let square = outline(&plane(DVec3::X, false), &SCENE);
        assert_eq!(square.len(), 4);
        let sides = (0..4).map(|i| square[i].distance(square[(i + 1) % 4]));
        assert!(sides.clone().all(|side| (side - 2.0).abs() < 1e-12), "{:?}", sides.collect::<Vec<_>>());
        let hexagon = outline(&ClipPlane { point: DVec3::ZERO, ..plane(DVec3::ONE, false) }, &SCENE);
        assert_eq!(hexagon.len(), 6);
        let beside = ClipPlane { point: DVec3::splat(9.0), ..plane(DVec3::ONE, false) };
        assert!(outline(&beside, &SCENE).is_empty() && Arrow::new(&beside, &SCENE).is_some());
    }
}
