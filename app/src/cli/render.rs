//! `sphcast render`: frames to picture files.

use std::path::PathBuf;

use anyhow::{Context, bail};
use renderer::Renderer;

use super::console::Console;
use super::{DeviceArguments, SequenceArguments, ViewArguments, WrongArguments};
use crate::export::{Film, Layer, Listener, Made, Output, Overlay, Pictures, Shard, StatsFile};
use crate::image_file::Format;

/// Render frames to picture files, without a window.
///
/// Without --view the camera has the whole run in view, and colours span the values of each frame.
#[derive(clap::Args)]
#[command(after_help = "\
With several frames --out and --overlay have a number pattern or are directories, and pictures have the numbers of their \
frames, counted from 0. A frame that cannot be read is told and left out; the exit status is 1 then.

On a cluster, N jobs with --shard 1/N to --shard N/N make all pictures between them: frame number k, counted from 0 \
among those of --frames and --every, is the job's with I - 1 = k mod N, so that every job gets early frames and late \
ones, and none more than one frame more than another. Where the view leaves camera, reference length or quantity open, \
every job looks through all frames first, and all settle for the same; a view that says them saves that time. The file \
of --stats is named after the part, as in stats-3-of-16.json. A job with no frame to do ends well.

A picture is written whole or not at all, and holds what it was made from (a text chunk of a PNG, an attribute of an \
EXR, both named `sphcast`): the view with all settings, the name, size and time of change of the frame's file, its \
number, and the version of the program. With --resume a picture of which all that is as it would be now is left as it \
is, and everything else is made anew; so are pictures without that text. Without --resume all are.

Examples:
  sphcast render frame.vtu --view view.json --out frame.png --overlay cells.png
  sphcast render run/ --frames 10..20 --size 1024x1024 --out 'out-{:04}.exr' --stats stats.json
  sphcast render run/ --view view.json --out frames/ --shard $SLURM_ARRAY_TASK_ID/16 --resume")]
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
    /// Values to put into the channels of an EXR beside its colour: predicted-error, as `predicted_error`
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    layers: Vec<Layer>,
    /// Make only part I of N of the pictures, 1/N to N/N: for several jobs or computers at a time
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Leave pictures as they are that are there and made from this very view, frame and program
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    device: DeviceArguments,
}

pub fn run(arguments: &RenderArguments) -> anyhow::Result<()> {
    let console = Console::listen()?;
    let run = arguments.sequence.open()?;
    let view = arguments.view.resolve(&run.sequence)?;
    let frames = run.sequence.len();
    let wrong = |flag| move |what| WrongArguments(format!("{flag}: {what}"));
    let output = Output::new(&arguments.out, frames, &[Format::Png, Format::Exr]).map_err(wrong("--out"))?;
    let layers = arguments.layers.clone();
    if !layers.is_empty() && output.format() != Some(Format::Exr) {
        return Err(wrong("--layers")("only .exr files hold them: name such a file with --out".into()).into());
    }
    let overlay = arguments.overlay.as_ref().map(|path| Overlay::new(path, frames, &output));
    let overlay = overlay.transpose().map_err(wrong("--overlay"))?;
    let stats = arguments.stats.as_ref().map(|path| {
        let path = arguments.shard.map_or_else(|| path.clone(), |shard| shard.own(path));
        StatsFile::new(path, frames > 1, arguments.resume)
    });
    let renderer = Renderer::new(arguments.device.open()?).context("sphcast")?;
    let mut pictures = Pictures { renderer, output, overlay, stats, layers, resumes: arguments.resume };
    pictures.prepare(&view)?;

    let mut film = Film::new(run, view, arguments.shard, console.clone());
    let mut kept = 0;
    let result = film.each(|film, index| {
        kept += usize::from(pictures.make(film, index)? == Made::Kept);
        Ok(())
    });
    console.clear();
    let failed = result?;
    if kept > 0 {
        console.say(&format!("note: {kept} of {} pictures were there and are left as they are", film.len()));
    }
    // Also where no picture is new.
    pictures.stats.map_or(Ok(()), |stats| stats.write())?;
    match failed.as_slice() {
        [] => Ok(()),
        [first, ..] => bail!("{first}: no picture: {} of {} frames failed", failed.len(), film.len()),
    }
}
