//! Videos, by the `ffmpeg` that is installed: it takes the pictures as they come, and no file lies between.

use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;

use anyhow::{Context, anyhow, bail};
use rayon::prelude::*;
use tempfile::TempPath;

use crate::image_file::{Pixels, to_srgb8};

/// The formats that videos are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VideoFormat {
    /// H.264, which everything plays.
    Mp4,
    /// VP9, for web pages.
    WebM,
}

/// Frames a second where nobody says.
pub const USUAL_RATE: f64 = 25.0;

impl VideoFormat {
    /// How names of such files end.
    pub fn ending(self) -> &'static str {
        match self {
            VideoFormat::Mp4 => ".mp4",
            VideoFormat::WebM => ".webm",
        }
    }

    /// The format that a file name ends in, in any case; `None` for other endings.
    pub fn of(path: &Path) -> Option<VideoFormat> {
        match path.extension()?.to_str()?.to_lowercase().as_str() {
            "mp4" => Some(VideoFormat::Mp4),
            "webm" => Some(VideoFormat::WebM),
            _ => None,
        }
    }

    fn arguments(self) -> &'static [&'static str] {
        match self {
            VideoFormat::Mp4 => {
                &["-c:v", "libx264", "-crf", "16", "-preset", "slow", "-movflags", "+faststart", "-f", "mp4"]
            }
            VideoFormat::WebM => {
                &["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-f", "webm"]
            }
        }
    }
}

/// From red, green and blue to what is encoded, as the tags say; without them, ffmpeg takes the matrix of old
/// television and players that of the new one, and all greens are off.
const COLOURS: &str = "scale=flags=accurate_rnd+full_chroma_int:out_color_matrix=bt709:out_range=limited,\
                       format=yuv420p";
/// Tells players what the numbers mean: primaries and matrix of HDTV, the curve of sRGB.
const TAGS: [&str; 8] =
    ["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv"];

/// A video that grows by a picture at a time. One that is given up leaves no file.
pub struct Video {
    path: PathBuf,
    format: VideoFormat,
    /// Pictures a second.
    rate: f64,
    /// From the first picture on.
    encoder: Option<Encoder>,
}

/// A running `ffmpeg`.
struct Encoder {
    process: Child,
    size: [u32; 2],
    /// What it writes to, until it is whole.
    file: TempPath,
    complaints: Option<JoinHandle<String>>,
}

/// Whether `ffmpeg` can be started.
pub fn is_there() -> bool {
    let version = Command::new("ffmpeg").arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    version.is_ok_and(|status| status.success())
}

/// What to do where it cannot.
pub const MISSING: &str = "ffmpeg is not installed, which makes the videos: install it (Debian and Ubuntu: \
                           sudo apt install ffmpeg; macOS: brew install ffmpeg; Windows: winget install \
                           ffmpeg), or write pictures";

impl Video {
    pub fn new(path: PathBuf, format: VideoFormat, rate: f64) -> Video {
        Video { path, format, rate, encoder: None }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Adds a picture, shown over `background` (linear), or over black. All have one size.
    ///
    /// # Errors
    /// The path, and what `ffmpeg` says.
    pub fn add(&mut self, pixels: &Pixels, background: Option<[f32; 3]>) -> anyhow::Result<()> {
        let size = [pixels.width, pixels.height];
        let encoder = match &mut self.encoder {
            Some(encoder) => encoder,
            None => {
                let encoder = Encoder::start(&self.path, self.format, self.rate, size);
                self.encoder.insert(encoder.with_context(|| self.path.display().to_string())?)
            }
        };
        if encoder.size != size {
            let ([width, height], path) = (encoder.size, self.path.display());
            bail!("{path}: its pictures are {width} x {height}, this one is {} x {}", size[0], size[1]);
        }
        let bytes = even(pixels, background.unwrap_or_default());
        let input = encoder.process.stdin.as_mut();
        let taken = input.map_or(Ok(()), |input| input.write_all(bytes.as_flattened()));
        // It ends where it cannot go on, and says why.
        taken.map_err(|error| {
            let encoder = self.encoder.take();
            let said = encoder.map_or_else(String::new, |mut encoder| encoder.last_words());
            let what = if said.is_empty() { error.to_string() } else { said };
            anyhow!("{}: ffmpeg: {what}", self.path.display())
        })
    }

    /// Puts the file in its place, once all pictures are in it.
    ///
    /// # Errors
    /// The path, and what `ffmpeg` says, or why there is no video.
    pub fn finish(&mut self) -> anyhow::Result<()> {
        let path = self.path.display().to_string();
        let Some(mut encoder) = self.encoder.take() else { bail!("{path}: there is no picture for it") };
        drop(encoder.process.stdin.take());
        let status = encoder.process.wait().with_context(|| path.clone())?;
        if !status.success() {
            bail!("{path}: ffmpeg: {}", encoder.last_words());
        }
        std::fs::rename(&encoder.file, &self.path)
            .map_err(|error| anyhow!("{path}: cannot be written: {error}"))
    }
}

/// The picture as bytes over `background`, with sides of even length, as colours at half the resolution need
/// them: the last column and row are doubled where they must be.
fn even(pixels: &Pixels, background: [f32; 3]) -> Vec<[u8; 4]> {
    let [width, height] = [pixels.width, pixels.height].map(|side| side as usize);
    let [wide, high] = [width, height].map(|side| side.next_multiple_of(2));
    let mut bytes = vec![[0; 4]; wide * high];
    bytes.par_chunks_mut(wide).enumerate().for_each(|(y, row)| {
        let from = &pixels.data[y.min(height - 1) * width..][..width];
        row.iter_mut().zip(from).for_each(|(to, &pixel)| *to = to_srgb8(pixel, Some(background)));
        row[wide - 1] = row[width - 1];
    });
    bytes
}

impl Encoder {
    fn start(path: &Path, format: VideoFormat, rate: f64, size: [u32; 2]) -> anyhow::Result<Encoder> {
        let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".sphcast-").suffix(format.ending());
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder).context("cannot be written")?.into_temp_path();
        let mut command = Command::new("ffmpeg");
        command.args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgba"]);
        let [width, height] = size.map(|side| side.next_multiple_of(2));
        command.args(["-video_size", &format!("{width}x{height}"), "-framerate", &rate.to_string()]);
        command.args(["-i", "-", "-an", "-vf", COLOURS, "-pix_fmt", "yuv420p"]).args(TAGS);
        command.args(format.arguments()).arg(&*file);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        // Ctrl-C in a terminal is for whoever started it, who ends it then.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut process = command.spawn().map_err(|error| match error.kind() {
            ErrorKind::NotFound => anyhow!(MISSING),
            _ => anyhow!("ffmpeg: {error}"),
        })?;
        let complaints = process.stderr.take().map(|mut said| {
            std::thread::spawn(move || {
                let mut text = String::new();
                // What cannot be read cannot be told.
                let _ = said.read_to_string(&mut text);
                text
            })
        });
        Ok(Encoder { process, size, file, complaints })
    }

    /// What it said last, in one line.
    fn last_words(&mut self) -> String {
        drop(self.process.stdin.take());
        // It is about to end, or has ended.
        let _ = self.process.wait();
        let said = self.complaints.take().and_then(|said| said.join().ok()).unwrap_or_default();
        said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("gave up without a word").to_owned()
    }
}

impl Drop for Encoder {
    fn drop(&mut self) {
        // Of one that has ended there is nothing to end.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
