//! What is to be exported, and the way from there to files.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Context;
use renderer::{Gpu, Renderer, View};

use super::{Film, Layer, Listener, Made, Overlay, Pictures, Run, Shard, StatsFile, Steady, Target};
use crate::whole_file::write_whole;

/// Pictures or a video of frames of a run.
pub struct Order {
    pub run: Run,
    /// Only this part of them.
    pub shard: Option<Shard>,
    pub view: View,
    pub steady: Steady,
    pub target: Target,
    pub overlay: Option<Overlay>,
    pub layers: Vec<Layer>,
    pub stats: Option<StatsFile>,
    /// Where the view goes, with what the frames have in common settled.
    pub view_file: Option<PathBuf>,
    /// Whether pictures that are there, and would not look different, are left as they are.
    pub resumes: bool,
}

/// What became of the frames.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Frames that were to be drawn.
    pub frames: usize,
    /// Pictures that were there.
    pub kept: usize,
    /// Names of frames without a picture, each of which was told.
    pub failed: Vec<String>,
}

impl Order {
    /// Makes the files, and tells `listener` how far that is.
    ///
    /// # Errors
    /// What the only frame, or every frame, fails for; the file or flag comes first.
    pub fn carry_out(self, gpu: Gpu, listener: Arc<dyn Listener>) -> anyhow::Result<Summary> {
        let Order { run, shard, view, steady, target, overlay, layers, stats, view_file, resumes } = self;
        let renderer = Renderer::new(gpu).context("sphcast")?;
        let mut pictures = Pictures { renderer, target, overlay, stats, layers, resumes };
        pictures.prepare(&view)?;
        let mut film = Film::new(run, view, shard, listener).steady(steady);
        let mut kept = 0;
        let failed = film.each(|film, index| {
            kept += usize::from(pictures.make(film, index)? == Made::Kept);
            Ok(())
        })?;
        pictures.finish()?;
        if let Some(path) = view_file {
            write_whole(&path, film.common_view().to_json().as_bytes())?;
        }
        Ok(Summary { frames: film.len(), kept, failed })
    }
}
