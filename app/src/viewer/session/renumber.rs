//! What has numbers of frames in it when a frame comes late and goes between others, and what was begun
//! about a run when another one is opened.

use renderer::{Keyframe, View};

use super::Session;
use crate::frames::Insertion;
use crate::viewer::render_thread::Report;

/// What numbers of frames mean: of which of the runs that were opened, and after how many insertions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Numbering {
    opening: usize,
    insertions: usize,
}

impl Session {
    /// The present one, for [`Session::bring_up_to_date`].
    pub fn numbering(&self) -> Numbering {
        Numbering { opening: self.openings, insertions: self.insertions.len() }
    }

    /// Gives frames that had numbers by `numbering` those that they have now. Returns whether they are
    /// frames of the run that is open: otherwise they have none.
    pub fn bring_up_to_date<'a>(
        &self,
        numbering: Numbering,
        frames: impl IntoIterator<Item = &'a mut usize>,
    ) -> bool {
        if numbering.opening != self.openings {
            return false;
        }
        let later = || self.insertions.iter().skip(numbering.insertions);
        for frame in frames {
            *frame = later().fold(*frame, |index, insertion| insertion.moved(index));
        }
        true
    }

    /// A report with the numbers that frames have by now; `None` where it is about a run that is no longer
    /// open.
    pub fn current(&self, mut report: Report) -> Option<Report> {
        let is_current = match report.frames() {
            Some((numbering, frames)) => self.bring_up_to_date(numbering, frames),
            None => true,
        };
        is_current.then_some(report)
    }

    /// Gives everything that is about a frame the number that this frame has from now on.
    pub(super) fn renumber(&mut self, insertion: Insertion) {
        let to = |index: &mut usize| *index = insertion.moved(*index);
        self.playback.renumber(&insertion);
        self.frame.iter_mut().for_each(|(index, _)| to(index));
        self.picture.iter_mut().for_each(|picture| to(&mut picture.index));
        self.without_picture.iter_mut().for_each(to);
        self.analysis.iter_mut().for_each(|analysis| to(&mut analysis.index));
        for told in [&mut self.told, &mut self.told_left_out] {
            *told = told.iter().map(|index| insertion.moved(*index)).collect();
        }
        self.ranges.renumber(&insertion);
        self.looking.renumber(&insertion);
        self.costs.renumber(&insertion);
        self.cameras.renumber(&insertion);
        move_keyframes(&mut self.view, &insertion);
        self.history.each_view(|view| move_keyframes(view, &insertion));
        // Counted anew when it is looked at.
        self.statistics = None;
        self.ranges.begin_survey_again();
        self.insertions.push(insertion);
    }
}

/// Keyframes stay at their frames; those between two frames stay behind the first of them.
fn move_keyframes(view: &mut View, insertion: &Insertion) {
    for Keyframe { frame, .. } in &mut view.path.keyframes {
        let at = frame.max(0.0).floor();
        *frame += insertion.moved(at as usize) as f64 - at;
    }
}
