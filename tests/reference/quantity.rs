//! The interpolated quantity (CSPH, contract section 1; Eq. 1 and 2 of the HPG 2016 paper), and its range.

use glam::DVec3;

use crate::kernels::Kernel;
use crate::particle::Particle;

/// Q(x) = Σ q_j w_j(x) / Σ w_j(x) with w_j(x) = V_j·W(|x − x_j|, h_j), over `particles` that hold at
/// least all those with w_j(x) > 0; `None` where there is none of these.
pub fn at<'a>(x: DVec3, particles: impl Iterator<Item = &'a Particle>, kernel: Kernel) -> Option<f64> {
    field_at(x, particles, kernel, |particle| particle.quantity)
}

/// The same of any other field.
pub fn field_at<'a>(
    x: DVec3,
    particles: impl Iterator<Item = &'a Particle>,
    kernel: Kernel,
    field: impl Fn(&Particle) -> f64,
) -> Option<f64> {
    // Differences to the first quantity: a constant quantity stays exactly itself, which a step of
    // the transfer function at its value would show.
    let mut first = None;
    let (mut differences, mut weights) = (0.0, 0.0);
    for particle in particles {
        let w = particle.volume * kernel.weight((x - particle.position).length(), particle.support_radius);
        if w > 0.0 {
            let first = *first.get_or_insert(field(particle));
            differences += (field(particle) - first) * w;
            weights += w;
        }
    }
    first.map(|first| first + differences / weights)
}

/// The values that become u = 0 and u = 1.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    pub min: f64,
    pub max: f64,
    /// Whether equal steps of u are equal ratios of the quantity.
    pub logarithmic: bool,
}

impl Range {
    /// The finite minimum and maximum over a frame, as a view without a range has it.
    pub fn of(quantities: impl Iterator<Item = f64>) -> Option<Range> {
        quantities
            .filter(|q| q.is_finite())
            .map(|q| Range { min: q, max: q, logarithmic: false })
            .reduce(|a, b| Range { min: a.min.min(b.min), max: a.max.max(b.max), ..a })
    }

    /// u = clamp((Q − min)/(max − min), 0, 1), of logarithms on a logarithmic scale, where what is not positive
    /// is below all. A range of no width, on which the contract is silent, is the limit of narrow ones around
    /// its value, which itself becomes ½.
    pub fn normalise(&self, q: f64) -> f64 {
        let [q, min, max] =
            [q, self.min, self.max].map(|q| if self.logarithmic { q.max(0.0).ln() } else { q });
        let u = (q - min) / (max - min);
        match self.min < self.max {
            true => u.clamp(0.0, 1.0),
            false if q < self.min => 0.0,
            false if q > self.max => 1.0,
            false => 0.5,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn particle(x: f64, quantity: f64, volume: f64) -> Particle {
        Particle { position: DVec3::new(x, 0.0, 0.0), support_radius: 1.0, volume, quantity, opacity: 0.0 }
    }

    #[test]
    fn one_particle_gives_its_quantity_all_over_its_support() {
        let alone = [particle(0.0, 7.25, 1e-30)];
        let at = |x: f64| at(DVec3::X * x, alone.iter(), Kernel::Cubic);
        assert_eq!([0.0, 0.5, 1.0_f64.next_down()].map(at), [Some(7.25); 3]);
        assert_eq!(at(1.0), None);
    }

    #[test]
    fn halfway_between_two_the_volumes_decide() {
        let pair = [particle(-0.5, 1.0, 3.0), particle(0.5, 5.0, 1.0)];
        for kernel in Kernel::ALL {
            let q = at(DVec3::new(0.0, 0.3, 0.0), pair.iter(), kernel).unwrap();
            assert!((q - 2.0).abs() < 1e-14, "{kernel:?}: {q}");
        }
    }

    #[test]
    fn weights_by_hand() {
        // Poly6 at ρ = 0 and ρ = ½: weights 1 and (3/4)³ = 27/64.
        let pair = [particle(0.0, 0.0, 1.0), particle(0.5, 91.0, 1.0)];
        let q = at(DVec3::ZERO, pair.iter(), Kernel::Poly6).unwrap();
        assert!((q - 27.0).abs() < 1e-12, "{q}");
    }

    #[test]
    fn a_constant_quantity_is_exactly_constant() {
        let many: Vec<Particle> = (0..50).map(|i| particle(0.019 * f64::from(i), 0.1, 1.7)).collect();
        for i in 0..100 {
            let x = DVec3::new(0.01 * f64::from(i), 0.1, 0.0);
            assert_eq!(at(x, many.iter(), Kernel::WendlandC2), Some(0.1));
        }
    }

    #[test]
    fn ranges() {
        let range = Range::of([3.0, f64::NAN, -1.0, f64::INFINITY].into_iter()).unwrap();
        assert_eq!([range.min, range.max], [-1.0, 3.0]);
        assert_eq!([-5.0, -1.0, 0.0, 3.0, 9.0].map(|q| range.normalise(q)), [0.0, 0.0, 0.25, 1.0, 1.0]);
        let ratios = Range { min: 0.1, max: 1000.0, logarithmic: true };
        let us = [-1.0, 0.0, 0.1, 1.0, 1e9].map(|q| ratios.normalise(q));
        assert!(us.iter().zip([0.0, 0.0, 0.0, 0.25, 1.0]).all(|(u, v)| (u - v).abs() < 1e-12), "{us:?}");
        let point = Range { min: 2.0, max: 2.0, logarithmic: false };
        assert_eq!([1.9, 2.0, 2.1].map(|q| point.normalise(q)), [0.0, 0.5, 1.0]);
        assert!(Range::of([f64::NAN].into_iter()).is_none());
    }
}
