//! A scene: particles, their quantity, and a view with nothing left open.

use std::sync::Arc;

use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::particles::{ParticleSet, Quantity};
use crate::sampling::Sampling;
use crate::transfer::TransferFunction;
use crate::view::{View, ViewError};

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

/// A thirtieth of the diagonal of the supports of all particles, selected or not; 1 without particles.
pub fn default_reference_length(particles: &ParticleSet) -> f64 {
    let whole = particles.whole();
    match whole.bounds {
        Some(bounds) => (bounds.diagonal() + 2.0 * whole.support_radii[1]) / 30.0,
        None => 1.0,
    }
}
