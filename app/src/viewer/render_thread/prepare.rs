//! From a frame and a view to a scene, keeping what the next picture can use again.

use std::sync::Arc;

use renderer::{Bounds, ParticleSet, ParticleView, Quantity, Rejected, Scene, SelectView, View};

use crate::frames::Frame;
use crate::scene::{self, Support};

/// What a frame turned out to be, for panels and camera. Lengths in the unit of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    pub particles: usize,
    /// Those that can be shown, selected or not.
    pub whole: usize,
    pub rejected: Rejected,
    /// Around the centres of the particles of the whole frame.
    pub bounds: Option<Bounds>,
    /// Of the whole frame, smallest and largest support radius.
    pub support_radii: [f64; 2],
    /// What a view without a reference length stands for.
    pub reference_length: f64,
    /// Where a fixed near or far cuts off particles in the picture: the depth that they begin, or end, at.
    pub cut: [Option<f64>; 2],
}

/// Particles and quantity of the last scene. A frame is recognised by its address, which its `Arc`
/// keeps from being used again.
#[derive(Default)]
pub struct Preparation {
    particles: Option<Prepared>,
    /// The support radius of a frame where it is estimated from the spacing, which takes longer than
    /// everything else: a clip that is dragged must not wait for it.
    estimate: Option<(Arc<Frame>, Option<f64>)>,
    quantity: Option<(renderer::QuantityView, Arc<Quantity>)>,
}

struct Prepared {
    frame: Arc<Frame>,
    support_radius: Option<f64>,
    select: SelectView,
    particles: Arc<ParticleSet>,
}

impl Preparation {
    /// The scene that `view` shows of `frame`.
    pub fn scene(&mut self, frame: &Arc<Frame>, view: &View) -> anyhow::Result<(Scene, Facts)> {
        let particles = self.particles(frame, view)?;
        let quantity = self.quantity(frame, &particles, view)?;
        let mut rejected = particles.rejected();
        rejected.non_finite += quantity.rejected();
        let whole = particles.whole();
        let mut facts = Facts {
            particles: particles.len(),
            whole: whole.particles,
            rejected,
            bounds: whole.bounds,
            support_radii: whole.support_radii,
            reference_length: renderer::default_reference_length(&particles),
            cut: [None; 2],
        };
        let scene = Scene::new(particles, quantity, view)?;
        facts.cut = cut(&scene, view);
        Ok((scene, facts))
    }

    fn particles(&mut self, frame: &Arc<Frame>, view: &View) -> anyhow::Result<Arc<ParticleSet>> {
        let View { particles: ParticleView { support_radius, .. }, select, .. } = view;
        if let Some(known) = &self.particles
            && Arc::ptr_eq(&known.frame, frame)
            && known.support_radius == *support_radius
            && known.select == *select
        {
            return Ok(Arc::clone(&known.particles));
        }
        // Given up first: two large frames at a time may be one too many.
        (self.particles, self.quantity) = (None, None);
        let radius = support_radius.or_else(|| self.estimate(frame));
        let particles = Arc::new(scene::selected_particles(frame, radius, select)?);
        self.particles = Some(Prepared {
            frame: Arc::clone(frame),
            support_radius: *support_radius,
            select: select.clone(),
            particles: Arc::clone(&particles),
        });
        Ok(particles)
    }

    fn estimate(&mut self, frame: &Arc<Frame>) -> Option<f64> {
        if let Some((known, radius)) = &self.estimate
            && Arc::ptr_eq(known, frame)
        {
            return *radius;
        }
        self.estimate = None;
        let radius = Support::new(frame, None).estimate();
        self.estimate = Some((Arc::clone(frame), radius));
        radius
    }

    fn quantity(
        &mut self,
        frame: &Frame,
        particles: &ParticleSet,
        view: &View,
    ) -> anyhow::Result<Arc<Quantity>> {
        if let Some((known, quantity)) = &self.quantity
            && known.name == view.quantity.name
            && known.spread() == view.quantity.spread()
            && known.opacity == view.quantity.opacity
        {
            return Ok(Arc::clone(quantity));
        }
        let quantity = Arc::new(scene::quantity(frame, particles, &view.quantity)?);
        self.quantity = Some((view.quantity.clone(), Arc::clone(&quantity)));
        Ok(quantity)
    }
}

/// Where a near or far that `view` fixes cuts off particles that would be in the picture of `scene`.
fn cut(scene: &Scene, view: &View) -> [Option<f64>; 2] {
    // What is closer than this is never in a picture: it would cost slices for nothing.
    const CLOSEST: f64 = 1e-4;
    let Some(camera) = view.camera.filter(|camera| camera.near.is_some() || camera.far.is_some()) else {
        return [None; 2];
    };
    let aspect = f64::from(scene.width) / f64::from(scene.height);
    let Some([nearest, farthest]) = scene.particles.depths_in_picture(&scene.quantity, &scene.camera, aspect)
    else {
        return [None; 2];
    };
    let nearest = nearest.max(CLOSEST * farthest);
    let near = camera.near.filter(|near| *near > nearest * (1.0 + 1e-6)).map(|_| nearest);
    let far = camera.far.filter(|far| *far < farthest * (1.0 - 1e-6)).map(|_| farthest);
    [near, far]
}
