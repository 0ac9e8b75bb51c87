//! From a frame and a view to a scene, keeping what the next picture can use again.

use std::sync::Arc;

use renderer::{Bounds, ParticleSet, Quantity, Rejected, Scene, View};

use crate::frames::Frame;
use crate::scene;

/// What a frame turned out to be, for panels and camera. Lengths in the unit of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    pub particles: usize,
    pub rejected: Rejected,
    /// Around the centres of the particles.
    pub bounds: Option<Bounds>,
    /// Smallest and largest support radius.
    pub support_radii: [f64; 2],
    /// What a view without a reference length stands for.
    pub reference_length: f64,
    /// The values that u = 0 and u = 1 stand for.
    pub range: [f64; 2],
}

/// Particles and quantity of the last scene. A frame is recognised by its address, which its `Arc`
/// keeps from being used again.
#[derive(Default)]
pub struct Preparation {
    particles: Option<(Arc<Frame>, Option<f64>, Arc<ParticleSet>)>,
    quantity: Option<(renderer::QuantityView, Arc<Quantity>)>,
}

impl Preparation {
    /// The scene that `view` shows of `frame`.
    pub fn scene(&mut self, frame: &Arc<Frame>, view: &View) -> anyhow::Result<(Scene, Facts)> {
        let particles = self.particles(frame, view)?;
        let quantity = self.quantity(frame, &particles, view)?;
        let mut rejected = particles.rejected();
        rejected.non_finite += quantity.rejected();
        let facts = Facts {
            particles: particles.len(),
            rejected,
            bounds: particles.bounds(),
            support_radii: particles.support_radii(),
            reference_length: renderer::default_reference_length(&particles),
            range: quantity.range(),
        };
        Ok((Scene::new(particles, quantity, view)?, facts))
    }

    fn particles(&mut self, frame: &Arc<Frame>, view: &View) -> anyhow::Result<Arc<ParticleSet>> {
        let radius = view.particles.support_radius;
        if let Some((known, known_radius, particles)) = &self.particles
            && Arc::ptr_eq(known, frame)
            && *known_radius == radius
        {
            return Ok(Arc::clone(particles));
        }
        // Given up first: two large frames at a time may be one too many.
        (self.particles, self.quantity) = (None, None);
        let particles = Arc::new(scene::particles(frame, radius)?);
        self.particles = Some((Arc::clone(frame), radius, Arc::clone(&particles)));
        Ok(particles)
    }

    fn quantity(
        &mut self,
        frame: &Frame,
        particles: &ParticleSet,
        view: &View,
    ) -> anyhow::Result<Arc<Quantity>> {
        if let Some((known, quantity)) = &self.quantity
            && *known == view.quantity
        {
            return Ok(Arc::clone(quantity));
        }
        let quantity = Arc::new(scene::quantity(frame, particles, &view.quantity)?);
        self.quantity = Some((view.quantity.clone(), Arc::clone(&quantity)));
        Ok(quantity)
    }
}
