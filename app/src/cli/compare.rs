//! `sphcast compare`: how far two pictures differ.

use std::path::PathBuf;

use anyhow::bail;

use super::view::unit;
use crate::difference::{Difference, difference};
use crate::image_file;
use crate::say::say;

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
    let (percent, tolerance) = (100.0 * above, arguments.tolerance);
    say(format_args!(
        "max   {max:.6} at pixel ({x}, {y})\n\
         mean  {mean:.6}\n\
         above {percent:.4} % of the pixels differ by more than {tolerance}\n"
    ))?;
    match arguments.fail_above {
        Some(limit) if max > limit => {
            bail!("{}: differs by {max:.6}, more than {limit}", arguments.a.display())
        }
        _ => Ok(()),
    }
}
