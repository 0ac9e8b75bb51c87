//! The thread's own side: picture after picture for the latest job.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering;
use std::sync::{Arc, mpsc};
use std::time::Instant;

use renderer::{
    CellMap, Gpu, GpuOptions, Picture, Progress, RenderError, Renderer, SamplingView, Scene, Stats, View,
};

use super::{Drawn, IDLE, Job, Looks, Report, Shown, Slot, without_background};
use crate::frames::Frame;
use crate::scene::SceneError;
use crate::viewer::Wake;
use crate::viewer::inspect::pointing::Shot;
use crate::viewer::inspect::probe::Probed;
use crate::viewer::picture::tone;
use crate::viewer::render_thread::budget::{Budget, Raise};
use crate::viewer::render_thread::pace::{DIVISORS, Pace};
use crate::viewer::render_thread::prepare::{Facts, Preparation};

/// Milliseconds that a picture may take while something moves: on a GPU, and on the CPU, where
/// half the speed is worth twice the pixels.
const BUDGETS: [f64; 2] = [50.0, 100.0];
/// What is told of a panic.
const UNFORESEEN: &str = "drawing failed in an unforeseen way: change the view to try again";
/// A moving picture that takes this many times its budget gives way to a newer one.
const PATIENCE: f64 = 8.0;

pub(super) struct Worker {
    slot: Arc<Slot>,
    sender: mpsc::Sender<Report>,
    wake: Wake,
    options: GpuOptions,
    renderer: Option<Renderer>,
    /// Whether the device is a program on the CPU.
    software: bool,
    pace: Pace,
    raise: Raise,
    /// Milliseconds that making particles ready took, the last time.
    preparing: f64,
    preparation: Preparation,
    /// The last picture that was finished, for a change of background alone, and for going on
    /// where a moving picture left off.
    last: Option<Last>,
}

struct Last {
    frame: Arc<Frame>,
    /// What was asked for, without its background.
    asked: View,
    /// The same as it was drawn: while something moves, with a larger tolerance, perhaps.
    view: View,
    divisor: u32,
    scene: Arc<Scene>,
    picture: Picture,
    facts: Facts,
    cells: Option<Arc<CellMap>>,
    probed: Option<Arc<Probed>>,
}

impl Last {
    fn shot(&self, index: usize) -> Shot {
        Shot {
            frame: Arc::clone(&self.frame),
            index,
            scene: Arc::clone(&self.scene),
            size: [self.view.image.width, self.view.image.height],
            quantity: self.view.quantity.clone(),
        }
    }

    /// Whether it is what the job asks for: while something moves, with whatever tolerance it was drawn.
    fn serves(&self, job: &Job, asked: &View) -> bool {
        let same = self.view == *asked || (job.moving && self.asked == *asked);
        same && Arc::ptr_eq(&self.frame, &job.frame)
    }
}

/// How a pass ended that brought no picture.
enum Stop {
    Cancelled,
    Failed(String),
}

impl Worker {
    pub(super) fn new(
        slot: Arc<Slot>,
        sender: mpsc::Sender<Report>,
        wake: Wake,
        options: GpuOptions,
    ) -> Worker {
        Worker {
            slot,
            sender,
            wake,
            options,
            renderer: None,
            software: true,
            pace: Pace::new(BUDGETS[1], true),
            raise: Raise::default(),
            preparing: 0.0,
            preparation: Preparation::default(),
            last: None,
        }
    }

    pub(super) fn run(mut self) {
        // Opened before the first job comes: the shaders compile while the first frame is read.
        if let Err(text) = self.open() {
            self.report(Report::NoDevice(text));
        }
        while let Some(job) = self.slot.next() {
            let result = catch_unwind(AssertUnwindSafe(|| self.serve(&job))).unwrap_or_else(|_| {
                // Whatever state they are in, the next picture gets new ones.
                (self.renderer, self.preparation, self.last) = (None, Preparation::default(), None);
                Err(Stop::Failed(UNFORESEEN.into()))
            });
            self.slot.share.store(IDLE, Ordering::Relaxed);
            if let Err(Stop::Failed(text)) = result {
                self.report(Report::Failed { index: job.index, numbering: job.numbering, text });
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
        (self.software, self.pace) = (software, Pace::new(BUDGETS[usize::from(software)], software));
        self.report(Report::Adapter { name, software });
        Ok(())
    }

    /// Draws what the job asks for, pass by pass.
    fn serve(&mut self, job: &Job) -> Result<(), Stop> {
        self.pace.set_budget(self.time(&job.budget));
        let asked = without_background(&job.view);
        let stale = self.last.take_if(|last| !last.serves(job, &asked));
        let (mut divisor, mut first) = match (self.last.as_ref().map(|last| last.divisor), stale) {
            (Some(divisor), _) if divisor == 1 || job.moving => {
                return self.tell(job, None);
            }
            (Some(divisor), _) => {
                // The background may be another one, or what is wanted beside the picture.
                self.tell(job, None)?;
                (Pace::finer(divisor), false)
            }
            (None, _) if job.moving => (self.pace.moving(), true),
            // Only its tolerance was another one for a while: it is refined like any other.
            (None, Some(last)) if last.asked == asked && last.divisor > 1 => {
                (Pace::finer(last.divisor), false)
            }
            // In the size that it had, its grid and its bounds serve again.
            (None, Some(last)) if differs_in_sampling_alone(&last, job) => (last.divisor, true),
            (None, _) => (self.pace.resting(), true),
        };
        let mut view = asked;
        if job.moving {
            view.sampling.tolerance = self.raise.tolerance(view.sampling.tolerance, &job.budget);
        }
        loop {
            self.pass(job, &view, divisor, first)?;
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

    /// Milliseconds that drawing a moving picture may take.
    fn time(&self, budget: &Budget) -> f64 {
        match budget.on {
            true => (budget.milliseconds - self.preparing).max(0.25 * budget.milliseconds),
            false => BUDGETS[usize::from(self.software)],
        }
    }

    /// Draws one picture of `view` at 1/`divisor` and reports it.
    fn pass(&mut self, job: &Job, view: &View, divisor: u32, first: bool) -> Result<(), Stop> {
        let asked = Instant::now();
        let (scene, facts) = self.scene(&job.frame, view, divisor)?;
        let begun = Instant::now();
        self.preparing = (begun - asked).as_secs_f64() * 1e3;
        let (picture, cells) = self.attempt(&scene, divisor, first, |renderer, progress| {
            if job.looks.cells {
                let (picture, cells) = renderer.render_with_cells(&scene, progress)?;
                return Ok((picture, Some(Arc::new(cells))));
            }
            Ok((renderer.render(&scene, progress)?, None))
        })?;
        let pixels = f64::from(view.image.width) * f64::from(view.image.height);
        self.pace.learn(pixels, divisor, begun.elapsed().as_secs_f64() * 1e3);
        self.weigh(job, &picture.stats);
        let drawn = Drawn {
            moving: job.moving,
            preparing: self.preparing,
            milliseconds: asked.elapsed().as_secs_f64() * 1e3,
        };
        let (frame, asked, view) = (Arc::clone(&job.frame), without_background(&job.view), view.clone());
        let scene = Arc::new(scene);
        self.last = Some(Last { frame, asked, view, divisor, scene, picture, facts, cells, probed: None });
        self.tell(job, Some(drawn))
    }

    /// Learns from the picture that was just drawn which tolerance moving ones should have.
    fn weigh(&mut self, job: &Job, stats: &Stats) {
        let Some(drawing) = self.pace.predict(1) else { return };
        let full_size = drawing + self.preparing;
        match job.moving {
            true => self.raise.learn(full_size, job.view.sampling.tolerance, &job.budget),
            // One on a grid that was there already took less than those of moving pictures will.
            false if stats.milliseconds.grid > 0.0 => self.raise.rest(full_size),
            false => {}
        }
    }

    /// Reports the last picture, with what is wanted beside it; without that where it was not found out.
    fn tell(&mut self, job: &Job, drawn: Option<Drawn>) -> Result<(), Stop> {
        let looked = self.look(job);
        self.show(job, drawn);
        looked
    }

    /// The scene that `view` shows of `frame`, at 1/`divisor` of its size.
    fn scene(&mut self, frame: &Arc<Frame>, view: &View, divisor: u32) -> Result<(Scene, Facts), Stop> {
        let mut smaller = view.clone();
        smaller.image.width = view.image.width.div_ceil(divisor);
        smaller.image.height = view.image.height.div_ceil(divisor);
        self.preparation.scene(frame, &smaller).map_err(|error| Stop::Failed(with_advice(&error)))
    }

    /// Finds out what is wanted beside the last picture and not known yet.
    fn look(&mut self, job: &Job) -> Result<(), Stop> {
        let Some(last) = &self.last else { return Ok(()) };
        let Looks { cells, probe, .. } = job.looks;
        let divisor = last.divisor;
        let needs_cells = cells && last.cells.is_none();
        let probe = probe.filter(|pixel| last.probed.as_ref().is_none_or(|known| known.asked != *pixel));
        if !needs_cells && probe.is_none() {
            return Ok(());
        }
        let (frame, view) = (Arc::clone(&last.frame), last.view.clone());
        let (scene, _) = self.scene(&frame, &view, divisor)?;
        if needs_cells {
            let look = |renderer: &mut Renderer, progress: &mut Progress| {
                renderer.render_with_cells(&scene, progress)
            };
            let (_, cells) = self.attempt(&scene, divisor, false, look)?;
            let cells = Arc::new(cells);
            self.last.iter_mut().for_each(|last| last.cells = Some(Arc::clone(&cells)));
        }
        if let Some(asked) = probe {
            let look = |renderer: &mut Renderer, progress: &mut Progress| {
                Probed::find(renderer, &scene, asked, divisor, progress)
            };
            let probed = self.attempt(&scene, divisor, false, look)?.map(Arc::new);
            self.last.iter_mut().for_each(|last| last.probed.clone_from(&probed));
        }
        Ok(())
    }

    /// Reports the last picture, over the background of `job`.
    fn show(&self, job: &Job, drawn: Option<Drawn>) {
        let Some(last) = &self.last else { return };
        let Last { divisor, picture, facts, asked, view, cells, probed, .. } = last;
        let shown = Shown {
            index: job.index,
            numbering: job.numbering,
            width: picture.width,
            height: picture.height,
            pixels: tone::to_screen(&picture.pixels, job.view.image.background),
            full: [view.image.width, view.image.height],
            divisor: *divisor,
            sampling: view.sampling,
            wished: asked.sampling.tolerance,
            stats: picture.stats.clone(),
            facts: facts.clone(),
            drawn,
            cells: cells.clone().filter(|_| job.looks.cells),
            probed: probed.clone().filter(|probed| job.looks.probe == Some(probed.asked)),
            shot: job.looks.shot.then(|| last.shot(job.index)),
        };
        self.report(Report::Picture(Box::new(shown)));
    }

    /// Does `work` on `scene`; opens the device again and tries once more where it was lost.
    fn attempt<T>(
        &mut self,
        scene: &Scene,
        divisor: u32,
        first: bool,
        work: impl Fn(&mut Renderer, &mut Progress) -> Result<T, RenderError>,
    ) -> Result<T, Stop> {
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
                let coarsest = divisor == DIVISORS[DIVISORS.len() - 1];
                // The first picture of a job shows that something happens, so it is finished,
                // unless it is late and there is a coarser one.
                let keep = first && (!late || coarsest);
                match slot.stopped() || (!keep && slot.newer()) {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            };
            let result = catch_unwind(AssertUnwindSafe(|| work(renderer, &mut progress)));
            match result {
                Ok(Ok(found)) => return Ok(found),
                Ok(Err(RenderError::Cancelled)) => {
                    self.give_up(begun, divisor, scene);
                    return Err(Stop::Cancelled);
                }
                Ok(Err(RenderError::DeviceLost(why))) if attempt == 0 => self.recover(&why)?,
                Ok(Err(error)) => {
                    if matches!(error, RenderError::OutOfMemory(_) | RenderError::Device(_)) {
                        // What it holds of the device may be what the next picture lacks.
                        self.renderer = None;
                    }
                    return Err(Stop::Failed(error.to_string()));
                }
                Err(_) => {
                    // Whatever state the renderer is in, the next picture gets a new one.
                    self.renderer = None;
                    return Err(Stop::Failed(UNFORESEEN.into()));
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

/// Says what is wrong with a scene, and what to do about it where that is a field.
fn with_advice(error: &anyhow::Error) -> String {
    let text = format!("{error:#}");
    match error.downcast_ref() {
        Some(SceneError::NoSuchField { .. } | SceneError::NoSuchComponent { .. }) => {
            format!("{text}: choose another under Quantity")
        }
        _ => text,
    }
}

/// Whether a picture like `last`, sampled in another way, is what `job` asks for.
fn differs_in_sampling_alone(last: &Last, job: &Job) -> bool {
    let mut view = last.view.clone();
    view.sampling = SamplingView { rate: view.sampling.rate, ..job.view.sampling };
    Arc::ptr_eq(&last.frame, &job.frame) && view == without_background(&job.view)
}

#[cfg(test)]
#[path = "worker_tests.rs"]
mod tests;
