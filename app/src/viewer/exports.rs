//! Exports one after the other, in the background: the window goes on.

mod plan;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use renderer::{Gpu, GpuOptions};

use crate::export::{Listener, Stage, Summary};

use super::Wake;
use super::task::{Outcome, Task};

pub use plan::Plan;

/// How far an export is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    pub stage: Stage,
    /// Frames that are done, and how far the next one is.
    pub index: usize,
    pub share: f32,
    pub count: usize,
    /// Since when pictures are made.
    pub since: Option<Instant>,
}

impl Progress {
    /// Of this stage, 0 to 1.
    pub fn whole(&self) -> f32 {
        ((self.index as f32 + self.share) / self.count.max(1) as f32).clamp(0.0, 1.0)
    }

    /// How long it will take, if the pictures to come take as long as those that are done.
    pub fn left(&self, now: Instant) -> Option<Duration> {
        let gone = now.checked_duration_since(self.since?)?;
        let done = self.whole();
        (done > 0.02 && gone > Duration::from_secs(2)).then(|| gone.mul_f32((1.0 - done) / done))
    }
}

/// Follows an export for the window.
struct Watch {
    progress: Mutex<Progress>,
    lines: Mutex<Vec<String>>,
    cancelled: AtomicBool,
    wake: Wake,
}

impl Watch {
    fn new(wake: Wake) -> Arc<Watch> {
        let progress = Progress { stage: Stage::Survey, index: 0, share: 0.0, count: 1, since: None };
        Arc::new(Watch {
            progress: Mutex::new(progress),
            lines: Mutex::default(),
            cancelled: AtomicBool::new(false),
            wake,
        })
    }
}

/// Whatever held the lock wrote all of a value or nothing.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

impl Listener for Watch {
    fn show(&self, stage: Stage, index: usize, share: f32, count: usize) {
        let mut progress = lock(&self.progress);
        let before = *progress;
        let drawing = (stage == Stage::Pictures).then(Instant::now);
        *progress = Progress { stage, index, share, count, since: before.since.or(drawing) };
        // The window need not be drawn for what nobody sees.
        let step = |progress: &Progress| (progress.stage, (200.0 * progress.whole()) as u32, progress.index);
        if step(&before) != step(&progress) {
            (self.wake)();
        }
    }

    fn say(&self, line: &str) {
        lock(&self.lines).push(line.to_owned());
        (self.wake)();
    }

    fn wants_end(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

pub enum State {
    Waiting,
    Running,
    Done(Summary),
    Cancelled,
    Failed(String),
}

/// One of the exports.
pub struct Export {
    pub plan: Plan,
    pub state: State,
    task: Option<Task<Summary>>,
    watch: Arc<Watch>,
}

impl Export {
    pub fn progress(&self) -> Progress {
        *lock(&self.watch.progress)
    }

    /// Whether there is still something to do.
    pub fn is_pending(&self) -> bool {
        matches!(self.state, State::Waiting | State::Running)
    }

    pub fn cancel(&mut self) {
        self.watch.cancelled.store(true, Ordering::Relaxed);
        match &self.task {
            Some(task) => task.cancel(),
            None => self.state = State::Cancelled,
        }
    }
}

impl Drop for Export {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// What the window should tell.
#[derive(Debug, PartialEq)]
pub enum News {
    Warning(String),
    Note(String),
    Done(PathBuf),
    Failed(String),
}

/// How long a picture may take to notice that it is not wanted any more.
const PATIENCE: Duration = Duration::from_secs(10);

/// All exports, of which one is made at a time: they share a device.
pub struct Exports {
    pub list: Vec<Export>,
    wake: Wake,
}

impl Exports {
    pub fn new(wake: Wake) -> Exports {
        Exports { list: Vec::new(), wake }
    }

    pub fn add(&mut self, plan: Plan) {
        let watch = Watch::new(Wake::clone(&self.wake));
        self.list.push(Export { plan, state: State::Waiting, task: None, watch });
    }

    /// Puts an export that has ended at the end of the queue again; pictures that are done are kept.
    pub fn resume(&mut self, index: usize) {
        let plan = Plan { resumes: true, ..self.list.remove(index).plan.clone() };
        self.add(plan);
    }

    pub fn remove(&mut self, index: usize) {
        self.list.remove(index);
    }

    /// Number of exports that are not at their end.
    pub fn pending(&self) -> usize {
        self.list.iter().filter(|export| export.is_pending()).count()
    }

    /// Whether a file is on its way to `path`.
    pub fn will_write(&self, path: &Path) -> bool {
        self.list.iter().any(|export| export.is_pending() && export.plan.path == path)
    }

    /// The one that is being made, or will be next.
    pub fn first_pending(&mut self) -> Option<&mut Export> {
        self.list.iter_mut().find(|export| export.is_pending())
    }

    pub fn cancel_all(&mut self) {
        self.list.iter_mut().filter(|export| export.is_pending()).for_each(Export::cancel);
    }

    /// Cancels all and waits until that is done: what ends with the program leaves its half files behind. Not
    /// for ever, as a device may hang.
    pub fn end(&mut self) {
        self.cancel_all();
        let begin = Instant::now();
        let at_work = |export: &Export| export.task.as_ref().is_some_and(|task| task.poll().is_none());
        while begin.elapsed() < PATIENCE && self.list.iter().any(at_work) {
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Starts the next one where none is being made, on a device of its own, and tells what happened.
    pub fn poll(&mut self, gpu: &GpuOptions) -> Vec<News> {
        let mut news = Vec::new();
        for export in &mut self.list {
            news.extend(lock(&export.watch.lines).drain(..).map(|line| News::of(&line)));
            let Some(outcome) = export.task.as_ref().and_then(Task::poll) else { continue };
            export.task = None;
            // Who starts it again waits for the disk; who does not has the memory back.
            export.plan.in_memory = None;
            export.state = match outcome {
                Outcome::Done(summary) => {
                    news.push(News::Done(export.plan.path.clone()));
                    State::Done(summary)
                }
                Outcome::Cancelled => State::Cancelled,
                Outcome::Failed(text) => {
                    news.push(News::Failed(text.clone()));
                    State::Failed(text)
                }
            };
        }
        let running = self.list.iter().any(|export| export.task.is_some());
        let waiting = self.list.iter_mut().find(|export| matches!(export.state, State::Waiting));
        if let (false, Some(export)) = (running, waiting) {
            let (plan, gpu, watch) = (export.plan.clone(), gpu.clone(), Arc::clone(&export.watch));
            export.state = State::Running;
            export.task = Some(Task::start(Wake::clone(&self.wake), move |_| {
                let order = plan.order()?;
                order.carry_out(Gpu::new(&gpu)?, watch)
            }));
        }
        news
    }
}

impl News {
    /// What a line for a terminal says.
    fn of(line: &str) -> News {
        match line.strip_prefix("warning: ") {
            Some(text) => News::Warning(text.to_owned()),
            None => News::Note(line.strip_prefix("note: ").unwrap_or(line).to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use renderer::View;

    use super::*;
    use crate::export::Steady;
    use crate::frames::Sequence;

    fn plan(path: PathBuf) -> Plan {
        let mut view = View::default();
        (view.image.width, view.image.height) = (16, 12);
        Plan {
            sequence: Sequence::open(&["demo:radial:64".into(), "demo:radial:27".into()]).unwrap(),
            first: 0,
            last: 1,
            every: 1,
            in_memory: None,
            view,
            steady: Steady::default(),
            path,
            numbered: true,
            rate: 10.0,
            layers: Vec::new(),
            view_file: None,
            stats_file: None,
            resumes: false,
        }
    }

    fn settle(exports: &mut Exports) -> Vec<News> {
        let start = Instant::now();
        let mut news = Vec::new();
        while exports.pending() > 0 {
            assert!(start.elapsed() < Duration::from_secs(60), "the exports do not end");
            news.extend(exports.poll(&GpuOptions::default()));
            std::thread::sleep(Duration::from_millis(5));
        }
        news
    }

    #[test]
    fn several_are_made_one_after_the_other_and_one_that_was_cancelled_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let mut exports = Exports::new(Arc::new(|| {}));
        exports.add(plan(folder.path().join("new/a-{}.png")));
        exports.add(plan(folder.path().join("b-{}.exr")));
        exports.add(plan(folder.path().join("c.jpg")));
        exports.poll(&GpuOptions::default());
        assert!(matches!(exports.list[0].state, State::Running));
        assert!(exports.will_write(&folder.path().join("b-{}.exr")));
        exports.list[1].cancel();
        let news = settle(&mut exports);
        assert!(matches!(&exports.list[0].state, State::Done(summary) if summary.frames == 2));
        assert!(matches!(exports.list[1].state, State::Cancelled));
        assert!(!exports.will_write(&folder.path().join("b-{}.exr")));
        assert!(matches!(&exports.list[2].state, State::Failed(why) if why.contains("c.jpg")));
        assert!(news.contains(&News::Done(folder.path().join("new/a-{}.png"))));
        assert!(folder.path().join("new/a-1.png").exists() && !folder.path().join("b-0.exr").exists());
        exports.resume(1);
        exports.resume(0);
        settle(&mut exports);
        assert!(folder.path().join("b-1.exr").exists());
        assert!(matches!(&exports.list[2].state, State::Done(summary) if summary.kept == 2), "all are there");
    }

    #[test]
    fn at_the_end_of_the_program_no_half_file_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let mut exports = Exports::new(Arc::new(|| {}));
        let mut large = plan(folder.path().join("large-{}.png"));
        (large.view.image.width, large.view.image.height) = (9000, 8000);
        exports.add(large);
        let begin = Instant::now();
        while std::fs::read_dir(folder.path()).unwrap().count() == 0 {
            assert!(begin.elapsed() < Duration::from_secs(60), "it does not begin");
            exports.poll(&GpuOptions::default());
            std::thread::sleep(Duration::from_millis(5));
        }
        exports.end();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn what_is_left_follows_from_what_is_done() {
        let now = Instant::now();
        let progress = Progress { stage: Stage::Pictures, index: 2, share: 0.5, count: 10, since: Some(now) };
        assert_eq!(progress.whole(), 0.25);
        assert_eq!(progress.left(now), None, "too early to tell");
        let left = progress.left(now + Duration::from_secs(10)).unwrap();
        assert!((left.as_secs_f32() - 30.0).abs() < 0.1, "{left:?}");
    }
}
