//! One particle of a run.

use glam::DVec3;

/// A particle with its quantity. Lengths in the unit of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    pub position: DVec3,
    /// h_j: radius at which the kernel reaches zero.
    pub support_radius: f64,
    /// V_j = m_j/ρ_j; only ratios between particles matter.
    pub volume: f64,
    /// q_j, in the unit of the field.
    pub quantity: f64,
    /// Of the field that decides the opacity, in its unit; finite and of no meaning where that is the same one.
    pub opacity: f64,
}

impl Particle {
    /// Whether the particle takes part in the picture (contract, section 5).
    pub fn is_sound(&self) -> bool {
        self.position.is_finite()
            && self.quantity.is_finite()
            && self.opacity.is_finite()
            && self.support_radius.is_finite()
            && self.support_radius > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unsound_particles_are_found() {
        let sound = Particle {
            position: DVec3::splat(1e30),
            support_radius: 1e-30,
            volume: 1.0,
            quantity: -1e300,
            opacity: 1.0,
        };
        assert!(sound.is_sound());
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(!Particle { position: DVec3::new(0.0, bad, 0.0), ..sound }.is_sound());
            assert!(!Particle { quantity: bad, ..sound }.is_sound());
            assert!(!Particle { opacity: bad, ..sound }.is_sound());
            assert!(!Particle { support_radius: bad, ..sound }.is_sound());
        }
        assert!(!Particle { support_radius: 0.0, ..sound }.is_sound());
        assert!(!Particle { support_radius: -1.0, ..sound }.is_sound());
    }
}
