//! How densely a picture is sampled: the tolerance, and what may be done within it.

use crate::view::SamplingView;

/// What of a view decides how densely it is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// E_I: the largest error of any channel of any pixel against full sampling; `None` for full
    /// sampling.
    pub tolerance: Option<f32>,
    /// E_relax in [0, 1]: the share of a brick's lateral width that is not charged where it is sampled more
    /// coarsely along the ray (HPG 2016, Sec. 5). 0 is a guarantee.
    pub relaxation: f32,
    /// Bricks may be sampled once a ray for their four slices.
    pub z_adaptive: bool,
    /// Bricks may be shown by one colour.
    pub super_pixels: bool,
}

/// By how much single precision and the early end of rays (transparency 10⁻⁵) may set two pictures
/// apart that are sampled alike.
const ROUNDING: f32 = 3e-5;

impl Sampling {
    pub(crate) fn new(view: &SamplingView) -> Sampling {
        let SamplingView { tolerance, relaxation, z_adaptive, super_pixels, .. } = *view;
        let (tolerance, relaxation) = (tolerance.map(|e| e as f32), relaxation as f32);
        Sampling { tolerance, relaxation, z_adaptive, super_pixels }
    }

    /// Whether a coarser sampling of bricks may cost less than to show them, for all that it saves.
    pub(crate) fn may_coarsen(&self) -> bool {
        self.z_adaptive && (self.relaxation > 0.0 || !self.super_pixels)
    }

    /// What the bounds may charge to a ray; `None` where nothing may be adapted.
    pub(crate) fn budget(&self) -> Option<f32> {
        let budget = self.tolerance? - ROUNDING;
        (budget > 0.0).then_some(budget)
    }
}
