//! A thread with a device of its own that turns the latest wish into pictures.
//!
//! The window's queue is never blocked by a long cast: the two share nothing but a slot for the
//! latest job and a channel of reports. While something moves, one picture is drawn for each job,
//! coarse enough to be there in time; at rest, pictures follow one another up to full size. Work
//! that nobody waits for any more is cancelled.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, mpsc};
use std::thread::JoinHandle;
use std::time::Instant;

use renderer::{Gpu, GpuOptions, Picture, RenderError, Renderer, SamplingView, Scene, Stats, View};

use crate::frames::Frame;

use super::Wake;
use super::pace::Pace;
use super::prepare::{Facts, Preparation};
use super::tone;

/// Milliseconds that a picture may take while something moves: on a GPU, and on the CPU, where
/// half the speed is worth twice the pixels.
const BUDGETS: [f64; 2] = [50.0, 100.0];
/// A moving picture that takes this many times its budget gives way to a newer one.
const PATIENCE: f64 = 8.0;

/// A wish for a picture.
#[derive(Clone)]
pub struct Job {
    pub frame: Arc<Frame>,
    /// Which frame of the sequence it is.
    pub index: usize,
    /// Its image size is the full size.
    pub view: View,
    /// Whether another job will follow soon: one quick picture is enough.
    pub moving: bool,
}

/// A picture for the screen.
pub struct Shown {
    pub index: usize,
    pub width: u32,
    pub height: u32,
    /// Opaque sRGB, row 0 on top.
    pub pixels: Vec<[u8; 4]>,
    /// Size at full resolution, and what it was divided by.
    pub full: [u32; 2],
    pub divisor: u32,
    pub sampling: SamplingView,
    pub stats: Stats,
    pub facts: Facts,
}

/// What the thread has to tell.
pub enum Report {
    /// A device is open.
    Adapter {
        name: String,
        software: bool,
    },
    Picture(Box<Shown>),
    /// Why there is no picture of this frame.
    Failed {
        index: usize,
        text: String,
    },
    /// The device was lost and opened again.
    Recovered(String),
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

struct Worker {
    slot: Arc<Slot>,
    sender: mpsc::Sender<Report>,
    wake: Wake,
    options: GpuOptions,
    renderer: Option<Renderer>,
    pace: Pace,
    preparation: Preparation,
    /// The last picture that was finished, for a change of background alone, and for going on
    /// where a moving picture left off.
    last: Option<Last>,
}

struct Last {
    frame: Arc<Frame>,
    /// Without its background.
    view: View,
    divisor: u32,
    picture: Picture,
    facts: Facts,
}

/// How a pass ended that brought no picture.
enum Stop {
    Cancelled,
    Failed(String),
}

impl Worker {
    fn new(slot: Arc<Slot>, sender: mpsc::Sender<Report>, wake: Wake, options: GpuOptions) -> Worker {
        Worker {
            slot,
            sender,
            wake,
            options,
            renderer: None,
            pace: Pace::new(BUDGETS[1], true),
            preparation: Preparation::default(),
            last: None,
        }
    }

    fn run(mut self) {
        // Opened before the first job comes: the shaders compile while the first frame is read.
        if let Err(text) = self.open() {
            self.report(Report::Failed { index: 0, text });
        }
        while let Some(job) = self.slot.next() {
            let result = self.serve(&job);
            self.slot.share.store(IDLE, Ordering::Relaxed);
            if let Err(Stop::Failed(text)) = result {
                self.report(Report::Failed { index: job.index, text });
            }
        }
    }

    fn report(&self, report: Report) {
        // The window is gone when nobody listens.
        let _ = self.sender.send(report);
        (self.wake)();
    }

    fn open(&mut self) -> Result<(), String> {
        let gpu = Gpu::new(&self.options).map_err(|error| error.to_string())?;
        let (name, software) = (gpu.adapter_name().to_owned(), gpu.is_software());
        self.renderer = Some(Renderer::new(gpu).map_err(|error| error.to_string())?);
        self.pace = Pace::new(BUDGETS[usize::from(software)], software);
        self.report(Report::Adapter { name, software });
        Ok(())
    }

    /// Draws what the job asks for, pass by pass.
    fn serve(&mut self, job: &Job) -> Result<(), Stop> {
        let key = without_background(&job.view);
        let stale = self.last.take_if(|last| !Arc::ptr_eq(&last.frame, &job.frame) || last.view != key);
        let mut divisor = match &self.last {
            Some(last) if last.divisor == 1 || job.moving => {
                self.show(job);
                return Ok(());
            }
            Some(last) => {
                let divisor = last.divisor;
                // The background may be another one.
                self.show(job);
                Pace::finer(divisor)
            }
            None if job.moving => self.pace.moving(),
            None => match stale.filter(|last| differs_in_sampling_alone(last, job)) {
                // In the size that it had, its grid and its bounds serve again.
                Some(last) => last.divisor,
                None => self.pace.resting(),
            },
        };
        let mut first = self.last.is_none();
        loop {
            self.pass(job, &key, divisor, first)?;
            if job.moving || divisor == 1 {
                return Ok(());
            }
            if self.slot.newer() {
                return Err(Stop::Cancelled);
            }
            first = false;
            divisor = Pace::finer(divisor);
        }
    }

    /// Draws one picture at 1/`divisor` and reports it.
    fn pass(&mut self, job: &Job, key: &View, divisor: u32, first: bool) -> Result<(), Stop> {
        let mut view = key.clone();
        view.image.width = key.image.width.div_ceil(divisor);
        view.image.height = key.image.height.div_ceil(divisor);
        let (scene, facts) =
            self.preparation.scene(&job.frame, &view).map_err(|error| Stop::Failed(format!("{error:#}")))?;
        let begun = Instant::now();
        let picture = self.render(&scene, divisor, first)?;
        let pixels = f64::from(key.image.width) * f64::from(key.image.height);
        self.pace.learn(pixels, divisor, begun.elapsed().as_secs_f64() * 1e3);
        self.last = Some(Last { frame: Arc::clone(&job.frame), view: key.clone(), divisor, picture, facts });
        self.show(job);
        Ok(())
    }

    /// Reports the last picture, over the background of `job`.
    fn show(&self, job: &Job) {
        let Some(Last { divisor, picture, facts, view, .. }) = &self.last else { return };
        let shown = Shown {
            index: job.index,
            width: picture.width,
            height: picture.height,
            pixels: tone::to_screen(&picture.pixels, job.view.image.background),
            full: [view.image.width, view.image.height],
            divisor: *divisor,
            sampling: view.sampling,
            stats: picture.stats.clone(),
            facts: facts.clone(),
        };
        self.report(Report::Picture(Box::new(shown)));
    }

    /// Renders; opens the device again and tries once more where it was lost.
    fn render(&mut self, scene: &Scene, divisor: u32, first: bool) -> Result<Picture, Stop> {
        for attempt in 0..2 {
            if self.renderer.is_none() {
                self.open().map_err(Stop::Failed)?;
            }
            let Some(renderer) = &mut self.renderer else { continue };
            let (slot, wake) = (&self.slot, &self.wake);
            let begun = Instant::now();
            let patience = PATIENCE * self.pace.budget();
            let mut told = 0;
            let mut progress = |share: f32| {
                let thousandths = (share.clamp(0.0, 1.0) * 1000.0) as u32;
                slot.share.store(thousandths, Ordering::Relaxed);
                if thousandths >= told + 20 {
                    told = thousandths;
                    wake();
                }
                let late = begun.elapsed().as_secs_f64() * 1e3 > patience;
                let coarsest = divisor == super::pace::DIVISORS[super::pace::DIVISORS.len() - 1];
                // The first picture of a job shows that something happens, so it is finished,
                // unless it is late and there is a coarser one.
                let keep = first && (!late || coarsest);
                match slot.stopped() || (!keep && slot.newer()) {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            };
            let result = catch_unwind(AssertUnwindSafe(|| renderer.render(scene, &mut progress)));
            match result {
                Ok(Ok(picture)) => return Ok(picture),
                Ok(Err(RenderError::Cancelled)) => {
                    self.give_up(begun, divisor, scene);
                    return Err(Stop::Cancelled);
                }
                Ok(Err(RenderError::DeviceLost(why))) if attempt == 0 => self.recover(&why)?,
                Ok(Err(error)) => return Err(Stop::Failed(error.to_string())),
                Err(_) => {
                    // Whatever state the renderer is in, the next picture gets a new one.
                    self.renderer = None;
                    let text = "drawing failed in an unforeseen way: change the view to try again";
                    return Err(Stop::Failed(text.into()));
                }
            }
        }
        Err(Stop::Failed("the graphics device was lost twice in a row: restart the program".into()))
    }

    fn recover(&mut self, why: &str) -> Result<(), Stop> {
        self.renderer = None;
        self.open().map_err(Stop::Failed)?;
        let text = format!("the graphics device was lost ({why}) and has been opened again");
        self.report(Report::Recovered(text));
        Ok(())
    }

    /// Learns from a cancelled picture that it would have taken longer than the time it had.
    fn give_up(&mut self, begun: Instant, divisor: u32, scene: &Scene) {
        let share = self.slot.share.load(Ordering::Relaxed).clamp(100, 1000);
        let estimate = begun.elapsed().as_secs_f64() * 1e3 * 1000.0 / f64::from(share);
        if estimate > PATIENCE * self.pace.budget() {
            let pixels = f64::from(scene.width) * f64::from(scene.height) * f64::from(divisor).powi(2);
            self.pace.learn(pixels, divisor, estimate);
        }
    }
}

/// The part of a view that the renderer sees.
pub fn without_background(view: &View) -> View {
    let mut view = view.clone();
    view.image.background = None;
    view
}

/// Whether a picture like `last`, sampled in another way, is what `job` asks for.
fn differs_in_sampling_alone(last: &Last, job: &Job) -> bool {
    let mut view = last.view.clone();
    view.sampling = SamplingView { rate: view.sampling.rate, ..job.view.sampling };
    Arc::ptr_eq(&last.frame, &job.frame) && view == without_background(&job.view)
}

#[cfg(test)]
#[path = "render_thread_tests.rs"]
mod tests;
