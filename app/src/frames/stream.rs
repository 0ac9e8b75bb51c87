//! Frames read ahead in the background, in bounded memory.
//!
//! Two threads read what lies nearest to the playhead; frames in the direction of play are nearer
//! than those behind it. Nothing here waits for a disk except the threads themselves and
//! [`FrameStream::wait`].

mod cache;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread;

use super::{Cancelled, Frame, Loading};

/// Where one frame comes from.
pub trait FrameSource: Send + Sync {
    /// Reads the frame; called from a background thread, and again after the frame was dropped from
    /// the cache. Tells `loading` how far it is. An error is final.
    fn load(&self, loading: &Arc<Loading>) -> anyhow::Result<Arc<Frame>>;
}

/// A frame that is in memory already.
impl FrameSource for Arc<Frame> {
    fn load(&self, _: &Arc<Loading>) -> anyhow::Result<Arc<Frame>> {
        Ok(Arc::clone(self))
    }
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

    /// Puts new frames in, each at the place that it has from then on, which ascend. The playhead stays at its
    /// frame.
    pub fn insert(&self, added: impl Iterator<Item = (usize, Arc<dyn FrameSource>)>) {
        let mut state = self.shared.lock();
        for (place, source) in added {
            let place = place.min(state.slots.len());
            state.playhead += usize::from(place < state.slots.len() && place <= state.playhead);
            state.sources.insert(place, source);
            state.slots.insert(place, Slot::default());
        }
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

    /// The frames in memory and their places, in ascending order.
    pub fn loaded(&self) -> Vec<(usize, Arc<Frame>)> {
        let ready = |(index, slot): (usize, &Slot)| match &slot.state {
            SlotState::Ready(frame) => Some((index, Arc::clone(frame))),
            _ => None,
        };
        self.shared.lock().slots.iter().enumerate().filter_map(ready).collect()
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
        while let Some((source, loading)) = self.next() {
            // A reader that panics must not take the thread, and with it all later frames, along.
            let frame = catch_unwind(AssertUnwindSafe(|| source.load(&loading)))
                .unwrap_or_else(|_| Err(anyhow::anyhow!("reading it failed in an unforeseen way")));
            let mut state = self.lock();
            if state.stopped {
                return;
            }
            // It may have another place by now; whoever cancelled it does not wait for the reader to notice.
            let is_its =
                |slot: &Slot| matches!(&slot.state, SlotState::Loading(of) if Arc::ptr_eq(of, &loading));
            if let Some(index) = state.slots.iter().position(is_its) {
                state.finish(index, frame);
            }
            drop(state);
            self.changed.notify_all();
            (self.wake)();
        }
    }

    /// Waits for a frame worth reading; `None` once the stream is gone.
    fn next(&self) -> Option<(Arc<dyn FrameSource>, Arc<Loading>)> {
        let mut state = self.lock();
        loop {
            if state.stopped {
                return None;
            }
            if let Some(index) = state.choose() {
                let loading = Arc::new(Loading::default());
                state.slots[index].state = SlotState::Loading(Arc::clone(&loading));
                return Some((Arc::clone(&state.sources[index]), loading));
            }
            state = self.sleep(state);
        }
    }
}

#[cfg(test)]
#[path = "stream_tests.rs"]
mod tests;
