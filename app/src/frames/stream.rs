//! Frames read ahead in the background, in bounded memory.
//!
//! Two threads read what lies nearest to the playhead; frames in the direction of play are nearer
//! than those behind it. Nothing here waits for a disk except the threads themselves and
//! [`FrameStream::wait`].

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread;

use super::{Cancelled, Frame, Loading};

/// Where one frame comes from.
pub trait FrameSource: Send + Sync {
    /// Reads the frame; called from a background thread, and again after the frame was dropped from
    /// the cache. Tells `loading` how far it is. An error is final.
    fn load(&self, loading: &Arc<Loading>) -> anyhow::Result<Frame>;
}

/// What is known of a frame.
#[derive(Clone, Debug)]
pub enum FrameState {
    /// Not asked for yet, or dropped again to make room.
    NotLoaded,
    Loading,
    Ready(Arc<Frame>),
    /// Why the frame cannot be read.
    Failed(Arc<str>),
}

/// One cell of the timeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cached {
    No,
    Loading,
    Yes,
    Failed,
}

/// A sequence of frames with a playhead, a cache round it, and threads that fill the cache.
///
/// The frames held, apart from the one under the playhead, never take more bytes than the budget.
/// Dropping the stream tells the threads to stop; they end after the frame they are reading, and
/// the wake callback is not called after the drop.
pub struct FrameStream {
    shared: Arc<Shared>,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    wake: Box<dyn Fn() + Send + Sync>,
}

struct State {
    /// One a slot.
    sources: Vec<Arc<dyn FrameSource>>,
    slots: Vec<Slot>,
    playhead: usize,
    backwards: bool,
    budget: usize,
    stopped: bool,
}

#[derive(Default)]
struct Slot {
    state: SlotState,
    /// Bytes that the frame takes, once it was read.
    bytes: Option<usize>,
}

#[derive(Default)]
enum SlotState {
    #[default]
    Empty,
    Loading(Arc<Loading>),
    Ready(Arc<Frame>),
    Failed(Arc<str>),
}

const THREADS: usize = 2;
/// A frame behind the playhead counts as this many times farther than one ahead.
const BEHIND: usize = 3;

impl FrameStream {
    /// A stream over `sources` that holds up to `budget` bytes beside the current frame. `wake` is
    /// called from a background thread whenever a frame became ready or failed. Starts reading at
    /// frame 0.
    pub fn new(
        sources: Vec<Arc<dyn FrameSource>>,
        budget: usize,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> FrameStream {
        let slots = sources.iter().map(|_| Slot::default()).collect();
        let state = State { sources, slots, playhead: 0, backwards: false, budget, stopped: false };
        let shared =
            Arc::new(Shared { state: Mutex::new(state), changed: Condvar::new(), wake: Box::new(wake) });
        for _ in 0..THREADS {
            let shared = Arc::clone(&shared);
            thread::spawn(move || shared.work());
        }
        FrameStream { shared }
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.shared.lock().sources.len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Puts frames behind the last one.
    pub fn append(&self, sources: Vec<Arc<dyn FrameSource>>) {
        let mut state = self.shared.lock();
        state.slots.extend(sources.iter().map(|_| Slot::default()));
        state.sources.extend(sources);
        drop(state);
        self.shared.changed.notify_all();
    }

    /// Reads frame `index` again, where it was read or is being read, or could not be.
    pub fn reload(&self, index: usize) {
        let mut state = self.shared.lock();
        let Some(slot) = state.slots.get_mut(index) else { return };
        if let SlotState::Loading(loading) = &slot.state {
            loading.cancel();
        }
        *slot = Slot::default();
        drop(state);
        self.shared.changed.notify_all();
    }

    /// Moves the playhead; never waits. An index past the end is the last frame.
    pub fn request(&self, index: usize) {
        let mut state = self.shared.lock();
        let last = state.slots.len().saturating_sub(1);
        state.move_to(index.min(last));
        drop(state);
        self.shared.changed.notify_all();
    }

    /// Bytes read of frame `index` and bytes in all, while it is read.
    pub fn progress(&self, index: usize) -> Option<[u64; 2]> {
        match &self.shared.lock().slots.get(index)?.state {
            SlotState::Loading(loading) => Some(loading.bytes()),
            _ => None,
        }
    }

    /// Ends the reading of frame `index`, which counts as failed.
    pub fn cancel(&self, index: usize) {
        let mut state = self.shared.lock();
        let Some(slot) = state.slots.get_mut(index) else { return };
        if let SlotState::Loading(loading) = &slot.state {
            loading.cancel();
            slot.state = SlotState::Failed(Cancelled.to_string().into());
        }
        drop(state);
        self.shared.changed.notify_all();
        (self.shared.wake)();
    }

    /// Holds no more than `budget` bytes beside the current frame from now on.
    pub fn limit(&self, budget: usize) {
        let mut state = self.shared.lock();
        state.budget = budget;
        state.evict(0);
        drop(state);
        self.shared.changed.notify_all();
    }

    /// What is known of frame `index` now; never waits. Past the end nothing is ever loaded.
    pub fn get(&self, index: usize) -> FrameState {
        self.shared.lock().slots.get(index).map_or(FrameState::NotLoaded, |slot| match &slot.state {
            SlotState::Empty => FrameState::NotLoaded,
            SlotState::Loading(_) => FrameState::Loading,
            SlotState::Ready(frame) => FrameState::Ready(Arc::clone(frame)),
            SlotState::Failed(why) => FrameState::Failed(Arc::clone(why)),
        })
    }

    /// Moves the playhead to frame `index` and waits for it; the error says why it cannot be read.
    ///
    /// # Panics
    /// Past the end.
    pub fn wait(&self, index: usize) -> Result<Arc<Frame>, Arc<str>> {
        assert!(index < self.len(), "frame {index} of {}", self.len());
        self.request(index);
        let mut state = self.shared.lock();
        loop {
            match &state.slots[index].state {
                SlotState::Ready(frame) => return Ok(Arc::clone(frame)),
                SlotState::Failed(why) => return Err(Arc::clone(why)),
                SlotState::Empty | SlotState::Loading(_) => state = self.shared.sleep(state),
            }
        }
    }

    /// One cell for each frame, for the timeline.
    pub fn cached(&self) -> Vec<Cached> {
        let cell = |slot: &Slot| match slot.state {
            SlotState::Empty => Cached::No,
            SlotState::Loading(_) => Cached::Loading,
            SlotState::Ready(_) => Cached::Yes,
            SlotState::Failed(_) => Cached::Failed,
        };
        self.shared.lock().slots.iter().map(cell).collect()
    }

    /// Bytes that frames may take beside the current one.
    pub fn budget(&self) -> usize {
        self.shared.lock().budget
    }

    /// Bytes that the cached frames take, the current one counted in.
    pub fn bytes(&self) -> usize {
        let state = self.shared.lock();
        (0..state.slots.len()).map(|index| state.held(index)).sum()
    }
}

impl Drop for FrameStream {
    fn drop(&mut self) {
        let mut state = self.shared.lock();
        state.stopped = true;
        for slot in &state.slots {
            if let SlotState::Loading(loading) = &slot.state {
                loading.cancel();
            }
        }
        // The threads may go on for a while; what the cache holds is free at once.
        state.slots.clear();
        drop(state);
        self.shared.changed.notify_all();
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        // Every change of the state is whole before anything can panic, so a poisoned lock is sound.
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn sleep<'a>(&self, state: MutexGuard<'a, State>) -> MutexGuard<'a, State> {
        self.changed.wait(state).unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn work(&self) {
        while let Some((index, source, loading)) = self.next() {
            // A reader that panics must not take the thread, and with it all later frames, along.
            let frame = catch_unwind(AssertUnwindSafe(|| source.load(&loading)))
                .unwrap_or_else(|_| Err(anyhow::anyhow!("reading it failed in an unforeseen way")));
            let mut state = self.lock();
            if state.stopped {
                return;
            }
            // Whoever cancelled it does not wait for the reader to notice.
            if !loading.is_cancelled() {
                state.finish(index, frame);
            }
            drop(state);
            self.changed.notify_all();
            (self.wake)();
        }
    }

    /// Waits for a frame worth reading; `None` once the stream is gone.
    fn next(&self) -> Option<(usize, Arc<dyn FrameSource>, Arc<Loading>)> {
        let mut state = self.lock();
        loop {
            if state.stopped {
                return None;
            }
            if let Some(index) = state.choose() {
                let loading = Arc::new(Loading::default());
                state.slots[index].state = SlotState::Loading(Arc::clone(&loading));
                return Some((index, Arc::clone(&state.sources[index]), loading));
            }
            state = self.sleep(state);
        }
    }
}

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

    fn move_to(&mut self, index: usize) {
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
    fn held(&self, index: usize) -> usize {
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
    fn choose(&self) -> Option<usize> {
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
    fn evict(&mut self, size: usize) {
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

    fn finish(&mut self, index: usize, frame: anyhow::Result<Frame>) {
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
        self.slots[index].state = SlotState::Ready(Arc::new(frame));
    }
}

#[cfg(test)]
#[path = "stream_tests.rs"]
mod tests;
