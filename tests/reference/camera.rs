//! Camera and rays (contract, section 1).

use glam::DVec3;
use renderer::CameraView;

/// A perspective camera and the image behind it. Lengths in the unit of the run.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub eye: DVec3,
    /// f, r and u of the contract: right-handed, unit length.
    pub forward: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    /// tan(σ/2).
    pub tan_half_fov: f64,
    /// View depths between which the run is sampled.
    pub near: f64,
    pub far: f64,
    /// W and H in pixels.
    pub width: u32,
    pub height: u32,
}

impl Camera {
    /// The camera of `view`, which must give near and far, with an image of `width` × `height` pixels.
    pub fn new(view: &CameraView, width: u32, height: u32) -> Camera {
        let forward = (view.target - view.eye).normalize();
        let right = forward.cross(view.up).normalize();
        Camera {
            eye: view.eye,
            forward,
            right,
            up: right.cross(forward),
            tan_half_fov: (0.5 * view.fov_y_degrees.to_radians()).tan(),
            near: view.near.expect("the twin takes near as given"),
            far: view.far.expect("the twin takes far as given"),
            width,
            height,
        }
    }

    /// nx and ny at a point of the image in pixels, from the upper left corner; the centre of pixel
    /// (x, y) is (x + ½, y + ½).
    pub fn slopes(&self, column: f64, row: f64) -> [f64; 2] {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        let nx = (2.0 * column / width - 1.0) * (width / height) * self.tan_half_fov;
        let ny = (1.0 - 2.0 * row / height) * self.tan_half_fov;
        [nx, ny]
    }

    /// d of pixel (x, y): the ray's way per unit of view depth.
    pub fn ray(&self, x: u32, y: u32) -> DVec3 {
        let [nx, ny] = self.slopes(f64::from(x) + 0.5, f64::from(y) + 0.5);
        self.forward + nx * self.right + ny * self.up
    }

    /// A point of the world as (right, up, view depth), seen from the eye.
    pub fn to_view(&self, point: DVec3) -> DVec3 {
        let way = point - self.eye;
        DVec3::new(way.dot(self.right), way.dot(self.up), way.dot(self.forward))
    }

    /// Side of a pixel at `depth`.
    pub fn pixel_size(&self, depth: f64) -> f64 {
        depth * 2.0 * self.tan_half_fov / f64::from(self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks along −z with y up, so that right is +x; σ = 90°, hence tan(σ/2) = 1.
    fn camera(width: u32, height: u32) -> Camera {
        let view = CameraView {
            eye: DVec3::new(10.0, 20.0, 30.0),
            target: DVec3::new(10.0, 20.0, 0.0),
            up: DVec3::new(0.0, 5.0, 1.0),
            fov_y_degrees: 90.0,
            near: Some(1.0),
            far: Some(2.0),
        };
        Camera::new(&view, width, height)
    }

    fn assert_near(a: DVec3, b: DVec3) {
        assert!((a - b).length() < 1e-14, "{a} is not {b}");
    }

    #[test]
    fn the_basis_is_right_handed_even_with_a_slanted_up() {
        let camera = camera(4, 2);
        assert_near(camera.forward, DVec3::NEG_Z);
        assert_near(camera.right, DVec3::X);
        assert_near(camera.up, DVec3::Y);
    }

    #[test]
    fn rays_of_the_corners() {
        // 4 × 2 pixels: the image reaches from −2 to 2 across and from −1 to 1 upwards.
        let camera = camera(4, 2);
        assert_near(camera.ray(0, 0), DVec3::new(-1.5, 0.5, -1.0));
        assert_near(camera.ray(3, 0), DVec3::new(1.5, 0.5, -1.0));
        assert_near(camera.ray(0, 1), DVec3::new(-1.5, -0.5, -1.0));
        assert_near(camera.ray(3, 1), DVec3::new(1.5, -0.5, -1.0));
    }

    #[test]
    fn the_only_pixel_looks_straight_ahead() {
        assert_near(camera(1, 1).ray(0, 0), DVec3::NEG_Z);
    }

    #[test]
    fn a_point_on_a_ray_has_its_slopes() {
        let camera = camera(7, 5);
        let point = camera.eye + 3.0 * camera.ray(6, 1);
        let [nx, ny] = camera.slopes(6.5, 1.5);
        assert_near(camera.to_view(point), DVec3::new(3.0 * nx, 3.0 * ny, 3.0));
    }

    #[test]
    fn a_pixel_is_as_wide_as_the_step_between_rays() {
        let camera = camera(7, 5);
        let step = 4.0 * (camera.ray(3, 2) - camera.ray(2, 2)).length();
        assert!((camera.pixel_size(4.0) - step).abs() < 1e-14);
    }
}
