//! `sphcast compare`: how far two pictures differ.

use std::path::PathBuf;

use anyhow::bail;

use super::view::unit;
use crate::image_file::{self, Pixels};

/// Compare two pictures: the largest and the mean difference, and how many pixels differ.
///
/// Differences are those of premultiplied linear RGBA, whatever the files hold.
#[derive(clap::Args)]
#[command(after_help = "\
The exit status is 0 however large the difference is, unless --fail-above is given.

Example:
  sphcast compare adaptive.exr full.exr --tolerance 0.004 --fail-above 0.004")]
pub struct CompareArguments {
    #[arg(value_name = "A")]
    a: PathBuf,
    #[arg(value_name = "B")]
    b: PathBuf,
    /// Difference from which on a pixel is counted
    #[arg(long, value_name = "E", default_value = "0.004", value_parser = unit)]
    tolerance: f64,
    /// Exit with status 1 where the largest difference is above this
    #[arg(long, value_name = "E", value_parser = unit)]
    fail_above: Option<f64>,
}

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

pub fn run(arguments: &CompareArguments) -> anyhow::Result<()> {
    let (a, b) = (image_file::read(&arguments.a)?, image_file::read(&arguments.b)?);
    if (a.width, a.height) != (b.width, b.height) {
        bail!(
            "{}: is {} x {} pixels, {} is {} x {}",
            arguments.a.display(),
            a.width,
            a.height,
            arguments.b.display(),
            b.width,
            b.height
        );
    }
    let Difference { max, place: [x, y], mean, above } = difference(&a, &b, arguments.tolerance);
    println!("max   {max:.6} at pixel ({x}, {y})");
    println!("mean  {mean:.6}");
    println!("above {:.4} % of the pixels differ by more than {}", 100.0 * above, arguments.tolerance);
    match arguments.fail_above {
        Some(limit) if max > limit => {
            bail!("{}: differs by {max:.6}, more than {limit}", arguments.a.display())
        }
        _ => Ok(()),
    }
}

/// How far two pictures of one size differ.
pub fn difference(a: &Pixels, b: &Pixels, tolerance: f64) -> Difference {
    let (mut max, mut place, mut sum, mut above) = (0.0, 0, 0.0, 0_usize);
    for (index, (a, b)) in a.data.iter().zip(&b.data).enumerate() {
        let channels: [f64; 4] = std::array::from_fn(|c| channel_difference(a[c], b[c]));
        let largest = channels.into_iter().fold(0.0, f64::max);
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
    }

    #[test]
    fn not_a_number_differs_from_every_number() {
        let (a, mut b) = (pixels(&[[0.0; 4]; 2]), pixels(&[[0.0; 4]; 2]));
        b.data[1][2] = f32::NAN;
        assert_eq!(difference(&a, &b, 0.004).max, f64::INFINITY);
        assert_eq!(difference(&b, &b, 0.004).max, 0.0);
    }
}
