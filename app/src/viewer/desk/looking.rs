//! What is found out about the particles in view, on threads of their own, one at a time.

use std::sync::Arc;

use super::{Desk, Done};
use crate::viewer::field_ranges::FieldRanges;

/// What is at work.
#[derive(Default)]
pub(super) struct Looking {
    ranges: bool,
}

impl Desk {
    /// Finds out what the panels want to know and is not known.
    pub(super) fn look_closer(&mut self) {
        let session = &mut self.session;
        if let Some((_, frame)) = session.frame()
            && session.wants_field_ranges
            && !self.looking.ranges
            && !session.field_ranges.as_ref().is_some_and(|known| known.is_of(frame))
        {
            self.looking.ranges = true;
            let frame = Arc::clone(frame);
            self.work(move || Done::Ranged(FieldRanges::find(frame)));
        }
        self.session.wants_field_ranges = false;
    }

    pub(super) fn take_field_ranges(&mut self, ranges: FieldRanges) {
        self.looking.ranges = false;
        self.session.field_ranges = Some(ranges);
    }
}
