//! `sphcast render`: pictures without a window.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, bail};
use renderer::{Picture, Renderer, Scene, Stats};

use super::film::{Fatal, Film};
use super::interrupt::Interrupt;
use super::output::Output;
use super::timed::Timed;
use super::{DeviceArguments, SequenceArguments, ViewArguments};
use crate::frames::FrameSource;
use crate::image_file::{self, Pixels};

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
    /// Write what the pictures cost: sizes, evaluations, milliseconds; renders each once more in full, to count
    #[arg(long, value_name = "PATH.json")]
    stats: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArguments,
}

pub fn run(arguments: &RenderArguments) -> anyhow::Result<()> {
    let interrupt = Interrupt::listen();
    let run = arguments.sequence.open()?;
    let view = arguments.view.resolve(&run.sequence)?;
    let output = Output::new(&arguments.out, run.sequence.len())?;
    output.prepare()?;
    let renderer = Renderer::new(arguments.device.open()?).context("sphcast")?;

    let sources: Vec<Arc<Timed>> = run.sequence.frame_sources().into_iter().map(Timed::new).collect();
    let streamed = sources.iter().map(|source| Arc::clone(source) as Arc<dyn FrameSource>).collect();
    let mut film = Film::new(run, view, streamed, interrupt)?;
    let wanted = arguments.stats.is_some();
    let mut job = Job { output, renderer, sources, stats: wanted.then(Vec::new) };
    let failed = film.each(|film, index| job.picture(film, index))?;
    if let (Some(path), Some(stats)) = (&arguments.stats, &job.stats) {
        write_stats(path, stats, film.len() > 1)?;
    }
    match failed.as_slice() {
        [] => Ok(()),
        [first, ..] => bail!("{first}: no picture: {} of {} frames failed", failed.len(), film.len()),
    }
}

struct Job {
    output: Output,
    renderer: Renderer,
    sources: Vec<Arc<Timed>>,
    /// Of the pictures so far, where they are asked for.
    stats: Option<Vec<Stats>>,
}

impl Job {
    /// Renders and writes one picture.
    fn picture(&mut self, film: &mut Film, index: usize) -> anyhow::Result<()> {
        let frame = film.frame(index)?;
        let content = film.content(index, &frame)?;
        let scene = content.scene(&content.view).with_context(|| film.name(index).to_owned())?;
        let adaptive = scene.sampling.tolerance.is_some();
        let counted = adaptive && self.stats.is_some();
        let part = if counted { 0.5 } else { 1.0 };
        let Picture { width, height, pixels, mut stats } =
            film.render(&mut self.renderer, &scene, index, 0.0..part)?;
        if counted {
            stats.evaluations.full = self.full_evaluations(film, scene, index, part)?;
        }
        let path = self.output.path(film.number(index));
        image_file::write(&path, &Pixels { width, height, data: pixels }, film.view().image.background)
            .map_err(|error| Fatal(format!("{error:#}")))?;
        stats.milliseconds.read = self.sources[index].milliseconds();
        stats.milliseconds.total += stats.milliseconds.read;
        self.stats.iter_mut().for_each(|all| all.push(stats.clone()));
        Ok(())
    }

    /// What full sampling computes for `scene`. An adaptive picture cannot know, so it is rendered once
    /// more; that does not count for its time.
    fn full_evaluations(
        &mut self,
        film: &Film,
        mut scene: Scene,
        index: usize,
        begun: f32,
    ) -> anyhow::Result<u64> {
        scene.sampling.tolerance = None;
        Ok(film.render(&mut self.renderer, &scene, index, begun..1.0)?.stats.evaluations.full)
    }
}

fn write_stats(path: &Path, stats: &[Stats], several: bool) -> anyhow::Result<()> {
    let text = match (several, stats) {
        (false, [only]) => serde_json::to_string_pretty(only),
        _ => serde_json::to_string_pretty(stats),
    };
    image_file::write_whole(path, format!("{}\n", text?).as_bytes())
}
