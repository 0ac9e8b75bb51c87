//! How far two pictures differ.

use crate::image_file::Pixels;

/// Differences between two pictures of one size, in units of the channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Over all channels of all pixels. Infinite where only one picture holds a number.
    pub max: f64,
    /// Column and row of a pixel with the largest difference.
    pub place: [u32; 2],
    /// Over all channels of all pixels.
    pub mean: f64,
    /// Share of pixels with a channel that differs by more than the tolerance.
    pub above: f64,
}

/// How far two pictures of one size differ.
pub fn difference(a: &Pixels, b: &Pixels, tolerance: f64) -> Difference {
    let (mut max, mut place, mut sum, mut above) = (0.0, 0, 0.0, 0_usize);
    for (index, (a, b)) in a.data.iter().zip(&b.data).enumerate() {
        let channels = channel_differences(a, b);
        let largest = largest(channels);
        if largest > max {
            (max, place) = (largest, index);
        }
        sum += channels.iter().sum::<f64>();
        above += usize::from(largest > tolerance);
    }
    let pixels = a.data.len().max(1);
    let (width, place) = (a.width.max(1) as usize, place);
    Difference {
        max,
        place: [(place % width) as u32, (place / width) as u32],
        mean: sum / (4 * pixels) as f64,
        above: above as f64 / pixels as f64,
    }
}

/// The largest difference of any channel, pixel after pixel.
pub fn by_pixel(a: &Pixels, b: &Pixels) -> Vec<f64> {
    a.data.iter().zip(&b.data).map(|(a, b)| largest(channel_differences(a, b))).collect()
}

fn largest(channels: [f64; 4]) -> f64 {
    channels.into_iter().fold(0.0, f64::max)
}

fn channel_differences(a: &[f32; 4], b: &[f32; 4]) -> [f64; 4] {
    std::array::from_fn(|c| channel_difference(a[c], b[c]))
}

/// A difference that cannot hide: not-a-number against a number is as far as it gets.
fn channel_difference(a: f32, b: f32) -> f64 {
    match (f64::from(a) - f64::from(b)).abs() {
        difference if !difference.is_nan() => difference,
        _ if a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()) => 0.0,
        _ => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(data: &[[f32; 4]]) -> Pixels {
        Pixels { width: 2, height: data.len() as u32 / 2, data: data.to_vec() }
    }

    #[test]
    fn every_kind_of_difference_counts() {
        let a = pixels(&[[0.0; 4]; 4]);
        assert_eq!(difference(&a, &a, 0.0), Difference { max: 0.0, place: [0, 0], mean: 0.0, above: 0.0 });
        let mut b = a.clone();
        b.data[3][3] = -0.5;
        b.data[1][0] = 0.25;
        let expected = Difference { max: 0.5, place: [1, 1], mean: 0.75 / 16.0, above: 0.25 };
        assert_eq!(difference(&a, &b, 0.3), expected);
        assert_eq!(difference(&b, &a, 0.3), expected);
        assert_eq!(by_pixel(&a, &b), [0.0, 0.25, 0.0, 0.5]);
    }

    #[test]
    fn not_a_number_differs_from_every_number() {
        let (a, mut b) = (pixels(&[[0.0; 4]; 2]), pixels(&[[0.0; 4]; 2]));
        b.data[1][2] = f32::NAN;
        assert_eq!(difference(&a, &b, 0.004).max, f64::INFINITY);
        assert_eq!(difference(&b, &b, 0.004).max, 0.0);
    }
}
