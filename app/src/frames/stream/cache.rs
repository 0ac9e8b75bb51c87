//! Which frames are kept and which is read next: those that lie nearest to the playhead, within the budget.

use std::sync::Arc;

use super::{BEHIND, SlotState, State};
use crate::frames::Frame;

impl State {
    /// How far frame `index` is from being shown: 0 at the playhead, and no two frames are equally
    /// far. Sequences are played in a loop, so the distance goes round the ends.
    fn distance(&self, index: usize) -> usize {
        let count = self.slots.len();
        let forward = (index + count - self.playhead) % count;
        let ahead = if self.backwards { (count - forward) % count } else { forward };
        // Even ahead, odd behind: with equals, two frames could push each other out for ever.
        (2 * ahead).min(2 * BEHIND * (count - ahead) - 1)
    }

    pub fn move_to(&mut self, index: usize) {
        let (from, last) = (self.playhead, self.slots.len().saturating_sub(1));
        if index == from {
            return;
        }
        // A loop that starts again goes on in its direction.
        self.backwards = match (from, index) {
            (from, 0) if from == last => false,
            (0, index) if index == last => true,
            _ => index < from,
        };
        self.playhead = index;
        // What was the current frame now counts.
        if self.held(from) > self.budget {
            self.slots[from].state = SlotState::Empty;
        }
        self.evict(0);
    }

    /// Bytes that frame `index` holds in the cache.
    pub fn held(&self, index: usize) -> usize {
        match &self.slots[index].state {
            SlotState::Ready(_) => self.slots[index].bytes.unwrap_or(0),
            _ => 0,
        }
    }

    /// Bytes that frame `index` takes once it is read: known, or as many as the nearest frame that
    /// was read. Frames larger than the budget are the exception as long as others are not.
    fn expected(&self, index: usize) -> Option<usize> {
        if let Some(bytes) = self.slots[index].bytes {
            return Some(bytes);
        }
        let known = self.slots.iter().enumerate().filter_map(|(i, slot)| Some((i, slot.bytes?)));
        known.min_by_key(|(i, bytes)| (*bytes > self.budget, i.abs_diff(index))).map(|(_, bytes)| bytes)
    }

    /// The frame to read next, if there is room for one more.
    pub fn choose(&self) -> Option<usize> {
        let mut order: Vec<usize> = (0..self.slots.len()).collect();
        order.sort_unstable_by_key(|&index| self.distance(index));
        let mut taken = 0_usize;
        for index in order {
            let current = index == self.playhead;
            match &self.slots[index].state {
                SlotState::Empty if current => return Some(index),
                SlotState::Empty => {
                    // Without any frame read, nobody knows how large they are.
                    let size = self.expected(index)?;
                    if taken.saturating_add(size) <= self.budget {
                        return Some(index);
                    }
                    // One frame larger than the whole budget must not keep the others out.
                    if self.slots[index].bytes.is_none_or(|bytes| bytes <= self.budget) {
                        return None;
                    }
                }
                _ if current => {}
                SlotState::Loading(_) => taken += self.expected(index).unwrap_or(0),
                _ => taken += self.held(index),
            }
        }
        None
    }

    /// Drops frames, the farthest first, until `size` more bytes fit beside the others.
    pub fn evict(&mut self, size: usize) {
        let others = |state: &State| -> Vec<usize> {
            (0..state.slots.len()).filter(|&i| i != state.playhead && state.held(i) > 0).collect()
        };
        let mut order = others(self);
        order.sort_unstable_by_key(|&index| self.distance(index));
        let mut held: usize = order.iter().map(|&index| self.held(index)).sum();
        while held + size > self.budget {
            let Some(index) = order.pop() else { return };
            held -= self.held(index);
            self.slots[index].state = SlotState::Empty;
        }
    }

    /// Whether `size` bytes for frame `index` fit beside all that lies nearer to the playhead.
    fn fits(&self, index: usize, size: usize) -> bool {
        let nearer = (0..self.slots.len())
            .filter(|&other| other != self.playhead && self.distance(other) < self.distance(index));
        nearer.map(|other| self.held(other)).sum::<usize>() + size <= self.budget
    }

    pub fn finish(&mut self, index: usize, frame: anyhow::Result<Arc<Frame>>) {
        let frame = match frame {
            Ok(frame) => frame,
            Err(error) => {
                self.slots[index].state = SlotState::Failed(format!("{error:#}").into());
                return;
            }
        };
        let bytes = frame.bytes();
        self.slots[index].bytes = Some(bytes);
        self.slots[index].state = SlotState::Empty;
        if index != self.playhead {
            // The playhead may have gone elsewhere since the reading began.
            if !self.fits(index, bytes) {
                return;
            }
            self.evict(bytes);
        }
        self.slots[index].state = SlotState::Ready(frame);
    }
}
