//! Saving a picture: rendered in full, on a thread and a device of its own.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::bail;
use renderer::{Gpu, GpuOptions, Progress, Renderer, View};

use crate::annotate::Annotations;
use crate::export::MOST_WHOLE;
use crate::frames::Frame;
use crate::image_file::{self, Format, Pixels};

use super::Wake;
use super::task::Task;
use crate::viewer::render_thread::prepare::Preparation;

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
    let [width, height] = [view.image.width, view.image.height];
    if u64::from(width) * u64::from(height) > MOST_WHOLE {
        bail!(
            "{}: {width} x {height} pixels are more than the {MOST_WHOLE} that are saved at once: the export \
             window (Ctrl+Shift+S) writes them in bands",
            path.display()
        );
    }
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

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::frames::Sequence;

    #[test]
    fn what_is_too_large_to_be_saved_at_once_is_told_before_anything_is_made() {
        let sequence = Sequence::open(&["demo:radial:8".into()]).unwrap();
        let frame = Arc::new(sequence.sources()[0].load(&Default::default()).unwrap());
        let mut view = View::default();
        (view.image.width, view.image.height) = (16_384, 16_384);
        let mut progress = |_| -> ControlFlow<()> { panic!("nothing is rendered") };
        let saved = save((0, &frame), &view, Path::new("a.png"), &GpuOptions::default(), &mut progress);
        let error = format!("{:#}", saved.unwrap_err());
        assert!(error.contains("a.png: 16384 x 16384") && error.contains("Ctrl+Shift+S"), "{error}");
    }
}
