//! From points of the world to places in a picture and back (contract, section 1). Pure, in f64.

use glam::{DVec2, DVec3};
use renderer::{Camera, CameraView};

/// A camera and the picture that it makes. Lengths in the unit of the run; places in the unit in which
/// width and height are given (pixels, or points of the window), from the picture's upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    pub eye: DVec3,
    /// Unit vectors: right, up, forward.
    pub right: DVec3,
    pub up: DVec3,
    pub forward: DVec3,
    /// tan(σ/2) of the vertical field of view σ.
    pub tan_half_fov: f64,
    pub width: f64,
    pub height: f64,
}

/// Where a point of the world is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// It may lie outside the picture.
    pub at: DVec2,
    /// View depth, above zero.
    pub depth: f64,
}

impl Projection {
    /// The picture of width × height that `camera` makes; its eye and target are settled, and its up is
    /// not along the view.
    pub fn new(camera: &CameraView, [width, height]: [f64; 2]) -> Projection {
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let up = right.cross(forward);
        let tan_half_fov = (camera.fov_y_degrees.to_radians() / 2.0).tan();
        Projection { eye: camera.eye, right, up, forward, tan_half_fov, width, height }
    }

    /// The picture of width × height that the camera of a scene makes.
    pub fn of(camera: &Camera, [width, height]: [f64; 2]) -> Projection {
        let Camera { eye, right, up, forward, tan_half_fov, .. } = *camera;
        Projection { eye, right, up, forward, tan_half_fov, width, height }
    }

    /// Where `point` is seen; `None` for one that is not in front of the eye.
    pub fn project(&self, point: DVec3) -> Option<Place> {
        let to = point - self.eye;
        let depth = to.dot(self.forward);
        if depth <= 0.0 || !depth.is_finite() {
            return None;
        }
        let scale = 1.0 / self.length_at(depth);
        let at = DVec2::new(to.dot(self.right), -to.dot(self.up)) * scale;
        Some(Place { at: 0.5 * DVec2::new(self.width, self.height) + at, depth })
    }

    /// Both ends of a line of the world in the picture, cut off just before the eye; `None` for one
    /// that lies behind it.
    pub fn segment(&self, a: DVec3, b: DVec3) -> Option<[DVec2; 2]> {
        let [a, b] = match (self.project(a), self.project(b)) {
            (Some(a), Some(b)) => [a, b],
            (Some(seen), None) => [seen, self.last_seen(a, b)?],
            (None, Some(seen)) => [self.last_seen(b, a)?, seen],
            (None, None) => return None,
        };
        Some([a.at, b.at])
    }

    /// A point close to where the line from `seen` to `behind`, which is behind the eye, leaves the view.
    fn last_seen(&self, seen: DVec3, behind: DVec3) -> Option<Place> {
        let depth = |point: DVec3| (point - self.eye).dot(self.forward);
        let share = depth(seen) / (depth(seen) - depth(behind));
        self.project(seen + 0.98 * share * (behind - seen))
    }

    /// The point at view depth `depth` that is seen at `place`.
    pub fn unproject(&self, place: DVec2, depth: f64) -> DVec3 {
        self.eye + depth * self.ray(place)
    }

    /// Direction of the ray through `place`, for each unit of view depth: not a unit vector.
    pub fn ray(&self, place: DVec2) -> DVec3 {
        self.forward + self.sideways(place)
    }

    /// The part of the ray through `place` that lies in the picture's plane.
    pub fn sideways(&self, place: DVec2) -> DVec3 {
        let from_centre = place - 0.5 * DVec2::new(self.width, self.height);
        self.length_at(1.0) * (from_centre.x * self.right - from_centre.y * self.up)
    }

    /// Length at view depth `depth` for each unit of places: how long a pixel is there.
    pub fn length_at(&self, depth: f64) -> f64 {
        2.0 * depth * self.tan_half_fov / self.height.max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn projection() -> Projection {
        let camera = CameraView {
            eye: DVec3::new(1.0, 2.0, 9.0),
            target: DVec3::new(1.5, 1.0, -3.0),
            up: DVec3::new(0.1, 1.0, 0.3),
            fov_y_degrees: 40.0,
            near: None,
            far: None,
        };
        Projection::new(&camera, [640.0, 480.0])
    }

    #[test]
    fn a_place_and_a_depth_are_a_point_and_back() {
        let projection = projection();
        for (x, y, depth) in [(320.0, 240.0, 3.0), (0.0, 0.0, 0.5), (700.0, -30.0, 1e6)] {
            let place = Place { at: DVec2::new(x, y), depth };
            let back = projection.project(projection.unproject(place.at, depth)).unwrap();
            assert!(back.at.distance(place.at) < 1e-8 && (back.depth / depth - 1.0).abs() < 1e-12);
        }
        assert!(projection.project(projection.eye - projection.forward).is_none());
        assert!(projection.project(projection.eye).is_none());
    }

    #[test]
    fn lines_end_before_the_eye() {
        let p = projection();
        let (ahead, behind) = (p.eye + 2.0 * p.forward, p.eye - p.forward + p.right);
        let [a, b] = p.segment(ahead, behind).unwrap();
        assert!(a.is_finite() && b.is_finite() && b.x > a.x);
        assert_eq!(p.segment(behind, ahead), Some([b, a]));
        assert!(p.segment(behind, p.eye - 2.0 * p.forward).is_none());
    }

    #[test]
    fn it_is_the_image_formation_of_the_contract() {
        let p = projection();
        let (x, y) = (12.0, 400.0);
        let (nx, ny) = (2.0 * (x + 0.5) / 640.0 - 1.0, 1.0 - 2.0 * (y + 0.5) / 480.0);
        let tan = 20.0_f64.to_radians().tan();
        let ray = p.forward + nx * (640.0 / 480.0) * tan * p.right + ny * tan * p.up;
        assert!(p.ray(DVec2::new(x + 0.5, y + 0.5)).distance(ray) < 1e-12);
        assert!((p.length_at(2.0) * 480.0 - 4.0 * tan).abs() < 1e-12);
    }
}
