//! `sphcast render`: frames to picture files.

use std::path::PathBuf;

use anyhow::bail;
use renderer::{PathView, View};

use super::console::Console;
use super::{DeviceArguments, SequenceArguments, ViewArguments, WrongArguments};
use crate::camera_path::camera_at;
use crate::export::video::{USUAL_RATE, Video, VideoFormat};
use crate::export::{
    Layer, Listener, Order, Output, Overlay, Run, Shard, StatsFile, Steady, Summary, Target,
};
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

A video is made by ffmpeg, which must be installed: H.264 in .mp4, VP9 in .webm, over black where the view has no \
background.

With a path in the view, the camera follows it: keyframes stand at the numbers of the frames. --turntable N makes N \
pictures of one frame, numbered from 0, in as many turns as the view's path has, or one.

A picture is written whole or not at all, and holds what it was made from (a text chunk of a PNG, an attribute of an \
EXR, both named `sphcast`): the view with all settings, the name, size and time of change of the frame's file, its \
number, and the version of the program. With --resume a picture of which all that is as it would be now is left as it \
is, and everything else is made anew; so are pictures without that text. Without --resume all are.

Examples:
  sphcast render frame.vtu --view view.json --out frame.png --overlay cells.png
  sphcast render run/ --frames 10..20 --size 1024x1024 --out 'out-{:04}.exr' --stats stats.json
  sphcast render run/ --view view.json --out 'out-{:04}.exr' --layers depth,predicted-error
  sphcast render run/ --view view.json --size 1920x1080 --out film.mp4 --fps 30
  sphcast render frame.vtu --turntable 36 --out 'around-{:02}.png'
  sphcast render run/ --view view.json --out frames/ --shard $SLURM_ARRAY_TASK_ID/16 --resume")]
pub struct RenderArguments {
    #[command(flatten)]
    sequence: SequenceArguments,
    /// .exr (float, linear, premultiplied), .png (sRGB, over the view's background if it has one), or a video:
    /// .mp4, .webm
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    #[command(flatten)]
    view: ViewArguments,
    /// Write the pictures with the classes of their cells over them: what was sampled, and what was left out
    #[arg(long, value_name = "PATH.png")]
    overlay: Option<PathBuf>,
    /// Write what the pictures cost: sizes, evaluations, milliseconds; renders each once more in full, to count.
    /// `-` stands for standard output
    #[arg(long, value_name = "PATH.json")]
    stats: Option<PathBuf>,
    /// Values of each pixel that an EXR holds beside its colour
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    layers: Vec<Layer>,
    /// Pictures a second of a video
    #[arg(long, value_name = "N", default_value_t = USUAL_RATE, value_parser = rate)]
    fps: f64,
    /// Make only part I of N of the pictures, 1/N to N/N: for several jobs or computers at a time
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Write N pictures of one frame, from around the turntable, in place of one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    turntable: Option<u16>,
    /// Have the colours, and opacities, span the values of all frames given, not of each, where the view has no
    /// range
    #[arg(long)]
    steady: bool,
    /// Leave pictures as they are that are there and made from this very view, frame and program
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    device: DeviceArguments,
}

pub fn run(arguments: &RenderArguments) -> anyhow::Result<()> {
    let console = Console::listen()?;
    let mut run = arguments.sequence.open()?;
    let mut view = arguments.view.resolve(&run.sequence)?;
    if let Some(pictures) = arguments.turntable {
        turntable(&mut run, &mut view, usize::from(pictures))?;
    }
    let frames = run.sequence.len();
    let wrong = |flag| move |what| WrongArguments(format!("{flag}: {what}"));
    let target = arguments.target(frames)?;
    let output = if let Target::Files(output) = &target { Some(output) } else { None };
    let layers = arguments.layers.clone();
    if !layers.is_empty() && output.and_then(Output::format) != Some(Format::Exr) {
        return Err(wrong("--layers")("only .exr files hold them: name such a file with --out".into()).into());
    }
    let overlay = arguments.overlay.as_ref().map(|path| Overlay::new(path, frames, output));
    let overlay = overlay.transpose().map_err(wrong("--overlay"))?;
    let stats = arguments.stats.as_ref().map(|path| {
        let shard = arguments.shard.filter(|_| !StatsFile::is_standard_output(path));
        let path = shard.map_or_else(|| path.clone(), |shard| shard.own(path));
        StatsFile::new(path, frames > 1, arguments.resume)
    });
    let (shard, resumes) = (arguments.shard, arguments.resume);
    let steady = steady(&view, arguments.steady);
    let order = Order { run, shard, view, steady, target, overlay, layers, stats, view_file: None, resumes };
    let result = order.carry_out(arguments.device.open()?, console.clone());
    console.clear();
    let Summary { frames, kept, failed } = result?;
    if kept > 0 {
        console.say(&format!("note: {kept} of {frames} pictures were there and are left as they are"));
    }
    match failed.as_slice() {
        [] => Ok(()),
        [first, ..] => bail!("{first}: no picture: {} of {frames} frames failed", failed.len()),
    }
}

/// Which ranges are to be those of all frames: those that the view leaves open, where that is wanted.
fn steady(view: &View, wanted: bool) -> Steady {
    let opacity = view.quantity.opacity.as_ref();
    Steady {
        colour: wanted && view.quantity.range.is_none(),
        opacity: wanted && opacity.is_some_and(|opacity| opacity.range.is_none()),
    }
}

impl RenderArguments {
    /// Where pictures of `frames` frames go.
    fn target(&self, frames: usize) -> Result<Target, WrongArguments> {
        let Some(format) = VideoFormat::of(&self.out) else {
            let output = Output::new(&self.out, frames, &[Format::Png, Format::Exr]);
            let video = if Format::of(&self.out).is_none() { "; a video's in .mp4 or .webm" } else { "" };
            return output.map(Target::Files).map_err(|what| WrongArguments(format!("--out: {what}{video}")));
        };
        let whole = [("--shard", self.shard.is_some()), ("--resume", self.resume)];
        if let Some((flag, _)) = whole.iter().find(|(_, given)| *given) {
            let what = "a video is made as a whole: make pictures by parts, and a video of them by ffmpeg";
            return Err(WrongArguments(format!("{flag}: {what}")));
        }
        Ok(Target::Video(Video::new(self.out.clone(), format, self.fps)))
    }
}

/// Pictures a second.
fn rate(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|rate: &f64| (0.1..=1000.0).contains(rate));
    number.ok_or_else(|| "expected a number between 0.1 and 1000".to_owned())
}

/// Makes a run of one frame one of so many pictures around it. Keyframes are gone then: the camera is
/// where they have it at that frame.
fn turntable(run: &mut Run, view: &mut View, pictures: usize) -> Result<(), WrongArguments> {
    if run.sequence.len() != 1 {
        let what = "goes around one frame: choose it, as by --frames 12";
        return Err(WrongArguments(format!("--turntable: {what}")));
    }
    let keyframes = PathView { keyframes: std::mem::take(&mut view.path.keyframes), revolutions: 0.0 };
    if let Some(first) = keyframes.keyframes.first() {
        let base = view.camera.filter(|camera| camera.is_settled()).unwrap_or(first.camera);
        view.camera = Some(camera_at(&keyframes, &base, run.numbers[0] as f64, run.frames));
    }
    if view.path.revolutions == 0.0 {
        view.path.revolutions = 1.0;
    }
    run.repeat(pictures);
    Ok(())
}
