//! The values at both ends of the transfer function: of the field that is shown, and of the one that decides
//! the opacity.

use super::Session;

/// Where the range of the transfer function comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeSource {
    /// The finite extremes of the frame in view.
    Frame,
    /// The extremes of all frames that were in view: colours do not jump from frame to frame.
    Seen,
    /// What the view says.
    Fixed,
}

impl RangeSource {
    /// Where a view's range comes from.
    pub(super) fn of(range: Option<[f64; 2]>) -> RangeSource {
        if range.is_some() { RangeSource::Fixed } else { RangeSource::Frame }
    }

    /// Goes on to a range that stays from frame to frame.
    pub(super) fn steady(&mut self) {
        if *self == RangeSource::Frame {
            *self = RangeSource::Seen;
        }
    }
}

impl Session {
    /// Of the colour, and of the opacity.
    pub(super) fn range_sources(&mut self) -> [&mut RangeSource; 2] {
        [&mut self.range_source, &mut self.opacity_source]
    }

    /// Drops ranges by hand, which mean nothing for another run.
    pub(super) fn forget_ranges(&mut self) {
        self.view.quantity.range = None;
        if let Some(opacity) = &mut self.view.quantity.opacity {
            opacity.range = None;
        }
        for source in self.range_sources() {
            if *source == RangeSource::Fixed {
                *source = RangeSource::Frame;
            }
        }
    }

    /// The name, as a view has it, of the field that decides the opacity; `None` where that is the one that
    /// is shown.
    pub fn opacity_field(&self) -> Option<Option<String>> {
        let quantity = &self.view.quantity;
        quantity.opacity.as_ref().map(|opacity| opacity.name.clone().or_else(|| quantity.name.clone()))
    }

    /// Takes note of the extremes of a field in the frame in view.
    pub(super) fn see(&mut self, field: &Option<String>, extremes: Option<[f64; 2]>) {
        if let Some([low, high]) = extremes {
            let seen = self.seen.entry(field.clone()).or_insert([low, high]);
            *seen = [seen[0].min(low), seen[1].max(high)];
        }
    }

    /// The range in effect, where it is known.
    pub fn range(&self) -> Option<[f64; 2]> {
        let extremes = || self.analysis.as_ref().and_then(|analysis| analysis.extremes);
        self.complete_view().quantity.range.or_else(extremes)
    }

    /// The extremes in this frame of the field that decides the opacity.
    pub fn opacity_extremes(&self) -> Option<[f64; 2]> {
        let (field, extremes) = self.analysis.as_ref()?.opacity.as_ref()?;
        extremes.filter(|_| self.opacity_field().as_ref() == Some(field))
    }

    /// The range in effect of that field, where there is one and it is known.
    pub fn opacity_range(&self) -> Option<[f64; 2]> {
        self.complete_view().quantity.opacity?.range.or_else(|| self.opacity_extremes())
    }

    /// What the view is to say of a field's range.
    pub(super) fn settled_range(
        &self,
        source: RangeSource,
        field: &Option<String>,
        by_hand: Option<[f64; 2]>,
    ) -> Option<[f64; 2]> {
        match source {
            RangeSource::Frame => None,
            RangeSource::Seen => self.seen.get(field).copied(),
            RangeSource::Fixed => by_hand,
        }
    }
}
