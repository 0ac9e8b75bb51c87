//! Saving a picture: rendered in full, on a thread and a device of its own, while the window goes on.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, mpsc};

use renderer::{Gpu, GpuOptions, Renderer, View};

use crate::frames::Frame;
use crate::image_file::{self, Pixels};

use super::Wake;
use super::prepare::Preparation;

/// A picture on its way to a file.
pub struct Export {
    pub path: PathBuf,
    /// Thousandths done.
    share: Arc<AtomicU32>,
    cancelled: Arc<AtomicBool>,
    result: mpsc::Receiver<anyhow::Result<()>>,
}

/// What became of an export.
pub enum Outcome {
    Saved,
    Cancelled,
    Failed(String),
}

impl Export {
    pub fn start(frame: Arc<Frame>, view: View, path: PathBuf, options: GpuOptions, wake: Wake) -> Export {
        let (sender, result) = mpsc::channel();
        let share = Arc::new(AtomicU32::new(0));
        let cancelled = Arc::new(AtomicBool::new(false));
        let export = Export {
            path: path.clone(),
            share: Arc::clone(&share),
            cancelled: Arc::clone(&cancelled),
            result,
        };
        std::thread::spawn(move || {
            let mut progress = |done: f32| {
                let thousandths = (done.clamp(0.0, 1.0) * 1000.0) as u32;
                if thousandths >= share.swap(thousandths, Ordering::Relaxed) + 5 {
                    wake();
                }
                match cancelled.load(Ordering::Relaxed) {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            };
            // The window is gone when nobody listens.
            let _ = sender.send(save(&frame, &view, &path, &options, &mut progress));
            wake();
        });
        export
    }

    /// Share done, 0 to 1.
    pub fn share(&self) -> f32 {
        self.share.load(Ordering::Relaxed) as f32 / 1000.0
    }

    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// What became of it, once that is known.
    pub fn poll(&self) -> Option<Outcome> {
        let result = match self.result.try_recv() {
            Ok(result) => result,
            Err(mpsc::TryRecvError::Empty) => return None,
            Err(mpsc::TryRecvError::Disconnected) => {
                return Some(Outcome::Failed("drawing failed in an unforeseen way".into()));
            }
        };
        Some(match result {
            Ok(()) => Outcome::Saved,
            Err(_) if self.cancelled.load(Ordering::Relaxed) => Outcome::Cancelled,
            Err(error) => Outcome::Failed(format!("{error:#}")),
        })
    }
}

fn save(
    frame: &Arc<Frame>,
    view: &View,
    path: &Path,
    options: &GpuOptions,
    progress: &mut dyn FnMut(f32) -> ControlFlow<()>,
) -> anyhow::Result<()> {
    let (scene, _) = Preparation::default().scene(frame, view)?;
    let mut renderer = Renderer::new(Gpu::new(options)?)?;
    let picture = renderer.render(&scene, progress)?;
    let pixels = Pixels { width: picture.width, height: picture.height, data: picture.pixels };
    image_file::write(path, &pixels, view.image.background)
}
