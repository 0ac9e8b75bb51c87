//! What is to be exported, with all that decides how it looks.

use std::path::PathBuf;
use std::sync::Arc;

use renderer::{PathView, View};

use crate::export::video::{USUAL_RATE, Video, VideoFormat};
use crate::export::{Layer, Order, Output, Run, StatsFile, Steady, Target};
use crate::frames::{Frame, Sequence};
use crate::image_file::Format;
use crate::viewer::session::Session;

/// What is to be exported, as often as it is started.
#[derive(Clone)]
pub struct Plan {
    pub sequence: Sequence,
    /// The first and the last frame, and how many steps there are from one to the next.
    pub first: usize,
    pub last: usize,
    pub every: usize,
    /// A frame that need not be read, and its number.
    pub in_memory: Option<(usize, Arc<Frame>)>,
    pub view: View,
    pub steady: Steady,
    /// A file, a number pattern, or a video.
    pub path: PathBuf,
    /// Whether braces in it stand for the number of the frame.
    pub numbered: bool,
    /// Pictures a second of a video.
    pub rate: f64,
    pub layers: Vec<Layer>,
    pub view_file: Option<PathBuf>,
    pub stats_file: Option<PathBuf>,
    pub resumes: bool,
}

impl Plan {
    /// All frames from `first` to `last`, as far as the run of `session` has them. `None` where there is no
    /// run.
    pub fn of_run(session: &Session, [first, last]: [usize; 2], path: PathBuf) -> Option<Plan> {
        let sequence = session.run()?.sequence.clone();
        let end = sequence.len().checked_sub(1)?;
        Some(Plan {
            first: first.min(end),
            last: last.clamp(first.min(end), end),
            sequence,
            every: 1,
            in_memory: None,
            view: session.saved_view(),
            steady: session.steady(),
            path,
            numbered: true,
            rate: USUAL_RATE,
            layers: Vec::new(),
            view_file: None,
            stats_file: None,
            resumes: false,
        })
    }

    /// One picture: the frame in view of `session`, as it is seen. `None` where there is none.
    pub fn in_view(session: &Session, path: PathBuf) -> Option<Plan> {
        let (index, frame) = session.frame()?.clone();
        // The camera is where it is, and not where a path would have it.
        let view = View { path: PathView::default(), ..session.complete_view() };
        let in_memory = Some((index, frame));
        Some(Plan { in_memory, view, numbered: false, ..Plan::of_run(session, [index; 2], path)? })
    }

    /// # Errors
    /// What is wrong with the path.
    pub fn order(&self) -> anyhow::Result<Order> {
        let mut run = Run::whole(self.sequence.clone());
        run.select(self.first..self.last + 1, self.every.max(1));
        run.in_memory = self.in_memory.clone();
        let frames = run.sequence.len();
        let target = match VideoFormat::of(&self.path) {
            Some(format) => Target::Video(Video::new(self.path.clone(), format, self.rate)),
            None if !self.numbered => Target::Files(Output::One(self.path.clone())),
            None => {
                let output = Output::new(&self.path, frames, &[Format::Png, Format::Exr]);
                Target::Files(output.map_err(anyhow::Error::msg)?)
            }
        };
        if let Some(folder) = self.path.parent() {
            Output::Directory(folder.to_owned()).prepare()?;
        }
        let stats = self.stats_file.clone().map(|path| StatsFile::new(path, frames > 1, self.resumes));
        Ok(Order {
            run,
            shard: None,
            view: self.view.clone(),
            steady: self.steady,
            target,
            overlay: None,
            layers: self.layers.clone(),
            stats,
            view_file: self.view_file.clone(),
            resumes: self.resumes,
        })
    }
}
