//! The histogram of all frames in memory. Each frame is counted once, when it has been read, and its bars leave
//! with it; nothing is read for this. As in the histogram of one frame, all its particles count.

use std::collections::BTreeMap;
use std::sync::{Arc, Weak};

use renderer::Scale;

use crate::frames::Frame;
use crate::scene::Selection;
use crate::viewer::analysis::histogram::Histogram;

/// What the bars of all frames divide.
#[derive(Clone, Debug, PartialEq)]
pub struct Ruler {
    /// The field's name, as a view has it.
    pub field: Option<String>,
    pub range: [f64; 2],
    pub scale: Scale,
}

/// A frame that is to be counted.
pub struct Question {
    index: usize,
    frame: Arc<Frame>,
    ruler: Ruler,
}

/// A frame that was counted.
pub struct Answer {
    index: usize,
    frame: Weak<Frame>,
    ruler: Ruler,
    histogram: Option<Histogram>,
}

/// What is known of the frames in memory.
#[derive(Default)]
pub struct Pool {
    ruler: Option<Ruler>,
    /// By the frame's place in the run; frames without the field have no histogram.
    counted: BTreeMap<usize, (Weak<Frame>, Option<Histogram>)>,
    /// Frames in memory at the last look.
    loaded: usize,
    /// What was known by the ruler before, until as much is known by this one.
    before: Option<(Histogram, usize)>,
}

impl Question {
    pub fn answer(self) -> Answer {
        let Question { index, frame, ruler } = self;
        let selection = Selection::new(&frame, ruler.field.as_deref()).ok();
        let histogram =
            selection.map(|selection| Histogram::of(&frame, &selection, ruler.range, ruler.scale));
        Answer { index, frame: Arc::downgrade(&frame), ruler, histogram }
    }
}

impl Pool {
    /// Which of the frames in memory, `loaded`, is to be counted next, that at `playhead` before those around
    /// it; `None` where all are counted by `ruler`. Forgets frames that are no longer there.
    ///
    /// A ruler that changes all the time, as while a range is dragged, still gets somewhere: half of the
    /// frames are counted by one before another one counts.
    pub fn follow(
        &mut self,
        ruler: Ruler,
        loaded: &[(usize, Arc<Frame>)],
        playhead: usize,
    ) -> Option<Question> {
        self.loaded = loaded.len();
        self.counted.retain(|index, (frame, _)| {
            let place = loaded.binary_search_by_key(index, |(index, _)| *index);
            place.is_ok_and(|place| std::ptr::eq(frame.as_ptr(), Arc::as_ptr(&loaded[place].1)))
        });
        if self.ruler.as_ref() != Some(&ruler) {
            self.take_up(ruler);
        }
        let ruler = self.ruler.clone()?;
        let missing = loaded.iter().filter(|(index, _)| !self.counted.contains_key(index));
        let (index, frame) = missing.min_by_key(|(index, _)| index.abs_diff(playhead))?;
        Some(Question { index: *index, frame: Arc::clone(frame), ruler })
    }

    fn take_up(&mut self, ruler: Ruler) {
        let same_field =
            self.ruler.as_ref().is_some_and(|old| old.field == ruler.field && old.scale == ruler.scale);
        if same_field && !self.is_settled() {
            return;
        }
        self.before = self.sum().filter(|_| same_field);
        self.counted.clear();
        self.ruler = Some(ruler);
    }

    /// Whether enough frames are counted to stand for all.
    fn is_settled(&self) -> bool {
        2 * self.counted.len() >= self.loaded
    }

    /// Takes in what was counted, unless another ruler counts by now.
    pub fn take(&mut self, answer: Answer) {
        if self.ruler.as_ref() == Some(&answer.ruler) {
            self.counted.insert(answer.index, (answer.frame, answer.histogram));
            if self.is_settled() {
                self.before = None;
            }
        }
    }

    /// The histogram of the frames counted so far, and how many these are.
    pub fn histogram(&self) -> Option<(Histogram, usize)> {
        self.before.clone().or_else(|| self.sum())
    }

    fn sum(&self) -> Option<(Histogram, usize)> {
        let ruler = self.ruler.as_ref()?;
        let mut all = Histogram::empty(ruler.range, ruler.scale);
        let counted = self.counted.values().filter_map(|(_, histogram)| histogram.as_ref());
        let frames = counted.inspect(|histogram| all.add(histogram)).count();
        (frames > 0).then_some((all, frames))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Column, Field, Metadata};

    fn frame(values: &[f64]) -> Arc<Frame> {
        let positions = Column::new(3, vec![0.0; 3 * values.len()]).unwrap();
        let field = Field { name: "q".into(), column: Column::scalars(values.to_vec()) };
        Arc::new(Frame::new(positions, vec![field], Metadata::default()).unwrap())
    }

    fn ruler(high: f64) -> Ruler {
        Ruler { field: Some("q".into()), range: [0.0, high], scale: Scale::Linear }
    }

    /// Counts all that is missing; which frames these were, in their order.
    fn count(pool: &mut Pool, ruler: &Ruler, loaded: &[(usize, Arc<Frame>)], playhead: usize) -> Vec<usize> {
        let mut counted = Vec::new();
        while let Some(question) = pool.follow(ruler.clone(), loaded, playhead) {
            counted.push(question.index);
            pool.take(question.answer());
        }
        counted
    }

    /// Particles in all bars, and frames.
    fn known(pool: &Pool) -> Option<(u64, usize)> {
        pool.histogram().map(|(histogram, frames)| (histogram.bars.iter().sum(), frames))
    }

    #[test]
    fn a_frame_is_counted_once_and_leaves_with_its_bars() {
        let frames: Vec<(usize, Arc<Frame>)> =
            (0..5).map(|index| (index, frame(&vec![0.5; index + 1]))).collect();
        let mut pool = Pool::default();
        assert_eq!(known(&pool), None);
        assert_eq!(count(&mut pool, &ruler(1.0), &frames[..3], 2), [2, 1, 0]);
        assert_eq!(known(&pool), Some((6, 3)));
        // Playing adds a frame at one end and drops one at the other.
        assert_eq!(count(&mut pool, &ruler(1.0), &frames[1..4], 3), [3]);
        assert_eq!(known(&pool), Some((9, 3)));
        // One that was read again is another one.
        let again = [(1, frame(&[0.5; 10])), frames[2].clone()];
        assert_eq!(count(&mut pool, &ruler(1.0), &again, 2), [1]);
        assert_eq!(known(&pool), Some((13, 2)));
        assert_eq!(count(&mut pool, &ruler(1.0), &[], 2), [0; 0]);
        assert_eq!(known(&pool), None);
    }

    #[test]
    fn another_range_counts_anew_behind_what_was_known() {
        let frames: Vec<(usize, Arc<Frame>)> = (0..4).map(|index| (index, frame(&[0.5, 1.5]))).collect();
        let mut pool = Pool::default();
        count(&mut pool, &ruler(1.0), &frames, 0);
        let question = pool.follow(ruler(2.0), &frames, 0).unwrap();
        assert_eq!(known(&pool), Some((4, 4)), "what was known stands until half is counted");
        pool.take(question.answer());
        // Yet another one has to wait for that.
        let question = pool.follow(ruler(3.0), &frames, 0).unwrap();
        assert_eq!(question.ruler, ruler(2.0));
        pool.take(question.answer());
        assert_eq!(known(&pool), Some((4, 2)));
        let late = pool.follow(ruler(3.0), &frames, 0).unwrap();
        assert_eq!(late.ruler, ruler(3.0));
        // Another field cannot stand for this one.
        let other = Ruler { field: None, ..ruler(2.0) };
        assert!(pool.follow(other.clone(), &frames, 0).is_some());
        assert_eq!(known(&pool), None);
        pool.take(late.answer());
        assert_eq!(known(&pool), None, "an answer that comes too late counts for nothing");
        count(&mut pool, &other, &frames, 0);
        assert_eq!(known(&pool), Some((8, 4)));
    }

    #[test]
    fn frames_without_the_field_are_none_of_those_counted() {
        let frames = [(0, frame(&[0.5])), (1, frame(&[0.5]))];
        let missing = Ruler { field: Some("heat".into()), ..ruler(1.0) };
        let mut pool = Pool::default();
        assert_eq!(count(&mut pool, &missing, &frames, 0), [0, 1]);
        assert_eq!(known(&pool), None);
    }
}
