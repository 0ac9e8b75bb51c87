//! A scene: particles, their quantity, and a view with nothing left open.

use std::sync::Arc;

use crate::camera::{CELL_SLICES, Camera, Slices};
use crate::kernel::Kernel;
use crate::particles::{ParticleSet, Quantity};
use crate::sampling::Sampling;
use crate::transfer::TransferFunction;
use crate::view::{View, ViewError, check};

/// Everything the renderer needs for one picture.
#[derive(Clone)]
pub struct Scene {
    pub particles: Arc<ParticleSet>,
    pub quantity: Arc<Quantity>,
    pub camera: Camera,
    /// Pixels.
    pub width: u32,
    pub height: u32,
    pub kernel: Kernel,
    /// On the axis of the device's quantity ([`crate::Placement`]).
    pub transfer: TransferFunction,
    /// In the unit of the run.
    pub reference_length: f64,
    /// Slices per pixel size.
    pub rate: f64,
    pub sampling: Sampling,
}

impl Scene {
    /// Checks `view` and settles what it leaves open: camera, near and far, reference length.
    ///
    /// # Errors
    /// Names the key of what is out of range, or where there are too many slices.
    pub fn new(
        particles: Arc<ParticleSet>,
        quantity: Arc<Quantity>,
        view: &View,
    ) -> Result<Scene, ViewError> {
        view.validate()?;
        let aspect = f64::from(view.image.width) / f64::from(view.image.height);
        let whole = particles.whole();
        let (bounds, margin) = (whole.bounds, whole.support_radii[1]);
        let camera = match view.camera {
            Some(camera) => camera.settled(bounds, margin, aspect),
            None => Camera::overview(bounds, margin, aspect),
        };
        let camera = Camera::new(&camera, &particles, &quantity);
        check_slices(&Slices::new(&camera, view.image.height, view.sampling.rate))?;
        let reference_length =
            view.transfer.reference_length.unwrap_or_else(|| default_reference_length(&particles));
        Ok(Scene {
            camera,
            width: view.image.width,
            height: view.image.height,
            kernel: view.particles.kernel,
            transfer: TransferFunction::on_device(
                &view.transfer,
                &quantity,
                [view.quantity.below, view.quantity.above],
            )?,
            reference_length,
            rate: view.sampling.rate,
            sampling: Sampling::new(&view.sampling),
            particles,
            quantity,
        })
    }
}

fn check_slices(slices: &Slices) -> Result<(), ViewError> {
    let (layers, most) = (slices.layers(), Slices::MAX_LAYERS);
    check(layers <= most, "camera.fov_y_degrees", || {
        format!(
            "needs {:.1e} slices, more than {:.1e}: choose a wider field of view, camera.near and camera.far closer to each other, a lower sampling.rate or a lower picture",
            slices.count as f64,
            (most * u64::from(CELL_SLICES)) as f64
        )
    })
}

/// A thirtieth of the diagonal of the supports of all particles, selected or not; 1 without particles.
pub fn default_reference_length(particles: &ParticleSet) -> f64 {
    let whole = particles.whole();
    match whole.bounds {
        Some(bounds) => (bounds.diagonal() + 2.0 * whole.support_radii[1]) / 30.0,
        None => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slices_of(fov: f64, rate: f64) -> Result<u64, ViewError> {
        let mut view = View::from_json(r#"{"camera": {"eye": [0, 0, 9], "near": 1, "far": 9}}"#).unwrap();
        view.sampling.rate = rate;
        view.camera.as_mut().unwrap().fov_y_degrees = fov;
        let nothing = ParticleSet::new(0, |_| unreachable!("there are no particles"));
        let quantity = Quantity::new(&nothing, None, |_| 0.0);
        let scene = Scene::new(Arc::new(nothing), Arc::new(quantity), &view)?;
        Ok(Slices::new(&scene.camera, scene.height, scene.rate).count)
    }

    #[test]
    fn endless_slices_are_refused_before_anything_is_made_of_them() {
        assert!(slices_of(1.0, 1.0).unwrap() > 60_000);
        for (fov, rate) in [(1e-9, 1.0), (1e-300, 64.0), (0.01, 64.0)] {
            let error = slices_of(fov, rate).unwrap_err();
            assert_eq!(error.key, "camera.fov_y_degrees");
            assert!(error.what.contains("camera.near") && error.what.contains("sampling.rate"), "{error}");
        }
    }
}
