//! The error of the picture in view, measured: drawn once as it is and once at full sampling, on a
//! thread and a device of its own.

use std::sync::Arc;

use renderer::{Gpu, GpuOptions, Picture, Progress, Renderer, Stats, View};

use crate::difference::{Difference, by_pixel, difference};
use crate::frames::Frame;
use crate::image_file::Pixels;

use crate::viewer::Wake;
use crate::viewer::render_thread::prepare::Preparation;
use crate::viewer::render_thread::without_background;
use crate::viewer::task::{Outcome, Task};

/// A measurement at work or done, of one view of one frame.
pub struct Measurement {
    frame: Arc<Frame>,
    /// Without its background.
    view: View,
    pub state: State,
}

pub enum State {
    Running(Task<Measured>),
    Done(Box<Measured>),
}

/// What was found out.
pub struct Measured {
    pub tolerance: f64,
    pub error: Difference,
    /// Of the largest channel, pixel after pixel.
    pub errors: Vec<f64>,
    pub size: [u32; 2],
    /// What full sampling takes, in times of the picture in view.
    pub speed_up: SpeedUp,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedUp {
    pub time: f64,
    pub evaluations: f64,
    /// Of the picture in view and of full sampling.
    pub milliseconds: [f64; 2],
}

impl Measurement {
    /// Starts to measure, at `tolerance`, the picture that `view` shows of `frame`.
    pub fn start(
        frame: Arc<Frame>,
        view: &View,
        tolerance: f64,
        options: GpuOptions,
        wake: Wake,
    ) -> Measurement {
        let view = without_background(view);
        let (its_frame, its_view) = (Arc::clone(&frame), view.clone());
        let task =
            Task::start(wake, move |progress| measure(&its_frame, &its_view, tolerance, &options, progress));
        Measurement { frame, view, state: State::Running(task) }
    }

    /// Whether it is about the picture that `view` shows of `frame`.
    pub fn is_of(&self, frame: &Arc<Frame>, view: &View) -> bool {
        Arc::ptr_eq(&self.frame, frame) && self.view == without_background(view)
    }

    /// What became of it, once: a result stays here as well.
    pub fn poll(&mut self) -> Option<Outcome<()>> {
        let State::Running(task) = &self.state else { return None };
        Some(match task.poll()? {
            Outcome::Done(measured) => {
                self.state = State::Done(Box::new(measured));
                Outcome::Done(())
            }
            Outcome::Cancelled => Outcome::Cancelled,
            Outcome::Failed(why) => Outcome::Failed(why),
        })
    }
}

/// Share of the work that goes into full sampling, at a guess.
const FULL_SHARE: f32 = 0.6;

fn measure(
    frame: &Arc<Frame>,
    view: &View,
    tolerance: f64,
    options: &GpuOptions,
    progress: &mut Progress,
) -> anyhow::Result<Measured> {
    let mut preparation = Preparation::default();
    let (adaptive, _) = preparation.scene(frame, view)?;
    let mut full = view.clone();
    full.sampling.tolerance = None;
    let (full, _) = preparation.scene(frame, &full)?;
    let mut renderer = Renderer::new(Gpu::new(options)?)?;
    // Adaptive sampling comes first: what a device does only once counts against it.
    let (ours, cost) = apart(renderer.render(&adaptive, &mut |share| progress((1.0 - FULL_SHARE) * share))?);
    let (theirs, full_cost) =
        apart(renderer.render(&full, &mut |share| progress(1.0 - FULL_SHARE + FULL_SHARE * share))?);
    Ok(Measured {
        tolerance,
        error: difference(&ours, &theirs, tolerance),
        errors: by_pixel(&ours, &theirs),
        size: [ours.width, ours.height],
        speed_up: SpeedUp::new(&cost, &full_cost),
    })
}

fn apart(picture: Picture) -> (Pixels, Stats) {
    (Pixels { width: picture.width, height: picture.height, data: picture.pixels }, picture.stats)
}

impl SpeedUp {
    /// Of a picture over full sampling, which found the grid there already: it counts for both.
    fn new(ours: &Stats, full: &Stats) -> SpeedUp {
        let ratio = |full: f64, ours: f64| if ours > 0.0 { full / ours } else { 1.0 };
        let (own, theirs) = (&ours.milliseconds, &full.milliseconds);
        let milliseconds = [own.grid + own.analysis + own.ray_cast, own.grid + theirs.ray_cast];
        SpeedUp {
            time: ratio(milliseconds[1], milliseconds[0]),
            evaluations: ratio(full.evaluations.done as f64, ours.evaluations.done as f64),
            milliseconds,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;
    use std::time::Duration;

    use renderer::BrickWidth;

    use super::*;
    use crate::frames::Sequence;

    #[test]
    fn the_grid_counts_for_both() {
        let (mut ours, mut full) = (Stats::default(), Stats::default());
        (ours.milliseconds.grid, ours.milliseconds.analysis, ours.milliseconds.ray_cast) = (2.0, 3.0, 5.0);
        full.milliseconds.ray_cast = 18.0;
        (ours.evaluations.done, full.evaluations.done) = (100, 250);
        let expected = SpeedUp { time: 2.0, evaluations: 2.5, milliseconds: [10.0, 20.0] };
        assert_eq!(SpeedUp::new(&ours, &full), expected);
        assert_eq!(SpeedUp::new(&Stats::default(), &full).time, 1.0);
    }

    #[test]
    fn a_picture_is_measured_against_full_sampling_and_no_other_picture_is_meant() {
        if let Err(error) = Gpu::new(&GpuOptions::default()) {
            eprintln!("skipped: {error}");
            return;
        }
        let sequence = Sequence::open(&[PathBuf::from("demo:radial:1000")]).unwrap();
        let frame = Arc::new(sequence.sources()[0].load(&Default::default()).unwrap());
        let mut view = View::default();
        (view.image.width, view.image.height) = (96, 64);
        (view.sampling.tolerance, view.sampling.brick_width) = (Some(0.02), BrickWidth::Two);
        let options = GpuOptions::default();
        let mut measurement = Measurement::start(Arc::clone(&frame), &view, 0.02, options, Arc::new(|| {}));
        let outcome = loop {
            match measurement.poll() {
                Some(outcome) => break outcome,
                None => std::thread::sleep(Duration::from_millis(2)),
            }
        };
        assert_eq!(outcome, Outcome::Done(()));
        let State::Done(measured) = &measurement.state else { panic!("it is done") };
        assert!(measured.error.max > 0.0 && measured.error.max <= 0.02, "{:?}", measured.error);
        assert_eq!((measured.error.above, measured.errors.len()), (0.0, 96 * 64));
        // Less than half of the evaluations are left, those of the analysis counted in.
        assert!((2.0..4.0).contains(&measured.speed_up.evaluations), "{:?}", measured.speed_up);

        view.image.background = Some([1.0; 3]);
        assert!(measurement.is_of(&frame, &view), "a background is behind the picture");
        view.sampling.tolerance = Some(0.01);
        assert!(!measurement.is_of(&frame, &view));
        view.sampling.tolerance = Some(0.02);
        let other = Arc::new(sequence.sources()[0].load(&Default::default()).unwrap());
        assert!(!measurement.is_of(&other, &view));
    }
}
