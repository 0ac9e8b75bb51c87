//! What is found out about the particles in view, on threads of their own, one of each kind at a time.

use std::sync::Arc;

use super::{Desk, Done};
use crate::viewer::analysis::field_ranges::FieldRanges;
use crate::viewer::analysis::pool::Pool;

/// What is at work.
#[derive(Default)]
pub(super) struct Inquiries {
    pub(super) ranges: bool,
    pub(super) pointing: bool,
    pub(super) search: bool,
    pub(super) statistics: bool,
    pub(super) pool: bool,
}

impl Desk {
    /// Finds out what panels and tools want to know and is not known. Of several wishes of a kind,
    /// the latest is the one that is asked next.
    pub(super) fn look_closer(&mut self) {
        if !self.inquiries.pointing
            && let Some(question) = self.session.looking.question()
        {
            self.inquiries.pointing = true;
            self.work(move || Done::Pointed(Box::new(question.answer())));
        }
        if !self.inquiries.search
            && let Some(search) = self.session.search()
        {
            self.inquiries.search = true;
            self.work(move || Done::Located(search.locate()));
        }
        if self.session.wants_statistics
            && !self.inquiries.statistics
            && let Some(question) = self.session.statistics_question()
        {
            self.inquiries.statistics = true;
            self.work(move || Done::Statistics(Box::new(question.answer())));
        }
        if !std::mem::take(&mut self.session.wants_statistics) {
            // What nobody looks at must not keep a frame in memory.
            self.session.statistics = None;
        }
        self.pool_frames();
        self.find_ranges();
    }

    fn pool_frames(&mut self) {
        if self.session.wants_pool
            && !self.inquiries.pool
            && let Some(question) = self.session.pool_question()
        {
            self.inquiries.pool = true;
            self.work(move || Done::Pooled(Box::new(question.answer())));
        }
        if !std::mem::take(&mut self.session.wants_pool) {
            self.session.pool = Pool::default();
        }
    }

    fn find_ranges(&mut self) {
        let session = &mut self.session;
        if let Some((_, frame)) = session.frame()
            && session.wants_field_ranges
            && !self.inquiries.ranges
            && !session.field_ranges.as_ref().is_some_and(|known| known.is_of(frame))
        {
            self.inquiries.ranges = true;
            let frame = Arc::clone(frame);
            self.work(move || Done::Ranged(FieldRanges::find(frame)));
        }
        if !std::mem::take(&mut self.session.wants_field_ranges) {
            self.session.field_ranges = None;
        }
    }
}
