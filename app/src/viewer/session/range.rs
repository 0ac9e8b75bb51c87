//! The values at both ends of the transfer function: of the field that is shown, and of the one that decides
//! the opacity.

use std::collections::{BTreeSet, HashMap};

use renderer::Scale;

use super::Session;
use crate::viewer::analysis::distribution::Analysis;
use crate::viewer::analysis::survey::{Field, Found};

/// Where the range of the transfer function comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeSource {
    /// The finite extremes of the frame in view.
    Frame,
    /// The extremes of all frames that were in view or looked through: colours do not jump from frame to
    /// frame.
    Seen,
    /// Without the smallest and the largest values of the frame in view.
    Quantiles,
    /// What the view says.
    Fixed,
}

/// What is to become of looking through all frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Survey {
    #[default]
    Idle,
    Wanted,
    /// Share done.
    Running(f32),
    Unwanted,
}

/// What is known of values in several frames.
pub struct Ranges {
    /// Shares of the particles below and above which values are left out.
    pub quantiles: [f64; 2],
    pub survey: Survey,
    /// Extremes of each field, and the frames that they are of.
    seen: HashMap<Field, ([f64; 2], BTreeSet<usize>)>,
    /// Values at the quantiles, in the frame that was counted last.
    between: Option<(Field, [f64; 2])>,
}

impl Default for Ranges {
    fn default() -> Self {
        let quantiles = [0.01, 0.99];
        Ranges { quantiles, survey: Survey::Idle, seen: HashMap::new(), between: None }
    }
}

impl Ranges {
    /// Forgets what is of another run.
    pub(super) fn clear(&mut self) {
        *self = Ranges { quantiles: self.quantiles, survey: Survey::Unwanted, ..Ranges::default() };
    }

    fn see(&mut self, index: usize, field: Field, [low, high]: [f64; 2]) {
        let (seen, frames) = self.seen.entry(field).or_insert(([low, high], BTreeSet::new()));
        *seen = [seen[0].min(low), seen[1].max(high)];
        frames.insert(index);
    }
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

    /// The field that is shown, on its scale.
    fn shown_field(&self) -> Field {
        (self.view.quantity.name.clone(), self.view.quantity.scale)
    }

    /// Takes note of what was counted in a frame.
    pub(super) fn see(&mut self, analysis: &Analysis) {
        let field = (analysis.quantity.clone(), analysis.scale);
        if let Some(between) = analysis.between {
            self.ranges.between = Some((field.clone(), between));
        }
        let opacity = analysis.opacity.clone().map(|(name, extremes)| ((name, Scale::Linear), extremes));
        for (field, extremes) in [Some((field, analysis.extremes)), opacity].into_iter().flatten() {
            if let Some(extremes) = extremes {
                self.ranges.see(analysis.index, field, extremes);
            }
        }
    }

    /// Takes note of what was found out about all frames.
    pub fn learn(&mut self, found: Found) {
        for (index, field, extremes) in found {
            self.ranges.see(index, field, extremes);
        }
    }

    /// Of how many frames the extremes of the field that is shown are known.
    pub fn frames_seen(&self) -> usize {
        self.ranges.seen.get(&self.shown_field()).map_or(0, |(_, frames)| frames.len())
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
        field: Field,
        by_hand: Option<[f64; 2]>,
    ) -> Option<[f64; 2]> {
        match source {
            RangeSource::Frame => None,
            RangeSource::Seen => self.ranges.seen.get(&field).map(|(extremes, _)| *extremes),
            RangeSource::Quantiles => {
                self.ranges.between.as_ref().filter(|(of, _)| *of == field).map(|(_, between)| *between)
            }
            RangeSource::Fixed => by_hand,
        }
    }

    /// Shows the quantity on another scale. A range by hand that has no place there is given up.
    pub fn set_scale(&mut self, scale: Scale) {
        self.view.quantity.scale = scale;
        let impossible = self.view.quantity.range.is_some_and(|[low, _]| low <= 0.0);
        if scale == Scale::Log && impossible {
            self.view.quantity.range = None;
            if self.range_source == RangeSource::Fixed {
                self.range_source = RangeSource::Frame;
            }
        }
    }
}
