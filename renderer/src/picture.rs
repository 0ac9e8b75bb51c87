//! The picture that a rendering leaves.

use crate::stats::Stats;

/// Premultiplied linear RGBA, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// width·height pixels, row after row.
    pub pixels: Vec<[f32; 4]>,
    /// What the picture cost.
    pub stats: Stats,
}
