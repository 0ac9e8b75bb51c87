//! `--layers`: what an EXR holds beside the colour of its pixels.

/// A value for each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Layer {
    /// What the analysis charged to the pixel's ray: no channel is farther from full sampling, but for
    /// rounding
    PredictedError,
}

impl Layer {
    /// Names of the channels of `layers`, in ascending order.
    pub fn channels(layers: &[Layer]) -> Vec<&'static str> {
        if layers.is_empty() { Vec::new() } else { vec!["predicted_error"] }
    }
}
