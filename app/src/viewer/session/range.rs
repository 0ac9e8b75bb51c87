//! The values at both ends of the transfer function: of the field that is shown, and of the one that decides
//! the opacity.

use std::collections::{BTreeMap, HashMap};

use renderer::Scale;

use super::Session;
use crate::export::Steady;
use crate::frames::Insertion;
use crate::viewer::analysis::distribution::{Analysis, Axis, Distribution};
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

/// What a field decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The colour; and the opacity, where there is no other field for that.
    Colour,
    Opacity,
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
    /// Shares of the particles below and above which values are left out, by role.
    pub quantiles: [[f64; 2]; 2],
    pub survey: Survey,
    seen: HashMap<Field, Seen>,
    /// Values at the quantiles, in the frame that was counted last, by role.
    between: [Option<(Field, [f64; 2])>; 2],
}

/// The extremes of a field in the frames that were counted.
struct Seen {
    frames: BTreeMap<usize, [f64; 2]>,
    /// Of all of them.
    all: [f64; 2],
}

impl Default for Seen {
    fn default() -> Seen {
        Seen { frames: BTreeMap::new(), all: [f64::INFINITY, f64::NEG_INFINITY] }
    }
}

impl Seen {
    fn see(&mut self, index: usize, extremes: [f64; 2]) {
        match self.frames.insert(index, extremes) {
            None => self.all = around(self.all, extremes),
            Some(before) if before != extremes => self.sum_up(),
            Some(_) => {}
        }
    }

    fn forget(&mut self, index: usize) {
        if self.frames.remove(&index).is_some() {
            self.sum_up();
        }
    }

    fn sum_up(&mut self) {
        self.all = self.frames.values().copied().fold(Seen::default().all, around);
    }
}

/// The range that holds both.
fn around(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

impl Default for Ranges {
    fn default() -> Self {
        let quantiles = [[0.01, 0.99]; 2];
        Ranges { quantiles, survey: Survey::Idle, seen: HashMap::new(), between: [None, None] }
    }
}

impl Ranges {
    /// Forgets what is of another run.
    pub(super) fn clear(&mut self) {
        *self = Ranges { quantiles: self.quantiles, survey: Survey::Unwanted, ..Ranges::default() };
    }

    pub(super) fn renumber(&mut self, insertion: &Insertion) {
        for Seen { frames, .. } in self.seen.values_mut() {
            *frames = frames.iter().map(|(index, extremes)| (insertion.moved(*index), *extremes)).collect();
        }
    }

    fn see(&mut self, index: usize, field: Field, extremes: [f64; 2]) {
        self.seen.entry(field).or_default().see(index, extremes);
    }

    /// Forgets what was in a frame that is another one now.
    pub(super) fn forget(&mut self, index: usize) {
        self.seen.values_mut().for_each(|seen| seen.forget(index));
    }

    /// Looks through all frames once more where that is at work on what is no longer so.
    pub(super) fn begin_survey_again(&mut self) {
        if let Survey::Running(_) = self.survey {
            self.survey = Survey::Wanted;
        }
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

    /// The field that has a role, on its scale.
    pub(super) fn field_of(&self, role: Role) -> Option<Field> {
        let quantity = &self.view.quantity;
        match role {
            Role::Colour => Some((quantity.name.clone(), quantity.scale)),
            Role::Opacity => Some((self.opacity_field()?, quantity.opacity.as_ref()?.scale)),
        }
    }

    /// The role of the field at which opacities are read.
    pub fn role_of_opacity(&self) -> Role {
        if self.view.quantity.opacity.is_some() { Role::Opacity } else { Role::Colour }
    }

    /// What is to be counted of the field that has a role, where `range` is what the view says.
    pub(super) fn axis(&self, role: Role, range: Option<[f64; 2]>) -> Option<Axis> {
        let (field, scale) = self.field_of(role)?;
        let source = [self.range_source, self.opacity_source][role as usize];
        let quantiles = (source == RangeSource::Quantiles).then_some(self.ranges.quantiles[role as usize]);
        Some(Axis { field, range, scale, quantiles })
    }

    /// Takes note of what was counted in a frame.
    pub(super) fn see(&mut self, analysis: &Analysis) {
        for (role, found) in [Some(&analysis.colour), analysis.opacity.as_ref()].into_iter().enumerate() {
            let Some(found) = found else { continue };
            let field = (found.axis.field.clone(), found.axis.scale);
            if let Some(between) = found.between {
                self.ranges.between[role] = Some((field.clone(), between));
            }
            if let Some(extremes) = found.extremes {
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

    /// Of how many frames the extremes of the field that has a role are known.
    pub fn frames_seen(&self, role: Role) -> usize {
        let seen = self.field_of(role).and_then(|field| self.ranges.seen.get(&field));
        seen.map_or(0, |seen| seen.frames.len())
    }

    /// What was counted of the field that has a role, in the frame that was counted last.
    pub fn distribution(&self, role: Role) -> Option<&Distribution> {
        let analysis = self.analysis.as_ref()?;
        match role {
            Role::Colour => Some(&analysis.colour),
            Role::Opacity => {
                let field = self.field_of(role)?;
                let found = analysis.opacity.as_ref()?;
                (found.axis.field == field.0 && found.axis.scale == field.1).then_some(found)
            }
        }
    }

    /// The scale of the field that has a role.
    pub fn scale(&self, role: Role) -> Scale {
        self.field_of(role).map_or(Scale::Linear, |(_, scale)| scale)
    }

    /// The range in effect of the field that is shown, where it is known.
    pub fn range(&self) -> Option<[f64; 2]> {
        self.range_of(Role::Colour)
    }

    /// The range in effect of the field that has a role, where there is one and it is known.
    pub fn range_of(&self, role: Role) -> Option<[f64; 2]> {
        let quantity = self.complete_view().quantity;
        let settled = match role {
            Role::Colour => quantity.range,
            Role::Opacity => quantity.opacity?.range,
        };
        settled.or_else(|| self.distribution(role)?.extremes)
    }

    /// What the view is to say of the range of the field that has a role, which it says is `by_hand`.
    pub(super) fn settled_range(&self, role: Role, by_hand: Option<[f64; 2]>) -> Option<[f64; 2]> {
        let field = self.field_of(role)?;
        match [self.range_source, self.opacity_source][role as usize] {
            RangeSource::Frame => None,
            RangeSource::Seen => {
                let seen = self.ranges.seen.get(&field).filter(|seen| !seen.frames.is_empty());
                seen.map(|seen| field.1.fitted(seen.all))
            }
            RangeSource::Quantiles => {
                let known = self.ranges.between[role as usize].as_ref();
                known.filter(|(of, _)| *of == field).map(|(_, between)| field.1.fitted(*between))
            }
            RangeSource::Fixed => by_hand,
        }
    }

    /// Which ranges a film is to have of all frames: those of all frames seen, of which some were not.
    pub fn steady(&self) -> Steady {
        let all = self.run.as_ref().map_or(0, |run| run.stream.len());
        let open = |source, role| source == RangeSource::Seen && self.frames_seen(role) < all;
        Steady {
            colour: open(self.range_source, Role::Colour),
            opacity: open(self.opacity_source, Role::Opacity),
        }
    }

    /// Shows the field that has a role on another scale. A range by hand that has no place there is given up.
    pub fn set_scale(&mut self, role: Role, to: Scale) {
        let quantity = &mut self.view.quantity;
        let (scale, range, source) = match (role, &mut quantity.opacity) {
            (Role::Colour, _) => (&mut quantity.scale, &mut quantity.range, &mut self.range_source),
            (Role::Opacity, Some(opacity)) => {
                (&mut opacity.scale, &mut opacity.range, &mut self.opacity_source)
            }
            (Role::Opacity, None) => return,
        };
        *scale = to;
        if range.is_some_and(|range| !to.holds(range)) {
            *range = None;
            if *source == RangeSource::Fixed {
                *source = RangeSource::Frame;
            }
        }
    }
}
