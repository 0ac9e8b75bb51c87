//! How deep lies what is seen in a pixel: the mean view depth at which its opacity arises.

use rayon::prelude::*;

use crate::neighbours::Neighbours;
use crate::particle::Particle;
use crate::picture::trace;
use crate::setup::Setup;

/// A sample that a ray meets particles at.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Number of its slab.
    pub slab: u32,
    /// View depth z.
    pub depth: f64,
    /// T·(1 − t): what it adds to the opacity of the pixel.
    pub weight: f64,
}

/// Σ T·(1 − t)·z / Σ T·(1 − t); +∞ where nothing is seen.
pub fn mean(samples: &[Sample]) -> f64 {
    let opacity = opacity(samples);
    let sum: f64 = samples.iter().map(|sample| sample.weight * sample.depth).sum();
    if opacity > 0.0 { sum / opacity } else { f64::INFINITY }
}

/// Σ T·(1 − t).
pub fn opacity(samples: &[Sample]) -> f64 {
    samples.iter().map(|sample| sample.weight).sum()
}

/// What `of_samples` makes of the samples of each pixel, from front to back; row after row from the top.
pub fn of_pixels<T: Send>(
    setup: &Setup,
    particles: &[Particle],
    of_samples: impl Fn(&[Sample]) -> T + Sync,
) -> Vec<T> {
    let neighbours = Neighbours::new(particles);
    let (width, height) = (setup.camera.width, setup.camera.height);
    let value = |index: u32| {
        let mut samples = Vec::new();
        let pixel = [index % width, index / width];
        trace(setup, particles, &neighbours, pixel, &|_| 0, &mut |sample| samples.push(sample));
        of_samples(&samples)
    };
    (0..width * height).into_par_iter().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{grey, plain_view};
    use glam::DVec3;

    fn sample(depth: f64, weight: f64) -> Sample {
        Sample { slab: 0, depth, weight }
    }

    #[test]
    fn samples_count_by_what_they_add_to_the_opacity() {
        assert_eq!(mean(&[sample(1.0, 0.5), sample(3.0, 0.25), sample(9.0, 0.0)]), 1.25 / 0.75);
        assert_eq!(mean(&[]), f64::INFINITY);
        assert_eq!(mean(&[sample(1.0, 0.0)]), f64::INFINITY);
    }

    /// Between planes z = a and z = b, filled with a constant: the mean of an exponential, cut off.
    #[test]
    fn in_a_constant_cloud_it_is_that_of_beer_and_lambert() {
        let mut view = plain_view(3, 3);
        view.transfer.points = vec![grey(0.0, 1.0, 0.7)];
        view.sampling.rate = 400.0;
        let setup = Setup::new(&view);
        let particle = Particle {
            position: DVec3::ZERO,
            support_radius: 50.0,
            volume: 1.0,
            quantity: 0.5,
            opacity: 0.0,
        };
        for (index, depth) in (0..).zip(of_pixels(&setup, &[particle], mean)) {
            let slope = setup.camera.ray(index % 3, index / 3).length();
            let absorption = -0.3_f64.ln() * slope / setup.reference_length;
            let path = absorption * 6.0;
            let expected = 1.0 + (1.0 - path * (-path).exp() / (1.0 - (-path).exp())) / absorption;
            assert!((depth - expected).abs() < 1e-5, "pixel {index}: {depth}, expected {expected}");
        }
    }
}
