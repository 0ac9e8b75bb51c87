//! Compositing along one ray, front to back (contract, section 1; Eq. 3 of the HPG 2016 paper).

/// What the samples so far leave: irradiance I per colour, and the transparency T before what follows.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    irradiance: [f64; 3],
    transparency: f64,
}

impl Default for Ray {
    fn default() -> Ray {
        Ray { irradiance: [0.0; 3], transparency: 1.0 }
    }
}

impl Ray {
    /// Adds a sample of linear colour and opacity α per reference length, which stands for a path of
    /// `length` reference lengths; T·(1 − t), what it adds to the opacity.
    pub fn add(&mut self, [r, g, b, alpha]: [f64; 4], length: f64) -> f64 {
        // 1 − (1 − α)^length without the cancellation that thin samples suffer; ln 0 = −∞ gives 1.
        let opacity = -(length * (-alpha).ln_1p()).exp_m1();
        let weight = self.transparency * opacity;
        for (irradiance, colour) in self.irradiance.iter_mut().zip([r, g, b]) {
            *irradiance += weight * colour;
        }
        self.transparency *= 1.0 - opacity;
        weight
    }

    /// Whether nothing behind can be seen.
    pub fn is_opaque(&self) -> bool {
        self.transparency == 0.0
    }

    /// Premultiplied linear RGBA.
    pub fn pixel(&self) -> [f64; 4] {
        let [r, g, b] = self.irradiance;
        [r, g, b, 1.0 - self.transparency]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(a: [f64; 4], b: [f64; 4]) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15), "{a:?} is not {b:?}");
    }

    fn pixel(samples: &[([f64; 4], f64)]) -> [f64; 4] {
        let mut ray = Ray::default();
        for &(sample, length) in samples {
            ray.add(sample, length);
        }
        ray.pixel()
    }

    #[test]
    fn nothing_adds_nothing() {
        assert_eq!(pixel(&[]), [0.0; 4]);
        assert_eq!(pixel(&[([1.0, 1.0, 1.0, 0.0], 5.0)]), [0.0; 4]);
    }

    #[test]
    fn an_opaque_sample_hides_what_follows() {
        let red = ([1.0, 0.0, 0.0, 1.0], 1e-9);
        let green = ([0.0, 1.0, 0.0, 0.5], 1.0);
        assert_eq!(pixel(&[red, green]), [1.0, 0.0, 0.0, 1.0]);
        assert_near(pixel(&[green, red]), [0.5, 0.5, 0.0, 1.0]);
    }

    #[test]
    fn opacity_belongs_to_one_reference_length() {
        let sample = [0.25, 0.5, 1.0, 0.36];
        assert_near(pixel(&[(sample, 1.0)]), [0.09, 0.18, 0.36, 0.36]);
        // Half the length: 1 − √0.64 = 0.2; twice: 1 − 0.64².
        assert_near(pixel(&[(sample, 0.5)]), [0.05, 0.1, 0.2, 0.2]);
        assert_near(pixel(&[(sample, 2.0)]), [0.1476, 0.2952, 0.5904, 0.5904]);
    }

    #[test]
    fn a_path_in_pieces_is_the_same_path() {
        let sample = [0.3, 0.6, 0.9, 0.7];
        assert_near(pixel(&[(sample, 0.3), (sample, 1.1), (sample, 0.1)]), pixel(&[(sample, 1.5)]));
    }

    #[test]
    fn thin_samples_keep_their_opacity() {
        let [red, ..] = pixel(&[([1.0, 1.0, 1.0, 1e-10], 1e-10)]);
        assert!((red / 1e-20 - 1.0).abs() < 1e-9, "{red}");
    }
}
