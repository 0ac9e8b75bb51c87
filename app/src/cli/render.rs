//! `sphcast render`: pictures without a window.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, bail};
use indicatif::{ProgressBar, ProgressStyle};
use renderer::{Gpu, Picture, RenderError, Renderer, Scene, Stats, View};

use super::interrupt::{INTERRUPTED, Interrupt};
use super::output::Output;
use super::survey::Survey;
use super::timed::Timed;
use super::{DeviceArguments, Run, SequenceArguments, ViewArguments};
use crate::frames::{Frame, FrameSource, FrameStream};
use crate::image_file::{self, Pixels};
use crate::scene::{self, Selection};

/// Render frames to picture files, without a window.
///
/// Without --view the camera has the whole run in view, and colours span the values of each frame.
#[derive(clap::Args)]
#[command(after_help = "\
With several frames --out has a number pattern or is a directory, and pictures have the numbers of their \
frames, counted from 0. A frame that cannot be read is told and left out; the exit status is 1 then.

Examples:
  sphcast render frame.vtu --view view.json --out frame.png
  sphcast render run/ --frames 10..20 --size 1024x1024 --out 'out-{:04}.exr' --stats stats.json")]
pub struct RenderArguments {
    #[command(flatten)]
    sequence: SequenceArguments,
    /// .exr (float, linear, premultiplied) or .png (sRGB, over the view's background if it has one)
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    #[command(flatten)]
    view: ViewArguments,
    /// Write what the pictures cost: sizes, evaluations, milliseconds
    #[arg(long, value_name = "PATH.json")]
    stats: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArguments,
}

/// Bytes of frames that are read ahead.
const READ_AHEAD: usize = 1 << 30;

pub fn run(arguments: &RenderArguments) -> anyhow::Result<()> {
    let interrupt = Interrupt::listen();
    let run = arguments.sequence.open()?;
    let view = arguments.view.resolve(&run.sequence)?;
    let output = Output::new(&arguments.out, run.sequence.len())?;
    output.prepare()?;
    let asked = arguments.device.adapter.is_some();
    let gpu = Gpu::new(&arguments.device.options()).context(if asked { "--adapter" } else { "sphcast" })?;
    let renderer = Renderer::new(gpu).context("sphcast")?;

    let sources: Vec<Arc<Timed>> = run.sequence.frame_sources().into_iter().map(Timed::new).collect();
    let streamed = sources.iter().map(|source| Arc::clone(source) as Arc<dyn FrameSource>).collect();
    let stream = FrameStream::new(streamed, READ_AHEAD, || {});
    let bar = bar(run.sequence.len())?;
    let mut job = Job { run, view, output, renderer, stream, sources, interrupt, bar, quantity: None };
    let result = job.pictures();
    job.bar.finish_and_clear();
    let Outcome { stats, failed } = result?;
    if let Some(path) = &arguments.stats {
        write_stats(path, &stats, job.stream.len() > 1)?;
    }
    match failed.as_slice() {
        [] => Ok(()),
        [first, ..] => bail!("{first}: no picture: {} of {} frames failed", failed.len(), job.stream.len()),
    }
}

/// What is left once every frame was tried.
struct Outcome {
    stats: Vec<Stats>,
    /// Names of the frames without a picture.
    failed: Vec<String>,
}

struct Job {
    run: Run,
    view: View,
    output: Output,
    renderer: Renderer,
    stream: FrameStream,
    sources: Vec<Arc<Timed>>,
    interrupt: Interrupt,
    bar: ProgressBar,
    /// What the first frame shows where the view does not say; later frames show the same.
    quantity: Option<String>,
}

impl Job {
    fn pictures(&mut self) -> anyhow::Result<Outcome> {
        let count = self.stream.len();
        if count > 1 {
            self.settle()?;
            if self.view.quantity.range.is_none() {
                self.say("note: colours span the values of each frame; a view with quantity.range keeps them steady");
            }
        }
        let mut outcome = Outcome { stats: Vec::new(), failed: Vec::new() };
        for index in 0..count {
            self.interrupt.check()?;
            let name = self.run.sequence.sources()[index].name.clone();
            match self.picture(index, &name) {
                Ok(stats) => outcome.stats.push(stats),
                Err(error) if count == 1 || error.is::<Fatal>() => return Err(error),
                Err(error) => {
                    self.say(&format!("warning: {}", super::one_line(&error)));
                    outcome.failed.push(name);
                }
            }
            show(&self.bar, index, 1.0);
        }
        Ok(outcome)
    }

    /// Gives the view what must not change from frame to frame, or the film would flicker: a camera
    /// that has the whole run in view, and a reference length.
    fn settle(&mut self) -> anyhow::Result<()> {
        if self.view.camera.is_some_and(|camera| camera.is_settled())
            && self.view.transfer.reference_length.is_some()
        {
            return Ok(());
        }
        let mut survey = Survey::default();
        for index in 0..self.stream.len() {
            self.interrupt.check()?;
            self.bar.set_message("looking through the frames");
            // A frame that cannot be read is told when its turn comes.
            if let Ok(frame) = self.stream.wait(index) {
                survey.add(&frame, &self.view);
            }
            show(&self.bar, index, 1.0);
        }
        self.bar.set_message("");
        survey.settle(&mut self.view);
        Ok(())
    }

    /// Renders and writes one picture.
    fn picture(&mut self, index: usize, name: &str) -> anyhow::Result<Stats> {
        let frame = self.stream.wait(index).map_err(|why| anyhow::anyhow!("{name}: {why}"))?;
        for warning in &frame.warnings {
            self.say(&format!("warning: {name}: {warning}"));
        }
        let scene = self.scene(&frame, name).with_context(|| name.to_owned())?;
        let (bar, interrupt) = (self.bar.clone(), self.interrupt.clone());
        let mut progress = |share: f32| {
            show(&bar, index, share);
            if interrupt.asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let picture = match self.renderer.render(&scene, &mut progress) {
            Err(RenderError::Cancelled) => bail!(Fatal(INTERRUPTED.to_owned())),
            Err(error @ RenderError::DeviceLost(_)) => bail!(Fatal(format!("{name}: {error}"))),
            result => result.with_context(|| name.to_owned())?,
        };
        let Picture { width, height, pixels, mut stats } = picture;
        let path = self.output.path(self.run.first + index);
        image_file::write(&path, &Pixels { width, height, data: pixels }, self.view.image.background)
            .map_err(|error| Fatal(format!("{error:#}")))?;
        stats.milliseconds.read = self.sources[index].milliseconds();
        stats.milliseconds.total += stats.milliseconds.read;
        Ok(stats)
    }

    fn scene(&mut self, frame: &Frame, name: &str) -> anyhow::Result<Scene> {
        let particles = Arc::new(scene::particles(frame, self.view.particles.support_radius)?);
        let mut view = self.view.clone();
        if view.quantity.name.is_none() {
            view.quantity.name = self.quantity_of(frame, name);
        }
        let quantity = Arc::new(scene::quantity(frame, &particles, &view.quantity)?);
        if let Some(warning) = scene::rejected_warning(frame, &particles, &quantity) {
            self.say(&format!("warning: {name}: {warning}"));
        }
        Ok(Scene::new(particles, quantity, &view)?)
    }

    /// The quantity of a frame where the view names none: that of the frames before it, or the
    /// frame's own where it lacks that.
    fn quantity_of(&mut self, frame: &Frame, name: &str) -> Option<String> {
        let own = Selection::default_of(frame).name();
        if frame.is_empty() {
            return None;
        }
        match &self.quantity {
            Some(before) if Selection::new(frame, Some(before)).is_ok() => Some(before.clone()),
            Some(before) => {
                let shown = own.as_deref().unwrap_or("particles alike");
                self.say(&format!("warning: {name}: has no field `{before}`; shows {shown}"));
                own
            }
            None => {
                self.quantity.clone_from(&own);
                own
            }
        }
    }

    /// A line on standard error that does not tear the progress bar.
    fn say(&self, line: &str) {
        self.bar.suspend(|| eprintln!("{line}"));
    }
}

/// What would happen again with every frame: a lost device, a full disk, the user's wish to stop.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Fatal(String);

/// Steps of the progress bar for one frame.
const STEPS: u64 = 1000;

/// A bar over `frames` frames, on standard error if that is a terminal.
fn bar(frames: usize) -> anyhow::Result<ProgressBar> {
    let bar = ProgressBar::new(frames as u64 * STEPS);
    let template = "{bar:40} {percent:>3} %  {elapsed} gone, {eta} to go  {msg}";
    bar.set_style(ProgressStyle::with_template(template)?);
    Ok(bar)
}

/// Shows that frame `index` is done to the `share`.
fn show(bar: &ProgressBar, index: usize, share: f32) {
    bar.set_position(index as u64 * STEPS + (share * STEPS as f32) as u64);
}

fn write_stats(path: &Path, stats: &[Stats], several: bool) -> anyhow::Result<()> {
    let text = match (several, stats) {
        (false, [only]) => serde_json::to_string_pretty(only),
        _ => serde_json::to_string_pretty(stats),
    };
    image_file::write_whole(path, format!("{}\n", text?).as_bytes())
}
