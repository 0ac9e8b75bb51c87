//! How densely a picture is sampled: the tolerance, and what may be done within it.

use crate::view::SamplingView;

/// What of a view decides how densely it is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// E_I: the largest error of any channel of any pixel against full sampling; `None` for full
    /// sampling.
    pub tolerance: Option<f32>,
    /// Bricks may be shown by one colour.
    pub super_pixels: bool,
}

/// By how much single precision and the early end of rays (transparency 10⁻⁵) may set two pictures
/// apart that are sampled alike.
const ROUNDING: f32 = 3e-5;

impl Sampling {
    pub(crate) fn new(view: &SamplingView) -> Sampling {
        let SamplingView { tolerance, super_pixels, .. } = *view;
        Sampling { tolerance: tolerance.map(|e| e as f32), super_pixels }
    }

    /// What the bounds may charge to a ray; `None` where nothing may be adapted.
    pub(crate) fn budget(&self) -> Option<f32> {
        let budget = self.tolerance? - ROUNDING;
        (self.super_pixels && budget > 0.0).then_some(budget)
    }
}
