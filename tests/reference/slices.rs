//! Slices of the view frustum (contract, section 1; Eq. 8 of the HPG 2016 paper).

use crate::camera::Camera;

/// D_z: slabs of a cell.
pub const CELL_SLABS: u32 = 16;

/// View depths s(i) = near·(far/near)^(i/N).
#[derive(Clone, Copy, Debug)]
pub struct Slices {
    pub near: f64,
    pub far: f64,
    /// N, a multiple of [`CELL_SLABS`].
    pub count: u32,
}

impl Slices {
    /// N = D_z·ceil(rate·ln(far/near)·H/(2·tan(σ/2))/D_z).
    pub fn new(camera: &Camera, rate: f64) -> Slices {
        let slabs =
            rate * (camera.far / camera.near).ln() * f64::from(camera.height) / (2.0 * camera.tan_half_fov);
        let layers = (slabs / f64::from(CELL_SLABS)).ceil();
        Slices { near: camera.near, far: camera.far, count: CELL_SLABS * layers as u32 }
    }

    /// s(i), the view depth of the real slice number i.
    pub fn depth(&self, i: f64) -> f64 {
        self.near * (self.far / self.near).powf(i / f64::from(self.count))
    }

    /// Layers of cells: layer k holds the slabs 16k to 16k + 15.
    pub fn layers(&self) -> u32 {
        self.count / CELL_SLABS
    }

    /// Depth of a slab as a share of the depth where it begins, (far/near)^(1/N) − 1.
    pub fn relative_step(&self) -> f64 {
        ((self.far / self.near).ln() / f64::from(self.count)).exp_m1()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use renderer::CameraView;

    fn slices(far: f64, height: u32, fov_y_degrees: f64, rate: f64) -> Slices {
        let view = CameraView {
            eye: DVec3::ZERO,
            target: DVec3::X,
            up: DVec3::Z,
            fov_y_degrees,
            near: Some(1.0),
            far: Some(far),
        };
        Slices::new(&Camera::new(&view, 1, height), rate)
    }

    #[test]
    fn counts_by_hand() {
        // ln 8 = 2.0794; with tan 45° = 1: 2.0794·100/2 = 103.97, 6.498 layers.
        assert_eq!(slices(8.0, 100, 90.0, 1.0).count, 7 * 16);
        // Twice the rate: 207.94, 12.997 layers.
        assert_eq!(slices(8.0, 100, 90.0, 2.0).count, 13 * 16);
        // tan 22.5° = 0.41421, ln 3 = 1.09861: 1.09861·512/0.82843 = 678.98, 42.44 layers.
        assert_eq!(slices(3.0, 512, 45.0, 1.0).count, 43 * 16);
        // The smallest picture: ln 2/2 = 0.35 slabs, one layer.
        assert_eq!(slices(2.0, 1, 90.0, 1.0).count, 16);
        assert_eq!(slices(2.0, 1, 90.0, 1.0).layers(), 1);
    }

    #[test]
    fn slices_are_geometric() {
        let slices = slices(8.0, 100, 90.0, 1.0);
        assert_eq!(slices.depth(0.0), 1.0);
        assert!((slices.depth(f64::from(slices.count)) - 8.0).abs() < 1e-14);
        assert!((slices.depth(0.5 * f64::from(slices.count)) - 8.0_f64.sqrt()).abs() < 1e-14);
        for i in 0..slices.count {
            let (front, back) = (slices.depth(f64::from(i)), slices.depth(f64::from(i + 1)));
            assert!((back / front - 1.0 - slices.relative_step()).abs() < 1e-13);
        }
    }
}
