//! The sub-pixel floor, the renderer's one documented deviation from the contract.
//!
//! A particle far below a pixel could fall between all samples. Its support radius is therefore
//! raised to 0.9 of the sample pitch at its depth: no point is farther than √3/2 ≈ 0.87 pitches from
//! the nearest sample of a cubic lattice.

use crate::particle::Particle;
use crate::setup::Setup;

/// Smallest support radius in sample pitches.
const FLOOR: f64 = 0.9;

/// Distance between samples at the view depth `z`, the larger of across and along the rays.
fn pitch(setup: &Setup, z: f64) -> f64 {
    setup.camera.pixel_size(z).max(z * setup.slices.relative_step())
}

/// The particle with its radius at the floor or above; its weight becomes V_j·W(r, h').
pub fn raise(particle: &Particle, setup: &Setup) -> Particle {
    let depth = setup.camera.to_view(particle.position).z.clamp(setup.camera.near, setup.camera.far);
    let lowest = FLOOR * pitch(setup, depth);
    Particle { support_radius: particle.support_radius.max(lowest), ..*particle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes;
    use glam::DVec3;

    fn raised(setup: &Setup, depth: f64, support_radius: f64) -> f64 {
        let camera = &setup.camera;
        let position = camera.eye + depth * (camera.forward + 0.1 * camera.right);
        raise(&Particle { position, support_radius, volume: 1.0, quantity: 0.0, opacity: 0.0 }, setup)
            .support_radius
    }

    /// 10 pixels high, σ = 90°, from 1 to 100.
    fn setup() -> Setup {
        let mut view = scenes::plain_view(10, 10);
        let camera = view.camera.as_mut().unwrap();
        (camera.eye, camera.target, camera.fov_y_degrees) = (DVec3::ZERO, DVec3::NEG_Z, 90.0);
        (camera.near, camera.far) = (Some(1.0), Some(100.0));
        Setup::new(&view)
    }

    #[test]
    fn radii_above_the_floor_stay() {
        assert_eq!(raised(&setup(), 10.0, 2.0), 2.0);
        assert_eq!(raised(&setup(), 10.0, 1.9), 1.9);
    }

    #[test]
    fn radii_below_become_nine_tenths_of_the_pitch() {
        // ln 100·10/2 = 23.03 slabs, so N = 32 and slabs are thinner than pixels: 2/10 of the depth.
        let setup = setup();
        assert_eq!(setup.slices.count, 32);
        for (depth, expected) in
            [(10.0, 1.8), (1.0, 0.18), (0.5, 0.18), (-3.0, 0.18), (100.0, 18.0), (1e6, 18.0)]
        {
            let h = raised(&setup, depth, 1e-9);
            assert!((h - expected).abs() < 1e-12, "depth {depth}: {h}");
        }
    }

    #[test]
    fn thick_slabs_count_too() {
        let mut view = scenes::plain_view(10, 10);
        view.sampling.rate = 0.01;
        let camera = view.camera.as_mut().unwrap();
        (camera.eye, camera.target, camera.fov_y_degrees) = (DVec3::ZERO, DVec3::NEG_Z, 90.0);
        (camera.near, camera.far) = (Some(1.0), Some(1e16));
        // 16 slabs, each ten times as deep as the one before: 9 times the depth where it begins.
        let h = raised(&Setup::new(&view), 2.0, 1.0);
        assert!((h - 0.9 * 2.0 * 9.0).abs() < 1e-11, "{h}");
    }
}
