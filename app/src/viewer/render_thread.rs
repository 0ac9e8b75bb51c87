//! A thread with a device of its own that turns the latest wish into pictures.
//!
//! The window's queue is never blocked by a long cast: the two share nothing but a slot for the
//! latest job and a channel of reports. While something moves, one picture is drawn for each job,
//! coarse enough to be there in time; at rest, pictures follow one another up to full size. Work
//! that nobody waits for any more is cancelled.

pub mod budget;
pub mod pace;
pub mod prepare;
mod worker;

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, mpsc};
use std::thread::JoinHandle;

use renderer::{CellMap, GpuOptions, SamplingView, Stats, View};

use crate::frames::Frame;

use super::Wake;
use crate::viewer::inspect::pointing::Shot;
use crate::viewer::inspect::probe::Probed;
use crate::viewer::render_thread::budget::Budget;
use crate::viewer::render_thread::prepare::Facts;
use crate::viewer::session::Numbering;
use worker::Worker;

/// A wish for a picture.
#[derive(Clone)]
pub struct Job {
    pub frame: Arc<Frame>,
    /// Which frame it is, and what that number means.
    pub index: usize,
    pub numbering: Numbering,
    /// Its image size is the full size.
    pub view: View,
    /// Whether another job will follow soon: one quick picture is enough.
    pub moving: bool,
    /// What such a picture may take.
    pub budget: Budget,
    pub looks: Looks,
}

/// What is wanted beside the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Looks {
    /// What became of its cells.
    pub cells: bool,
    /// All about the bundle of this pixel of the full-size picture.
    pub probe: Option<[u32; 2]>,
    /// What it was drawn from.
    pub shot: bool,
}

/// A picture for the screen.
pub struct Shown {
    /// As in the job.
    pub index: usize,
    pub numbering: Numbering,
    pub width: u32,
    pub height: u32,
    /// Opaque sRGB, row 0 on top.
    pub pixels: Vec<[u8; 4]>,
    /// Size at full resolution, and what it was divided by.
    pub full: [u32; 2],
    pub divisor: u32,
    /// As it was drawn.
    pub sampling: SamplingView,
    /// The tolerance of the view; that of `sampling` may be larger, while something moves.
    pub wished: Option<f64>,
    pub stats: Stats,
    pub facts: Facts,
    /// Where it was drawn for this report: what that took, and whether something moved.
    pub drawn: Option<Drawn>,
    /// What was wanted beside it.
    pub cells: Option<Arc<CellMap>>,
    pub probed: Option<Arc<Probed>>,
    pub shot: Option<Shot>,
}

/// How a picture came about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// Whether another picture was to follow soon.
    pub moving: bool,
    /// Of making particles and quantity ready for the device.
    pub preparing: f64,
    /// From the wish to the picture, in milliseconds, all stages and the preparing counted in.
    pub milliseconds: f64,
}

/// What the thread has to tell.
pub enum Report {
    /// A device is open.
    Adapter {
        name: String,
        software: bool,
    },
    Picture(Box<Shown>),
    /// Why no device is open, before there was a job.
    NoDevice(String),
    /// Why there is no picture of this frame.
    Failed {
        index: usize,
        numbering: Numbering,
        text: String,
    },
    /// The device was lost and opened again.
    Recovered(String),
}

impl Report {
    /// The numbers of frames in it, and what they mean; `None` of a report that is about no frame.
    pub fn frames(&mut self) -> Option<(Numbering, Vec<&mut usize>)> {
        match self {
            Report::Picture(shown) => {
                let Shown { numbering, index, shot, .. } = &mut **shown;
                let shot = shot.iter_mut().map(|shot| &mut shot.index);
                Some((*numbering, shot.chain([index]).collect()))
            }
            Report::Failed { numbering, index, .. } => Some((*numbering, vec![index])),
            Report::Adapter { .. } | Report::NoDevice(_) | Report::Recovered(_) => None,
        }
    }
}

/// The window's end of the thread.
pub struct RenderThread {
    slot: Arc<Slot>,
    reports: mpsc::Receiver<Report>,
    thread: Option<JoinHandle<()>>,
}

/// The latest job, and how far the picture in work is.
#[derive(Default)]
struct Slot {
    state: Mutex<SlotState>,
    changed: Condvar,
    /// Thousandths of the picture in work; [`IDLE`] without one.
    share: AtomicU32,
}

#[derive(Default)]
struct SlotState {
    job: Option<Job>,
    stopped: bool,
}

const IDLE: u32 = u32::MAX;

impl RenderThread {
    pub fn spawn(options: GpuOptions, wake: Wake) -> RenderThread {
        let slot = Arc::new(Slot { share: AtomicU32::new(IDLE), ..Slot::default() });
        let (sender, reports) = mpsc::channel();
        let worker = Worker::new(Arc::clone(&slot), sender, wake, options);
        let thread = std::thread::Builder::new().name("render".into()).spawn(move || worker.run()).ok();
        RenderThread { slot, reports, thread }
    }

    /// Replaces whatever job is waiting.
    pub fn submit(&self, job: Job) {
        self.slot.lock().job = Some(job);
        self.slot.changed.notify_all();
    }

    /// What was reported since the last call.
    pub fn reports(&self) -> Vec<Report> {
        self.reports.try_iter().collect()
    }

    /// Share done of the picture in work, 0 to 1.
    pub fn share(&self) -> Option<f32> {
        let share = self.slot.share.load(Ordering::Relaxed);
        (share != IDLE).then_some(share as f32 / 1000.0)
    }
}

impl Drop for RenderThread {
    fn drop(&mut self) {
        self.slot.lock().stopped = true;
        self.slot.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            // Its device must be gone before the driver is unloaded. A panic was reported already.
            let _ = thread.join();
        }
    }
}

impl Slot {
    fn lock(&self) -> MutexGuard<'_, SlotState> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn next(&self) -> Option<Job> {
        let mut state = self.lock();
        loop {
            if state.stopped {
                return None;
            }
            if let Some(job) = state.job.take() {
                return Some(job);
            }
            state = self.changed.wait(state).unwrap_or_else(|poisoned| poisoned.into_inner());
        }
    }

    /// Whether the job in work is no longer the latest one.
    fn newer(&self) -> bool {
        let state = self.lock();
        state.stopped || state.job.is_some()
    }

    fn stopped(&self) -> bool {
        self.lock().stopped
    }
}

/// The part of a view that the renderer sees.
pub fn without_background(view: &View) -> View {
    let mut view = view.clone();
    view.image.background = None;
    view
}
