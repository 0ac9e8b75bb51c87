//! Camera and slices (contract, section 1), in f64.

use glam::DVec3;

use crate::particles::{Bounds, ParticleSet, Quantity};
use crate::view::CameraView;

/// A perspective camera with its near and far depths settled. Lengths in the unit of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: DVec3,
    /// Unit vectors: right, up, forward.
    pub right: DVec3,
    pub up: DVec3,
    pub forward: DVec3,
    /// tan(σ/2) of the vertical field of view σ.
    pub tan_half_fov: f64,
    pub near: f64,
    pub far: f64,
}

/// Samples of a bundle's cell along a ray (D_z of the paper).
pub const CELL_SLICES: u32 = 16;
/// Side of a bundle in pixels (D_xy of the paper).
pub const BUNDLE_SIDE: u32 = 8;

/// Near is never fitted closer than this share of far: beyond it, slices would go to a depth where
/// nothing can be seen.
const NEAREST_FIT: f64 = 1e-4;

impl Camera {
    /// The camera of a valid and settled `view`; absent near and far are fitted around the particles
    /// in front of it.
    pub(crate) fn new(view: &CameraView, particles: &ParticleSet, quantity: &Quantity) -> Camera {
        let forward = (view.target - view.eye).normalize();
        let right = forward.cross(view.up).normalize();
        let up = right.cross(forward);
        let (near, far) = match (view.near, view.far) {
            (Some(near), Some(far)) => (near, far),
            (near, far) => {
                let fit = fit_depths(view.eye, forward, particles, quantity);
                let far = far.unwrap_or_else(|| near.map_or(fit[1], |near| fit[1].max(near * 1.001)));
                (near.unwrap_or(fit[0]).min(far / 1.001), far)
            }
        };
        let tan_half_fov = (view.fov_y_degrees.to_radians() / 2.0).tan();
        Camera { eye: view.eye, right, up, forward, tan_half_fov, near, far }
    }

    /// A camera that has all of `bounds`, grown by `margin`, in view: from the front right, a little above.
    pub fn overview(bounds: Option<Bounds>, margin: f64, aspect: f64) -> CameraView {
        let open = CameraView::OPEN;
        let view =
            CameraView { eye: open, target: open, up: DVec3::Y, fov_y_degrees: 35.0, near: None, far: None };
        view.settled(bounds, margin, aspect)
    }

    /// View depth of a point of the world.
    pub fn depth(&self, point: DVec3) -> f64 {
        (point - self.eye).dot(self.forward)
    }
}

/// Where the overview looks from.
const OVERVIEW: DVec3 = DVec3::new(0.55, 0.40, 0.75);

impl CameraView {
    /// The same camera with eye and target settled where they are left open: looking at the middle of
    /// `bounds`, and from so far away that `bounds`, grown by `margin`, are in view.
    pub fn settled(mut self, bounds: Option<Bounds>, margin: f64, aspect: f64) -> CameraView {
        let (centre, radius) =
            bounds.map_or((DVec3::ZERO, 1.0), |b| (b.centre(), 0.5 * b.diagonal() + margin));
        let tan = (self.fov_y_degrees.to_radians() / 2.0).tan() * aspect.min(1.0);
        let away = radius / tan.atan().sin() * OVERVIEW.normalize();
        if self.target == CameraView::OPEN {
            // An eye in the very middle still has to look somewhere.
            self.target = if self.eye == centre { centre - away } else { centre };
        }
        if self.eye == CameraView::OPEN {
            self.eye = self.target + away;
        }
        let forward = (self.target - self.eye).normalize();
        if forward.cross(self.up).length() < 1e-9 * self.up.length() {
            self.up = forward.any_orthonormal_vector();
        }
        self
    }
}

/// Slices s(i) = near·(far/near)^(i/N): geometric, so that a slab is about as deep as a pixel is wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slices {
    pub near: f64,
    /// N, a multiple of [`CELL_SLICES`].
    pub count: u64,
    /// ln(far/near)/N.
    pub log_step: f64,
}

impl Slices {
    /// The most layers of cells that a picture may have: the host and the device take bytes for each, and an
    /// f32 counts up to 2²⁴ slices.
    pub(crate) const MAX_LAYERS: u64 = 1 << 20;

    /// Slices for a picture `height` pixels high at `rate` slices per pixel size.
    pub fn new(camera: &Camera, height: u32, rate: f64) -> Slices {
        let log_range = (camera.far / camera.near).ln();
        let per_log = rate * f64::from(height) / (2.0 * camera.tan_half_fov);
        let layers = (per_log * log_range / f64::from(CELL_SLICES)).ceil().max(1.0);
        let count = (layers as u64).saturating_mul(u64::from(CELL_SLICES));
        Slices { near: camera.near, count, log_step: log_range / count as f64 }
    }

    /// View depth of the real slice index `i`.
    pub fn depth(&self, i: f64) -> f64 {
        self.near * (i * self.log_step).exp()
    }

    /// Cells along a ray.
    pub fn layers(&self) -> u64 {
        self.count / u64::from(CELL_SLICES)
    }
}

/// Nearest and farthest depth of any particle's support in front of the eye.
fn fit_depths(eye: DVec3, forward: DVec3, particles: &ParticleSet, quantity: &Quantity) -> [f64; 2] {
    let extremes = particles.depth_extremes(eye, forward, |index| quantity.is_rejected(index));
    let Some([nearest, farthest]) = extremes else {
        return [1.0, 2.0];
    };
    [nearest.max(farthest * NEAREST_FIT), farthest]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::View;

    fn settled(camera: &str) -> CameraView {
        let view = View::from_json(&format!("{{\"camera\": {camera}}}")).unwrap();
        view.validate().unwrap();
        let bounds = Bounds { min: DVec3::new(1.0, 2.0, 3.0), max: DVec3::new(3.0, 4.0, 5.0) };
        view.camera.unwrap().settled(Some(bounds), 0.1, 1.0)
    }

    #[test]
    fn what_a_camera_leaves_open_is_settled_by_the_run() {
        let centre = DVec3::new(2.0, 3.0, 4.0);
        assert_eq!(settled("{}").target, centre);
        assert_eq!(settled(r#"{"eye": [9, 9, 9]}"#).target, centre);
        assert_eq!(settled(r#"{"eye": [9, 9, 9]}"#).eye, DVec3::splat(9.0));
        let from_afar = settled(r#"{"target": [0, 0, 0], "fov_y_degrees": 10}"#);
        assert_eq!(from_afar.target, DVec3::ZERO);
        assert!(from_afar.eye.length() > 10.0);
        // The middle of the run, and straight down: still a camera.
        for odd in [r#"{"eye": [2, 3, 4]}"#, r#"{"eye": [2, 9, 4], "up": [0, 1, 0]}"#] {
            let camera = settled(odd);
            let forward = camera.target - camera.eye;
            assert!(forward.cross(camera.up).length() > 1e-3 * forward.length(), "{odd}: {camera:?}");
        }
    }

    #[test]
    fn a_settled_camera_stays_as_it_is() {
        let given = r#"{"eye": [0, 0, 5], "target": [0, 1, 0], "up": [1, 0, 0], "near": 1, "far": 9}"#;
        let view = View::from_json(&format!("{{\"camera\": {given}}}")).unwrap().camera.unwrap();
        assert_eq!(view.settled(None, 0.0, 1.0), view);
    }
}
