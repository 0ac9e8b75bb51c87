//! One frame after the other to picture files.

use std::path::{Path, PathBuf};

use anyhow::Context;
use renderer::{Picture, Renderer, Scene};

use super::{Fatal, Film, Output, StatsFile, record};
use crate::annotate::Annotations;
use crate::image_file::{self, Format, Header, Pixels, Rows};
use crate::overlay::{self, Lettering};

/// Where pictures of the classes of the cells go.
pub struct Overlay {
    output: Output,
    lettering: Lettering,
}

impl Overlay {
    /// Beside the pictures of a run of `frames` frames, which go to `pictures`.
    ///
    /// # Errors
    /// The path, and why it does not do.
    pub fn new(path: &Path, frames: usize, pictures: &Output) -> Result<Overlay, String> {
        let output = Output::new(path, frames, &[Format::Png])?;
        if output == *pictures {
            return Err(format!("{}: is where --out writes the pictures themselves", path.display()));
        }
        Ok(Overlay { output, lettering: Lettering::default() })
    }
}

/// Makes the files of each frame.
pub struct Pictures {
    pub renderer: Renderer,
    pub output: Output,
    pub overlay: Option<Overlay>,
    pub stats: Option<StatsFile>,
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
    pub fn prepare(&self) -> anyhow::Result<()> {
        self.output.prepare()?;
        self.overlay.iter().try_for_each(|overlay| overlay.output.prepare())
    }

    /// Renders and writes the picture of one frame.
    pub fn make(&mut self, film: &Film, index: usize) -> anyhow::Result<Made> {
        let number = film.number(index);
        let record = record::of(&film.common_view(), film.source(index), number, &[]);
        if self.resumes && self.files(number).iter().all(|path| is_made(path, &record)) {
            self.stats.iter_mut().for_each(|stats| stats.keep(number));
            return Ok(Made::Kept);
        }
        let frame = film.frame(index)?;
        let content = film.content(index, &frame)?;
        let scene = content.scene(&content.view).with_context(|| film.name(index).to_owned())?;
        let annotations = Annotations::new(&content.view, &scene, &frame, number);
        self.draw(film, &scene, index, &record, annotations.as_ref())?;
        Ok(Made::Written)
    }

    /// The files that frame `number` has.
    fn files(&self, number: usize) -> Vec<PathBuf> {
        let overlay = self.overlay.as_ref().map(|overlay| overlay.output.path(number));
        std::iter::once(self.output.path(number)).chain(overlay).collect()
    }

    fn draw(
        &mut self,
        film: &Film,
        scene: &Scene,
        index: usize,
        record: &str,
        annotations: Option<&Annotations>,
    ) -> anyhow::Result<()> {
        let counted = scene.sampling.tolerance.is_some() && self.stats.is_some();
        let part = if counted { 0.5 } else { 1.0 };
        let (picture, cells) = match self.overlay {
            None => (film.render(&mut self.renderer, scene, index, 0.0..part)?, None),
            Some(_) => {
                let (picture, cells) = film.render_with_cells(&mut self.renderer, scene, index, 0.0..part)?;
                (picture, Some(cells))
            }
        };
        let Picture { width, height, pixels, mut stats } = picture;
        if counted {
            stats.evaluations.full = self.full_evaluations(film, scene.clone(), index, part)?;
        }
        let mut pixels = Pixels { width, height, data: pixels };
        let number = film.number(index);
        let background = film.view().image.background;
        let write = |output: &Output, pixels: &Pixels| {
            let header = Header { width, height, background, record: Some(record.to_owned()), channels: &[] };
            image_file::write_rows(&output.path(number), &header, |sink| {
                sink(Rows { pixels: &pixels.data, channels: Vec::new() })
            })
            .map_err(fatal)
        };
        // The picture comes last: where it is there, what belongs to it is, too.
        if let (Some(overlay), Some(cells)) = (&mut self.overlay, &cells) {
            write(&overlay.output, &overlay::drawn_over(&pixels, cells, &mut overlay.lettering))?;
        }
        if let (Some(annotations), Some(format)) = (annotations, Format::of(&self.output.path(number))) {
            annotations.draw_onto(&mut pixels, format);
        }
        write(&self.output, &pixels)?;
        stats.milliseconds.read = film.read_milliseconds(index);
        stats.milliseconds.total += stats.milliseconds.read;
        self.stats.as_mut().map_or(Ok(()), |file| file.add(number, &stats)).map_err(fatal)
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

/// Whether the picture at `path` was made as `record` says. A file is written whole or not at all.
fn is_made(path: &Path, record: &str) -> bool {
    path.is_file() && image_file::record(path).is_some_and(|found| found == record)
}

/// Where one file cannot be written, neither can the next.
fn fatal(error: anyhow::Error) -> anyhow::Error {
    Fatal(format!("{error:#}")).into()
}
