//! How far two pictures are apart.

use std::fmt;

use crate::picture::Image;

/// Differences between two pictures; that of a pixel is the largest of its four channels.
#[derive(Clone, Debug)]
pub struct Comparison {
    pub max: f64,
    /// Over all pixels.
    pub mean: f64,
    /// Pixel of the largest difference.
    pub worst: [u32; 2],
    differences: Vec<f64>,
}

/// Compares two pictures. A channel that is NaN on either side, and a picture of another size, are
/// infinitely far away.
pub fn compare<A, B>(a: &Image<A>, b: &Image<B>) -> Comparison
where
    A: Copy + Into<f64>,
    B: Copy + Into<f64>,
{
    let complete = |width: u32, height: u32, length: usize| width as usize * height as usize == length;
    let comparable = [a.width, a.height] == [b.width, b.height]
        && complete(a.width, a.height, a.pixels.len())
        && complete(b.width, b.height, b.pixels.len());
    let differences: Vec<f64> = match comparable {
        true => a.pixels.iter().zip(&b.pixels).map(|(a, b)| difference(a, b)).collect(),
        false => vec![f64::INFINITY],
    };
    let max = differences.iter().copied().fold(0.0, f64::max);
    let worst = differences.iter().position(|&d| d == max).unwrap_or(0) as u32;
    Comparison {
        max,
        mean: differences.iter().sum::<f64>() / differences.len().max(1) as f64,
        worst: [worst % a.width.max(1), worst / a.width.max(1)],
        differences,
    }
}

/// Largest difference of any channel.
fn difference<A, B>(a: &[A; 4], b: &[B; 4]) -> f64
where
    A: Copy + Into<f64>,
    B: Copy + Into<f64>,
{
    let channel = |(&a, &b): (&A, &B)| {
        let difference = (a.into() - b.into()).abs();
        // f64::max would overlook NaN.
        if difference.is_nan() { f64::INFINITY } else { difference }
    };
    a.iter().zip(b).map(channel).fold(0.0, f64::max)
}

impl Comparison {
    /// Share of the pixels whose difference is above `threshold`.
    pub fn share_above(&self, threshold: f64) -> f64 {
        let above = self.differences.iter().filter(|&&d| d > threshold).count();
        above as f64 / self.differences.len().max(1) as f64
    }

    /// The limits between the renderer and its twin: 10⁻³ on 99.9 % of the pixels, 10⁻⁵ on average.
    /// A rare sample on the edge of a support may fall on either side of it in f32.
    pub fn is_alike(&self) -> bool {
        self.share_above(1e-3) <= 1e-3 && self.mean <= 1e-5
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.worst;
        let share = 100.0 * self.share_above(1e-3);
        write!(f, "max {:.2e} at ({x}, {y}), mean {:.2e}, {share:.3} % above 1e-3", self.max, self.mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture with some structure.
    fn waves(width: u32, height: u32) -> Image<f64> {
        let wave = |i: u32| {
            let (x, y) = (f64::from(i % width), f64::from(i / width));
            let alpha = 0.5 + 0.4 * (0.7 * x).sin() * (0.3 * y).cos();
            [0.2 * alpha, 0.5 * alpha, 0.9 * alpha, alpha]
        };
        Image { width, height, pixels: (0..width * height).map(wave).collect() }
    }

    #[test]
    fn a_picture_is_like_itself() {
        let image = waves(40, 30);
        let comparison = compare(&image, &image);
        assert_eq!([comparison.max, comparison.mean, comparison.share_above(0.0)], [0.0; 3]);
        assert!(comparison.is_alike());
    }

    #[test]
    fn single_precision_is_near_enough() {
        let image = waves(40, 30);
        let pixels = image.pixels.iter().map(|pixel| pixel.map(|channel| channel as f32)).collect();
        let rounded = Image { width: 40, height: 30, pixels };
        let comparison = compare(&image, &rounded);
        assert!(comparison.max > 0.0 && comparison.max < 1e-7 && comparison.is_alike(), "{comparison}");
    }

    #[test]
    fn a_shift_by_one_pixel_is_found() {
        let image = waves(40, 30);
        for offset in [1, 40] {
            let mut shifted = image.clone();
            shifted.pixels.rotate_right(offset);
            let comparison = compare(&image, &shifted);
            assert!(!comparison.is_alike() && comparison.share_above(1e-3) > 0.5, "{comparison}");
        }
    }

    #[test]
    fn one_changed_channel_is_found_and_located() {
        let image = waves(40, 30);
        for channel in 0..4 {
            let mut changed = image.clone();
            changed.pixels[7 * 40 + 11][channel] += 0.125;
            let comparison = compare(&image, &changed);
            assert!((comparison.max - 0.125).abs() < 1e-15, "{comparison}");
            assert!((comparison.mean - 0.125 / 1200.0).abs() < 1e-15, "{comparison}");
            assert_eq!(comparison.worst, [11, 7]);
            assert_eq!(comparison.share_above(1e-3), 1.0 / 1200.0);
            assert!(!comparison.is_alike());
        }
    }

    #[test]
    fn nan_is_infinitely_far_even_from_nan() {
        let image = waves(8, 8);
        let mut broken = image.clone();
        broken.pixels[9][2] = f64::NAN;
        for comparison in [compare(&image, &broken), compare(&broken, &image), compare(&broken, &broken)] {
            assert_eq!([comparison.max, comparison.mean], [f64::INFINITY; 2]);
            assert_eq!(comparison.worst, [1, 1]);
            assert!(!comparison.is_alike());
        }
    }

    #[test]
    fn other_sizes_are_infinitely_far() {
        let image = waves(8, 6);
        let turned = Image { width: 6, height: 8, pixels: image.pixels.clone() };
        let short = Image { pixels: image.pixels[1..].to_vec(), ..image.clone() };
        for other in [waves(8, 5), waves(9, 6), turned, short] {
            let comparison = compare(&image, &other);
            assert_eq!([comparison.max, comparison.share_above(1e-3)], [f64::INFINITY, 1.0]);
            assert!(!comparison.is_alike());
        }
    }
}
