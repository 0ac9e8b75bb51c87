//! How densely a picture is sampled: the tolerance, and what may be done within it.

use serde::{Deserialize, Serialize};

use crate::camera::BUNDLE_SIDE;
use crate::view::{SamplingView, ViewError};

/// Which bound of the error decides what may be left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", try_from = "String")]
pub enum Bound {
    /// Ours, of the difference from full sampling: what is sampled in full adds nothing to it.
    #[default]
    Difference,
    /// The paper's: the width of the interval in which any sampling of the ray ends (HPG 2016, Sec. 4
    /// and 5). Strict, it hardly ever allows anything; relaxed, it guarantees nothing. For comparison.
    Paper,
}

impl TryFrom<String> for Bound {
    type Error = ViewError;

    fn try_from(name: String) -> Result<Bound, ViewError> {
        match name.as_str() {
            "difference" => Ok(Bound::Difference),
            "paper" => Ok(Bound::Paper),
            _ => {
                let what = format!("unknown bound `{name}`, expected difference or paper");
                Err(ViewError::new("sampling.bound", what))
            }
        }
    }
}

/// How many rays a brick is wide and high.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(into = "u32", try_from = "u32")]
pub enum BrickWidth {
    /// Leaves the fewest evaluations, and takes longest to find out which.
    Two,
    /// Mostly the fastest.
    #[default]
    Four,
}

impl BrickWidth {
    pub const ALL: [BrickWidth; 2] = [BrickWidth::Two, BrickWidth::Four];

    pub fn rays(self) -> u32 {
        match self {
            BrickWidth::Two => 2,
            BrickWidth::Four => 4,
        }
    }

    /// Columns of bricks of a bundle.
    pub(crate) fn columns(self) -> usize {
        (BUNDLE_SIDE / self.rays()).pow(2) as usize
    }
}

impl From<BrickWidth> for u32 {
    fn from(width: BrickWidth) -> u32 {
        width.rays()
    }
}

impl TryFrom<u32> for BrickWidth {
    type Error = ViewError;

    fn try_from(rays: u32) -> Result<BrickWidth, ViewError> {
        let known = BrickWidth::ALL.into_iter().find(|width| width.rays() == rays);
        known.ok_or_else(|| ViewError::new("sampling.brick_width", format!("{rays} is neither 2 nor 4")))
    }
}

/// What of a view decides how densely it is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// E_I: the largest error of any channel of any pixel against full sampling; `None` for full
    /// sampling.
    pub tolerance: Option<f32>,
    pub bound: Bound,
    /// E_relax in [0, 1]: the share that is not charged where a brick follows its slope or is sampled more
    /// coarsely along the ray (HPG 2016, Sec. 5). 0 is a guarantee.
    pub relaxation: f32,
    /// Bricks may follow the slope of the quantity or, where they may not be shown, be sampled once a ray for
    /// their four slices; by the paper's bound, cells at levels 1 to 4.
    pub z_adaptive: bool,
    /// Bricks, or by the paper's bound cells, may be shown by one colour.
    pub super_pixels: bool,
    /// Of our bound's bricks.
    pub brick_width: BrickWidth,
    /// For measurements; no view asks for it.
    #[doc(hidden)]
    pub without: Without,
    /// Analysed even where that hardly pays.
    pub always_adaptive: bool,
}

/// A part of the method that is left out, to see what it is worth. The tolerance is kept without it.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Without {
    #[default]
    Nothing,
    /// Bricks are bounded by the extremes of their particles.
    Expansion,
    /// Any ray may miss the particles of any brick.
    Coverage,
    /// Bricks are sampled less from front to back, whatever each saves, until the budget is used up.
    GreedFromFront,
    /// Bricks are sampled less from back to front: the paper's order.
    GreedFromBack,
    /// Bricks are sampled, or shown by one colour.
    Slopes,
    /// Sampled in full, and each sample looks up its particles in a hash grid in world space.
    CellsAlongRays,
}

/// As `bundle.wgsl` numbers them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Between {
    Nothing = 0,
    Levels = 1,
    Slopes = 2,
}

/// By how much single precision and the early end of rays (transparency 10⁻⁵) may set two pictures
/// apart that are sampled alike.
const ROUNDING: f32 = 3e-5;

impl Sampling {
    pub(crate) fn new(view: &SamplingView) -> Sampling {
        Sampling {
            tolerance: view.tolerance.map(|e| e as f32),
            bound: view.bound,
            relaxation: view.relaxation as f32,
            z_adaptive: view.z_adaptive,
            super_pixels: view.super_pixels,
            brick_width: view.brick_width,
            without: Without::Nothing,
            always_adaptive: view.always_adaptive,
        }
    }

    /// What there may be between full sampling of a brick or cell and showing it by one colour.
    pub(crate) fn between(&self) -> Between {
        match self.bound {
            _ if !self.z_adaptive => Between::Nothing,
            Bound::Difference if !self.super_pixels => Between::Levels,
            Bound::Difference if matches!(self.without, Without::Slopes | Without::Expansion) => {
                Between::Nothing
            }
            Bound::Difference => Between::Slopes,
            Bound::Paper => Between::Levels,
        }
    }

    /// Of the columns that what was found out is kept for; the paper's bound knows none, and keeps it as for the finest.
    pub(crate) fn column_width(&self) -> BrickWidth {
        match self.bound {
            Bound::Difference => self.brick_width,
            Bound::Paper => BrickWidth::Two,
        }
    }

    /// What the bounds may charge to a ray; `None` where nothing may be adapted.
    pub(crate) fn budget(&self) -> Option<f32> {
        let budget = self.tolerance? - ROUNDING;
        (budget > 0.0).then_some(budget)
    }
}
