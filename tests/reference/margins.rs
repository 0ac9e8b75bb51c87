//! How near a ray comes to the jumps of a picture. A sample on the edge of a support, or a quantity
//! at a step of the transfer function, falls on either side of it with the last bit: where two
//! pictures differ in one pixel and its margins are below the rounding errors, neither is wrong.

use std::fmt;

use crate::neighbours::Neighbours;
use crate::particle::Particle;
use crate::quantity;
use crate::setup::Setup;

/// The smallest margins of the samples of one ray.
#[derive(Clone, Copy, Debug)]
pub struct Margins {
    /// |r/h − 1| over all particles.
    pub edge: f64,
    /// |u − u of a step|.
    pub step: f64,
    /// View depth over support radius where the edge is nearest: positions that are rounded to f32
    /// in view space move the edge by up to 6·10⁻⁸ of this.
    pub depth_over_radius: f64,
}

impl fmt::Display for Margins {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Margins { edge, step, depth_over_radius } = self;
        write!(f, "margins: edge {edge:.1e} at z/h = {depth_over_radius:.0}, step {step:.1e}")
    }
}

/// The margins of pixel (x, y).
pub fn margins(setup: &Setup, particles: &[Particle], x: u32, y: u32) -> Margins {
    let sound: Vec<Particle> = particles.iter().copied().filter(Particle::is_sound).collect();
    // A little wider, to find those just outside.
    let wider = |p: &Particle| Particle { support_radius: 1.01 * p.support_radius, ..*p };
    let neighbours = Neighbours::new(&sound.iter().map(wider).collect::<Vec<_>>());
    let d = setup.camera.ray(x, y);
    let mut margins = Margins { edge: f64::INFINITY, step: f64::INFINITY, depth_over_radius: 0.0 };
    for i in 0..setup.slices.count {
        let depth = setup.slices.depth(f64::from(i) + setup.place_in_slab);
        let point = setup.camera.eye + depth * d;
        let around = || neighbours.around(point).map(|index| &sound[index]);
        for particle in around() {
            let edge = ((point - particle.position).length() / particle.support_radius - 1.0).abs();
            if edge < margins.edge {
                (margins.edge, margins.depth_over_radius) = (edge, depth / particle.support_radius);
            }
        }
        if let Some(q) = quantity::at(point, around(), setup.kernel) {
            margins.step = margins.step.min(setup.transfer.distance_to_step(setup.range.normalise(q)));
        }
    }
    margins
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{grey, plain_view};
    use glam::DVec3;

    #[test]
    fn the_edge_and_the_step_are_found() {
        let mut view = plain_view(1, 1);
        view.transfer.points = vec![grey(0.0, 0.0, 0.1), grey(0.75, 0.0, 0.1), grey(0.75, 1.0, 0.9)];
        let setup = Setup::new(&view);
        // The eye looks along −z from (0, 0, 4); the sixth sample is a hair inside the support.
        let sample = setup.slices.depth(5.5);
        let position = DVec3::new(0.0, 0.0, 4.0 - sample - 0.5);
        let particle = Particle {
            position,
            support_radius: 0.5 * (1.0 + 1e-5),
            volume: 1.0,
            quantity: 0.5,
            opacity: 0.0,
        };
        let Margins { edge, step, depth_over_radius } = margins(&setup, &[particle], 0, 0);
        assert!((edge - 1e-5).abs() < 1e-9, "{edge}");
        assert!((step - 0.25).abs() < 1e-12, "{step}");
        assert!((depth_over_radius - sample / 0.5).abs() < 1e-3, "{depth_over_radius}");
    }
}
