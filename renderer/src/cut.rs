//! What near and far depths that are fixed by hand would cut off.

use rayon::prelude::*;

use crate::camera::Camera;
use crate::particles::{ParticleSet, Quantity};

impl ParticleSet {
    /// Nearest and farthest view depth that the support of a particle reaches which is in a picture of
    /// `camera`, width/height = `aspect`, if near and far did not cut it; in the unit of the run. Nearest
    /// is below zero where the eye is inside a support. Particles whose `quantity` is not finite are in no
    /// picture. `None` where nothing is in the picture.
    pub fn depths_in_picture(&self, quantity: &Quantity, camera: &Camera, aspect: f64) -> Option<[f64; 2]> {
        let eye = self.to_device(camera.eye);
        let tan = [camera.tan_half_fov * aspect, camera.tan_half_fov];
        // From the faces of the pyramid to a point, as long as the normal on a face is 1.
        let lengths = tan.map(|tan| tan.hypot(1.0));
        let [near, far] = self
            .balls()
            .enumerate()
            .filter(|(index, _)| !quantity.is_rejected(*index))
            .filter_map(|(_, (position, radius))| {
                let to = position - eye;
                let depth = to.dot(camera.forward);
                let aside = [to.dot(camera.right), to.dot(camera.up)];
                let inside =
                    (0..2).all(|axis| aside[axis].abs() - tan[axis] * depth < radius * lengths[axis]);
                (inside && depth + radius > 0.0).then_some([depth - radius, depth + radius])
            })
            .reduce(|| [f64::INFINITY, f64::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        (near <= far).then_some([near * self.unit(), far * self.unit()])
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::particles::RawParticle;

    #[test]
    fn only_what_is_in_the_picture_counts() {
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, 10.0),
            right: DVec3::X,
            up: DVec3::Y,
            forward: DVec3::NEG_Z,
            tan_half_fov: 0.5,
            near: 1.0,
            far: 2.0,
        };
        let depths_of = |places: &[[f64; 3]], value: fn(usize) -> f64| {
            let particle =
                |row: usize| RawParticle { position: places[row], support_radius: 0.25, volume: 1.0 };
            let particles = ParticleSet::new(places.len(), particle);
            let quantity = Quantity::new(&particles, None, value);
            particles.depths_in_picture(&quantity, &camera, 2.0)
        };
        let depths = |places: &[[f64; 3]]| depths_of(places, |_| 1.0);
        let near = |found: Option<[f64; 2]>, wanted: [f64; 2]| {
            let found = found.unwrap();
            assert!((0..2).all(|i| (found[i] - wanted[i]).abs() < 1e-5), "{found:?} and not {wanted:?}");
        };
        // Straight ahead; to the right, where the picture is wide; above, just inside and outside.
        near(depths(&[[0.0; 3], [3.9, 0.0, 6.0]]), [3.75, 10.25]);
        near(depths(&[[0.0; 3], [0.0, 2.2, 6.0]]), [3.75, 10.25]);
        near(depths(&[[0.0; 3], [0.0, 2.4, 6.0]]), [9.75, 10.25]);
        let without_second = |row| if row == 1 { f64::NAN } else { 1.0 };
        near(depths_of(&[[0.0; 3], [3.9, 0.0, 6.0]], without_second), [9.75, 10.25]);
        assert_eq!(depths(&[[0.0, 0.0, 11.0], [0.0, 9.0, 6.0]]), None, "behind the eye, and beside");
    }
}
