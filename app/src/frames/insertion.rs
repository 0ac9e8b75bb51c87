//! New frames between known ones, and which numbers the known ones have afterwards.

/// Places that new frames take in a sequence.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Insertion {
    /// Number of frames that were known.
    known: usize,
    /// Of the new ones among all, ascending.
    places: Vec<usize>,
}

impl Insertion {
    /// Of new frames at `places` among all, which ascend, in a sequence of `known` frames.
    pub fn new(known: usize, places: Vec<usize>) -> Insertion {
        Insertion { known, places }
    }

    /// Whether all of them come behind the known ones, so that none has another number than before.
    pub fn is_behind(&self) -> bool {
        self.places.first().is_none_or(|place| *place >= self.known)
    }

    /// The number that frame `index` has afterwards. One past the end, which is still to come, is only
    /// moved by what goes between known frames.
    pub fn moved(&self, index: usize) -> usize {
        let between = self.places.iter().enumerate().filter(|(before, place)| **place < self.known + before);
        between.fold(index, |index, (_, place)| index + usize::from(*place <= index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_frames_stay_the_same_frames() {
        for (known, added) in
            [(4, vec![0]), (4, vec![1, 2, 4]), (3, vec![0, 3, 4, 6]), (2, vec![2, 3]), (0, vec![0])]
        {
            let mut frames: Vec<Option<usize>> = (0..known).map(Some).collect();
            added.iter().for_each(|place| frames.insert(*place, None));
            let insertion = Insertion::new(known, added.clone());
            for frame in 0..known {
                assert_eq!(frames[insertion.moved(frame)], Some(frame), "{frame} of {known} with {added:?}");
            }
            assert_eq!(insertion.is_behind(), (0..known).all(|frame| insertion.moved(frame) == frame));
        }
    }

    #[test]
    fn a_number_that_is_still_to_come_waits_for_its_frame() {
        assert_eq!(Insertion::new(10, vec![10, 11]).moved(20), 20);
        assert_eq!(Insertion::new(10, vec![3, 11]).moved(20), 21);
    }
}
