//! `--view` and the flags that override it.

use std::path::PathBuf;

use renderer::{Kernel, View};

use crate::frames::{Sequence, demo};
use crate::view_file;

/// What defines a picture: a file, and flags that go before it.
#[derive(clap::Args)]
pub struct ViewArguments {
    #[command(flatten)]
    pub shown: ShownArguments,
    /// Largest error of any channel of any pixel against full sampling, 0 to 1; `off` for full sampling
    #[arg(long, value_name = "E|off", value_parser = tolerance)]
    pub tolerance: Option<Tolerance>,
}

/// What defines a picture, except for how far it may be from full sampling.
#[derive(clap::Args)]
pub struct ShownArguments {
    /// Camera, colours and all other settings of the picture
    #[arg(long, value_name = "view.json")]
    pub view: Option<PathBuf>,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// How far the guarantee may be relaxed for speed, 0 (not at all) to 1
    #[arg(long, value_name = "R", value_parser = unit)]
    pub relaxation: Option<f64>,
    /// Field to show: its name, `velocity` for a length, `velocity.x` for a component
    #[arg(long, value_name = "NAME")]
    pub quantity: Option<String>,
    /// Field that decides the opacity, where that is another one than the field to show
    #[arg(long, value_name = "NAME")]
    pub opacity_by: Option<String>,
    /// Radius at which the kernel reaches zero, in the unit of the run
    #[arg(long, value_name = "H", value_parser = length)]
    pub support_radius: Option<f64>,
    /// Smoothing kernel: poly6, cubic or wendland-c2
    #[arg(long, value_name = "K")]
    pub kernel: Option<Kernel>,
}

/// The value of `--tolerance`; `None` is `off`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance(pub Option<f64>);

impl ViewArguments {
    /// As [`ShownArguments::resolve`], with the tolerance put in.
    pub fn resolve(&self, sequence: &Sequence) -> anyhow::Result<View> {
        let mut view = self.shown.resolve(sequence)?;
        if let Some(Tolerance(tolerance)) = self.tolerance {
            view.sampling.tolerance = tolerance;
        }
        Ok(view)
    }
}

impl ShownArguments {
    /// The view to show `sequence` with: the file's, or the demo's own, or the default, with the flags put in.
    ///
    /// # Errors
    /// A file that cannot be read, is not a view, or holds a value out of range; the file comes first.
    pub fn resolve(&self, sequence: &Sequence) -> anyhow::Result<View> {
        let mut view = match &self.view {
            Some(path) => view_file::read(path)?,
            None if sequence.is_demo() => demo::view(),
            None => View::default(),
        };
        if let Some([width, height]) = self.size {
            (view.image.width, view.image.height) = (width, height);
        }
        view.sampling.relaxation = self.relaxation.unwrap_or(view.sampling.relaxation);
        view.quantity.name = self.quantity.clone().or(view.quantity.name);
        if let Some(name) = &self.opacity_by {
            view.quantity.opacity.get_or_insert_default().name = Some(name.clone());
        }
        view.particles.support_radius = self.support_radius.or(view.particles.support_radius);
        view.particles.kernel = self.kernel.unwrap_or(view.particles.kernel);
        Ok(view)
    }
}

/// `1024x768`
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    let largest = renderer::ImageView::MAX_SIDE;
    match sides {
        Some(sides) if sides.iter().all(|side| (1..=largest).contains(side)) => Ok(sides),
        _ => Err(format!("expected WxH, such as 1024x768, with sides of 1 to {largest} pixels")),
    }
}

pub fn tolerance(text: &str) -> Result<Tolerance, String> {
    match text {
        "off" => Ok(Tolerance(None)),
        number => match unit(number) {
            Ok(tolerance) => Ok(Tolerance(Some(tolerance))),
            Err(what) => Err(format!("{what}, or `off`")),
        },
    }
}

/// A number from 0 to 1.
pub fn unit(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=1.0).contains(number));
    number.ok_or_else(|| "expected a number between 0 and 1".to_owned())
}

fn length(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|length: &f64| length.is_finite() && *length > 0.0);
    number.ok_or_else(|| "expected a positive length".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_tolerances() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        for wrong in ["640", "0x5", "axb", "640x480x3", "99999x5", "-1x5"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
        assert_eq!(tolerance("off"), Ok(Tolerance(None)));
        assert_eq!(tolerance("0.01"), Ok(Tolerance(Some(0.01))));
        for wrong in ["nan", "-1", "2", "on", ""] {
            assert!(tolerance(wrong).is_err(), "{wrong}");
        }
        assert!(length("0").is_err() && length("inf").is_err() && length("1e-12").is_ok());
    }
}
