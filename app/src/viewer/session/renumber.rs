//! What has numbers of frames in it when a frame comes late and goes between others.

use renderer::{Keyframe, View};

use super::{Session, Survey};
use crate::frames::Insertion;

impl Session {
    /// How often frames went between others, for [`Session::moved_since`].
    pub fn numbering(&self) -> usize {
        self.insertions.len()
    }

    /// The number that a frame has now, which was `index` when the numbering was `numbering`.
    pub fn moved_since(&self, numbering: usize, index: usize) -> usize {
        let later = self.insertions.iter().skip(numbering);
        later.fold(index, |index, insertion| insertion.moved(index))
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
        if let Survey::Running(_) = self.ranges.survey {
            self.ranges.survey = Survey::Wanted;
        }
        self.insertions.push(insertion);
        // What is being drawn has its old number.
        self.ask_again();
    }
}

/// Keyframes stay at their frames; those between two frames stay behind the first of them.
fn move_keyframes(view: &mut View, insertion: &Insertion) {
    for Keyframe { frame, .. } in &mut view.path.keyframes {
        let at = frame.max(0.0).floor();
        *frame += insertion.moved(at as usize) as f64 - at;
    }
}
