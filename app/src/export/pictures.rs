//! One frame after the other to picture files.

use std::ops::{ControlFlow, Range};
use std::path::Path;

use anyhow::{Context, bail};
use renderer::{Band, BandLayers, CellMap, Picture, Renderer, Scene, Stats, View};

use super::video::Video;
use super::{Fatal, Film, Layer, Output, StatsFile, layer, record};
use crate::annotate::Annotations;
use crate::image_file::{self, Format, Header, Pixels, Rows};
use crate::overlay::{self, Lettering};
use crate::whole_file::Unwritten;

/// Where pictures of the classes of the cells go.
pub struct Overlay {
    output: Output,
    lettering: Lettering,
}

impl Overlay {
    /// Beside the pictures of a run of `frames` frames, which go to `pictures` where they are files.
    ///
    /// # Errors
    /// The path, and why it does not do.
    pub fn new(path: &Path, frames: usize, pictures: Option<&Output>) -> Result<Overlay, String> {
        let output = Output::new(path, frames, &[Format::Png])?;
        if Some(&output) == pictures {
            return Err(format!("{}: is where --out writes the pictures themselves", path.display()));
        }
        Ok(Overlay { output, lettering: Lettering::default() })
    }
}

/// Where the pictures go.
pub enum Target {
    Files(Output),
    Video(Video),
}

impl Target {
    /// Whose colours annotations mix with: a video's are those of the screen.
    fn format(&self) -> Option<Format> {
        match self {
            Target::Files(output) => output.format(),
            Target::Video(_) => Some(Format::Png),
        }
    }
}

/// Makes the files of each frame.
pub struct Pictures {
    pub renderer: Renderer,
    pub target: Target,
    pub overlay: Option<Overlay>,
    pub stats: Option<StatsFile>,
    /// What the pictures, which are EXR then, hold beside their colour.
    pub layers: Vec<Layer>,
    /// Whether files that are there, and would not look different, are left as they are.
    pub resumes: bool,
}

/// What became of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Made {
    Written,
    /// It was there.
    Kept,
}

impl Pictures {
    /// Makes the directories that pictures go to.
    ///
    /// # Errors
    /// A directory that cannot be made, or pictures as `view` wants them that would be too large.
    pub fn prepare(&self, view: &View) -> anyhow::Result<()> {
        let [width, height] = [view.image.width, view.image.height];
        if self.overlay.is_some() && u64::from(width) * u64::from(height) > MOST_WHOLE {
            bail!(
                "--overlay: {width} x {height} pixels are more than the {MOST_WHOLE} that it can be drawn over; \
                 leave it out, or make the picture smaller, such as 8192x8192"
            );
        }
        match &self.target {
            Target::Files(output) => output.prepare()?,
            Target::Video(video) if u64::from(width) * u64::from(height) > MOST_WHOLE => bail!(
                "{}: {width} x {height} pixels are more than the {MOST_WHOLE} that a video can have here; make it \
                 smaller, such as 3840x2160",
                video.path().display()
            ),
            Target::Video(_) => {}
        }
        self.overlay.iter().try_for_each(|overlay| overlay.output.prepare())
    }

    /// Renders and writes the picture of one frame.
    pub fn make(&mut self, film: &Film, index: usize) -> anyhow::Result<Made> {
        let number = film.number(index);
        let channels = Layer::channels(&self.layers);
        let frames = film.camera_frames();
        let record = record::of(&film.common_view(), film.source(index), number, frames, &channels);
        if self.resumes && self.is_there(number, &record) {
            self.stats.iter_mut().for_each(|stats| stats.keep(number));
            return Ok(Made::Kept);
        }
        let frame = film.frame(index)?;
        let content = film.content(index, &frame)?;
        let scene = content.scene(&content.view).with_context(|| film.name(index).to_owned())?;
        let annotations = Annotations::new(&content.view, &scene, &frame, number);
        self.draw(film, &Shot { index, scene, annotations, record })?;
        Ok(Made::Written)
    }

    /// Ends what all pictures have in common.
    pub fn finish(&mut self) -> anyhow::Result<()> {
        if let Target::Video(video) = &mut self.target {
            video.finish()?;
        }
        // Also where no picture is new.
        self.stats.as_ref().map_or(Ok(()), StatsFile::write)
    }

    /// Whether frame `number` has all its files, made as `record` says.
    fn is_there(&self, number: usize, record: &str) -> bool {
        let Target::Files(output) = &self.target else { return false };
        let overlay = self.overlay.as_ref().map(|overlay| overlay.output.path(number));
        std::iter::once(output.path(number)).chain(overlay).all(|path| is_made(&path, record))
    }

    fn draw(&mut self, film: &Film, shot: &Shot) -> anyhow::Result<()> {
        let counted = shot.scene.sampling.tolerance.is_some() && self.stats.is_some();
        let part = 0.0..if counted { 0.5 } else { 1.0 };
        let whole = self.overlay.is_some() || (self.layers.is_empty() && !is_large(&shot.scene));
        let mut stats = match whole {
            true => self.draw_whole(film, shot, part.clone())?,
            false => self.draw_in_bands(film, shot, part.clone())?,
        };
        if counted {
            stats.evaluations.full = self.full_evaluations(film, shot, part.end..1.0)?;
        }
        stats.milliseconds.read = film.read_milliseconds(shot.index);
        stats.milliseconds.total += stats.milliseconds.read;
        self.stats.as_mut().map_or(Ok(()), |file| file.add(film.number(shot.index), &stats)).map_err(fatal)
    }

    fn draw_whole(&mut self, film: &Film, shot: &Shot, part: Range<f32>) -> anyhow::Result<Stats> {
        let Shot { index, scene, .. } = shot;
        let (colours, rest) = in_two(part, layer::asked(&self.layers).depths);
        let (picture, cells) = match self.overlay {
            None => (film.render(&mut self.renderer, scene, *index, colours)?, None),
            Some(_) => {
                let (picture, cells) = film.render_with_cells(&mut self.renderer, scene, *index, colours)?;
                (picture, Some(cells))
            }
        };
        let depths =
            rest.map(|part| film.render_depths(&mut self.renderer, scene, *index, part)).transpose()?;
        let Picture { width, height, pixels, stats } = picture;
        let mut pixels = Pixels { width, height, data: pixels };
        let number = film.number(*index);
        let layers = &self.layers;
        let charged = cells.as_ref().filter(|_| layer::asked(layers).charges).map(charges);
        let write = |output: &Output, pixels: &Pixels, layers: &[Layer]| {
            let names = Layer::channels(layers);
            image_file::write_rows(&output.path(number), &shot.header(film, &names), |sink| {
                let channels = if names.is_empty() { Vec::new() } else { layer::values(&depths, &charged) };
                sink(Rows { pixels: &pixels.data, channels })
            })
            .map_err(fatal)
        };
        // The picture comes last: where it is there, what belongs to it is, too.
        if let (Some(overlay), Some(cells)) = (&mut self.overlay, &cells) {
            write(&overlay.output, &overlay::drawn_over(&pixels, cells, &mut overlay.lettering), &[])?;
        }
        if let (Some(annotations), Some(format)) = (&shot.annotations, self.target.format()) {
            annotations.draw_onto(&mut pixels, format);
        }
        match &mut self.target {
            Target::Files(output) => write(output, &pixels, layers)?,
            Target::Video(video) => video
                .add(&pixels, film.view().image.background)
                .map_err(|error| Fatal(format!("{error:#}")))?,
        }
        Ok(stats)
    }

    /// Renders and writes some rows at a time: as many as suit the host, however large the picture is.
    fn draw_in_bands(&mut self, film: &Film, shot: &Shot, part: Range<f32>) -> anyhow::Result<Stats> {
        let Shot { index, scene, .. } = shot;
        let Target::Files(output) = &self.target else {
            bail!("{}: a video is drawn picture by picture", film.name(*index))
        };
        let (path, names) = (output.path(film.number(*index)), Layer::channels(&self.layers));
        let (renderer, format) = (&mut self.renderer, output.format());
        let asked = layer::asked(&self.layers);
        image_file::write_rows(&path, &shot.header(film, &names), |sink| {
            let mut refusal = None;
            let mut take = |mut band: Band| {
                if let (Some(annotations), Some(format)) = (&shot.annotations, format) {
                    let size = [scene.width, scene.height];
                    annotations.draw_onto_rows(&mut band.pixels, band.first_row, size, format);
                }
                let Band { pixels, depths, charged, .. } = &band;
                match sink(Rows { pixels, channels: layer::values(depths, charged) }) {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(error) => {
                        refusal = Some(error);
                        ControlFlow::Break(())
                    }
                }
            };
            let asked = (rows_of_band(scene), asked);
            let stats = film.render_bands(renderer, scene, *index, part, asked, &mut take);
            refusal.map_or(stats, Err)
        })
        .map_err(fatal)
    }

    /// What full sampling computes. An adaptive picture cannot know, so it is rendered once more; that does
    /// not count for its time.
    fn full_evaluations(&mut self, film: &Film, shot: &Shot, part: Range<f32>) -> anyhow::Result<u64> {
        let mut scene = shot.scene.clone();
        scene.sampling.tolerance = None;
        let renderer = &mut self.renderer;
        let stats = match is_large(&scene) {
            false => film.render(renderer, &scene, shot.index, part)?.stats,
            true => {
                let mut drop_it = |_: Band| ControlFlow::Continue(());
                let asked = (rows_of_band(&scene), BandLayers::default());
                film.render_bands(renderer, &scene, shot.index, part, asked, &mut drop_it)?
            }
        };
        Ok(stats.evaluations.full)
    }
}

/// What a picture is to show, and what its file says of that.
struct Shot {
    /// Of the frame in the film.
    index: usize,
    scene: Scene,
    annotations: Option<Annotations>,
    record: String,
}

impl Shot {
    fn header<'a>(&self, film: &Film, channels: &'a [&'a str]) -> Header<'a> {
        Header {
            width: self.scene.width,
            height: self.scene.height,
            background: film.view().image.background,
            record: Some(self.record.clone()),
            channels,
        }
    }
}

/// The part of the work that is for colours, and that for depths where there are any.
fn in_two(part: Range<f32>, has_depths: bool) -> (Range<f32>, Option<Range<f32>>) {
    if !has_depths {
        return (part, None);
    }
    let middle = 0.5 * (part.start + part.end);
    (part.start..middle, Some(middle..part.end))
}

/// What is charged to each pixel.
fn charges(cells: &CellMap) -> Vec<f32> {
    let [width, height] = cells.size;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    pixels.map(|pixel| cells.charged(pixel)).collect()
}

/// Pixels of a picture that is rendered as a whole: 1 GiB of them.
const MOST_WHOLE: u64 = 1 << 26;
/// Pixels of a band of a larger one.
const BAND: u32 = 1 << 24;

fn is_large(scene: &Scene) -> bool {
    u64::from(scene.width) * u64::from(scene.height) > MOST_WHOLE
}

fn rows_of_band(scene: &Scene) -> u32 {
    (BAND / scene.width / image_file::ROWS).max(1) * image_file::ROWS
}

/// Whether the picture at `path` was made as `record` says. A file is written whole or not at all.
fn is_made(path: &Path, record: &str) -> bool {
    path.is_file() && image_file::record(path).is_some_and(|found| found == record)
}

/// Where one file cannot be written, neither can the next.
fn fatal(error: anyhow::Error) -> anyhow::Error {
    if error.is::<Unwritten>() { Fatal(format!("{error:#}")).into() } else { error }
}
