//! Between which values a field lies, on a scale.

use rayon::prelude::*;
use renderer::Scale;

use super::Selection;
use crate::frames::Frame;

const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Whether a value has a place on a scale.
pub fn is_shown(value: f64, scale: Scale) -> bool {
    value.is_finite() && (scale == Scale::Linear || value > 0.0)
}

/// Finite minimum and maximum over a frame, on a logarithmic scale the upper 30 decades of what is positive.
pub fn extremes(frame: &Frame, selection: &Selection, scale: Scale) -> Option<[f64; 2]> {
    let [low, high] = (0..frame.len())
        .into_par_iter()
        .map(|row| selection.value(row))
        .filter(|q| is_shown(*q, scale))
        .fold(|| NOTHING, |[low, high], q| [low.min(q), high.max(q)])
        .reduce(|| NOTHING, union);
    (low <= high).then(|| scale.fitted([low, high]))
}

/// The smallest range that has both in it.
pub fn union([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a.min(c), b.max(d)]
}
