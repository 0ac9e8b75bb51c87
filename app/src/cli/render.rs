//! `sphcast render`: pictures without a window.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, bail};
use renderer::{Picture, Renderer, Scene, Stats};

use super::film::{Fatal, Film};
use super::interrupt::Interrupt;
use super::output::Output;
use super::timed::Timed;
use super::{DeviceArguments, SequenceArguments, ViewArguments, WrongArguments};
use crate::frames::FrameSource;
use crate::image_file::{self, Format, Pixels};
use crate::overlay::{self, Lettering};

/// Render frames to picture files, without a window.
///
/// Without --view the camera has the whole run in view, and colours span the values of each frame.
#[derive(clap::Args)]
#[command(after_help = "\
With several frames --out and --overlay have a number pattern or are directories, and pictures have the numbers of their \
frames, counted from 0. A frame that cannot be read is told and left out; the exit status is 1 then.

Examples:
  sphcast render frame.vtu --view view.json --out frame.png --overlay cells.png
  sphcast render run/ --frames 10..20 --size 1024x1024 --out 'out-{:04}.exr' --stats stats.json")]
pub struct RenderArguments {
    #[command(flatten)]
    sequence: SequenceArguments,
    /// .exr (float, linear, premultiplied) or .png (sRGB, over the view's background if it has one)
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    #[command(flatten)]
    view: ViewArguments,
    /// Write the pictures with the classes of their cells over them: what was sampled, and what was left out
    #[arg(long, value_name = "PATH.png")]
    overlay: Option<PathBuf>,
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
    let frames = run.sequence.len();
    let output = Output::new("--out", &arguments.out, frames, &[Format::Png, Format::Exr])?;
    let overlay = arguments.overlay.as_ref().map(|path| Overlay::new(path, frames, &output)).transpose()?;
    output.prepare()?;
    overlay.iter().try_for_each(|overlay| overlay.output.prepare())?;
    let renderer = Renderer::new(arguments.device.open()?).context("sphcast")?;

    let sources: Vec<Arc<Timed>> = run.sequence.frame_sources().into_iter().map(Timed::new).collect();
    let streamed = sources.iter().map(|source| Arc::clone(source) as Arc<dyn FrameSource>).collect();
    let mut film = Film::new(run, view, streamed, interrupt)?;
    let wanted = arguments.stats.is_some();
    let mut job = Job { output, overlay, renderer, sources, stats: wanted.then(Vec::new) };
    let failed = film.each(|film, index| job.picture(film, index))?;
    if let (Some(path), Some(stats)) = (&arguments.stats, &job.stats) {
        write_stats(path, stats, film.len() > 1)?;
    }
    match failed.as_slice() {
        [] => Ok(()),
        [first, ..] => bail!("{first}: no picture: {} of {} frames failed", failed.len(), film.len()),
    }
}

/// Where pictures of the classes of the cells go.
struct Overlay {
    output: Output,
    lettering: Lettering,
}

impl Overlay {
    fn new(path: &Path, frames: usize, pictures: &Output) -> Result<Overlay, WrongArguments> {
        let output = Output::new("--overlay", path, frames, &[Format::Png])?;
        if output == *pictures {
            let what = "is where --out writes the pictures themselves";
            return Err(WrongArguments(format!("--overlay: {}: {what}", path.display())));
        }
        Ok(Overlay { output, lettering: Lettering::default() })
    }
}

struct Job {
    output: Output,
    overlay: Option<Overlay>,
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
        let (picture, cells) = match self.overlay {
            None => (film.render(&mut self.renderer, &scene, index, 0.0..part)?, None),
            Some(_) => {
                let (picture, cells) =
                    film.render_with_cells(&mut self.renderer, &scene, index, 0.0..part)?;
                (picture, Some(cells))
            }
        };
        let Picture { width, height, pixels, mut stats } = picture;
        if counted {
            stats.evaluations.full = self.full_evaluations(film, scene, index, part)?;
        }
        let pixels = Pixels { width, height, data: pixels };
        let write = |output: &Output, pixels: &Pixels| {
            let path = output.path(film.number(index));
            image_file::write(&path, pixels, film.view().image.background)
                .map_err(|error| Fatal(format!("{error:#}")))
        };
        write(&self.output, &pixels)?;
        if let (Some(overlay), Some(cells)) = (&mut self.overlay, &cells) {
            write(&overlay.output, &overlay::drawn_over(&pixels, cells, &mut overlay.lettering))?;
        }
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
