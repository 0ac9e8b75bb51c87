//! The extremes of every field of a frame, for the ends of filters.

use std::sync::Arc;

use rayon::prelude::*;

use crate::frames::Frame;
use crate::scene::{Selection, quantity_names};

/// Finite minimum and maximum of all that can be named in a frame.
pub struct FieldRanges {
    frame: Arc<Frame>,
    ranges: Vec<(String, [f64; 2])>,
}

impl FieldRanges {
    /// Goes through all fields, on all threads.
    pub fn find(frame: Arc<Frame>) -> FieldRanges {
        const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];
        let range = |name: String| {
            let selection = Selection::new(&frame, Some(&name)).ok()?;
            let [low, high] = (0..frame.len())
                .into_par_iter()
                .map(|row| selection.value(row))
                .filter(|value| value.is_finite())
                .fold(|| NOTHING, |[low, high], value| [low.min(value), high.max(value)])
                .reduce(|| NOTHING, |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
            (low <= high).then_some((name, [low, high]))
        };
        let ranges = quantity_names(&frame).into_iter().filter_map(range).collect();
        FieldRanges { frame, ranges }
    }

    pub fn is_of(&self, frame: &Arc<Frame>) -> bool {
        Arc::ptr_eq(&self.frame, frame)
    }

    /// `None` for a field that the frame lacks, or that holds no number.
    pub fn range(&self, name: &str) -> Option<[f64; 2]> {
        self.ranges.iter().find(|(known, _)| known == name).map(|(_, range)| *range)
    }
}
