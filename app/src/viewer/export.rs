//! Saving a picture: rendered in full, on a thread and a device of its own.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use renderer::{Gpu, GpuOptions, Progress, Renderer, View};

use crate::annotate::Annotations;
use crate::frames::Frame;
use crate::image_file::{self, Format, Pixels};

use super::Wake;
use super::prepare::Preparation;
use super::task::Task;

/// A picture on its way to a file.
pub struct Export {
    pub path: PathBuf,
    pub task: Task<()>,
}

impl Export {
    /// Starts to save the picture that `view` shows of frame `index` of the run.
    pub fn start(
        (index, frame): (usize, Arc<Frame>),
        view: View,
        path: PathBuf,
        options: GpuOptions,
        wake: Wake,
    ) -> Export {
        let to = path.clone();
        let task = Task::start(wake, move |progress| save((index, &frame), &view, &to, &options, progress));
        Export { path, task }
    }
}

fn save(
    (index, frame): (usize, &Arc<Frame>),
    view: &View,
    path: &Path,
    options: &GpuOptions,
    progress: &mut Progress,
) -> anyhow::Result<()> {
    let (scene, _) = Preparation::default().scene(frame, view)?;
    let mut renderer = Renderer::new(Gpu::new(options)?)?;
    let picture = renderer.render(&scene, progress)?;
    let mut pixels = Pixels { width: picture.width, height: picture.height, data: picture.pixels };
    if let (Some(annotations), Some(format)) =
        (Annotations::new(view, &scene, frame, index), Format::of(path))
    {
        annotations.draw_onto(&mut pixels, format);
    }
    image_file::write(path, &pixels, view.image.background)
}
