//! The frames of a run one after the other, and what keeps them alike from frame to frame.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use anyhow::{Context, bail};
use indicatif::{ProgressBar, ProgressStyle};
use renderer::{CellMap, ParticleSet, Picture, Progress, Quantity, RenderError, Renderer, Scene, View};

use super::Run;
use super::interrupt::{INTERRUPTED, Interrupt};
use super::survey::Survey;
use crate::frames::{Frame, FrameSource, FrameStream};
use crate::scene::{self, Selection};

/// Bytes of frames that are read ahead.
const READ_AHEAD: usize = 1 << 30;

/// The frames of a run, the view they are shown in, and how far the work on them is.
pub struct Film {
    run: Run,
    view: View,
    stream: FrameStream,
    interrupt: Interrupt,
    bar: ProgressBar,
    /// What the first frame shows where the view does not say; later frames show the same.
    quantity: Option<String>,
}

/// What one frame shows.
pub struct Content {
    pub particles: Arc<ParticleSet>,
    pub quantity: Arc<Quantity>,
    /// The film's, with the quantity's name.
    pub view: View,
}

/// What would happen again with every frame: a lost device, a full disk, the user's wish to stop.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Fatal(pub String);

impl Film {
    /// Frames are read from `sources`, one for each of the run.
    pub fn new(
        run: Run,
        view: View,
        sources: Vec<Arc<dyn FrameSource>>,
        interrupt: Interrupt,
    ) -> anyhow::Result<Film> {
        let bar = bar(sources.len())?;
        let stream = FrameStream::new(sources, READ_AHEAD, || {});
        Ok(Film { run, view, stream, interrupt, bar, quantity: None })
    }

    pub fn len(&self) -> usize {
        self.stream.len()
    }

    /// The number that frame `index` has in the whole run.
    pub fn number(&self, index: usize) -> usize {
        self.run.first + index
    }

    pub fn name(&self, index: usize) -> &str {
        &self.run.sequence.sources()[index].name
    }

    pub fn view(&self) -> &View {
        &self.view
    }

    pub fn interrupted(&self) -> bool {
        self.interrupt.asked()
    }

    /// Does `work` on every frame, and returns the names of those that failed. Each is told when it
    /// fails, and the others go on; the error of an only frame is that of the film.
    pub fn each(
        &mut self,
        mut work: impl FnMut(&mut Film, usize) -> anyhow::Result<()>,
    ) -> anyhow::Result<Vec<String>> {
        let result = self.settle().and_then(|()| self.go_through(&mut work));
        self.bar.finish_and_clear();
        result
    }

    fn go_through(
        &mut self,
        work: &mut impl FnMut(&mut Film, usize) -> anyhow::Result<()>,
    ) -> anyhow::Result<Vec<String>> {
        let mut failed = Vec::new();
        for index in 0..self.len() {
            self.interrupt.check()?;
            match work(self, index) {
                Ok(()) => {}
                Err(error) if self.len() == 1 || error.is::<Fatal>() => return Err(error),
                Err(error) => {
                    self.say(&format!("warning: {}", super::one_line(&error)));
                    failed.push(self.name(index).to_owned());
                }
            }
            show(&self.bar, index, 1.0);
        }
        Ok(failed)
    }

    /// Gives the view of several frames what must not change from one to the next, or the film would
    /// flicker: a camera that has the whole run in view, and a reference length.
    fn settle(&mut self) -> anyhow::Result<()> {
        if self.len() == 1 {
            return Ok(());
        }
        let camera = self.view.camera.is_some_and(|camera| camera.is_settled());
        if !camera || self.view.transfer.reference_length.is_none() {
            self.survey()?;
        }
        if self.view.quantity.range.is_none() {
            self.say(
                "note: colours span the values of each frame; a view with quantity.range keeps them steady",
            );
        }
        Ok(())
    }

    fn survey(&mut self) -> anyhow::Result<()> {
        let mut survey = Survey::default();
        self.bar.set_message("looking through the frames");
        for index in 0..self.len() {
            self.interrupt.check()?;
            // A frame that cannot be read is told when its turn comes.
            if let Ok(frame) = self.stream.wait(index) {
                survey.add(&frame, &self.view);
            }
            show(&self.bar, index, 1.0);
        }
        self.bar.set_message("");
        survey.settle(&mut self.view);
        Ok(())
    }

    /// Waits for frame `index`.
    pub fn frame(&self, index: usize) -> anyhow::Result<Arc<Frame>> {
        let name = self.name(index);
        let frame = self.stream.wait(index).map_err(|why| anyhow::anyhow!("{name}: {why}"))?;
        for warning in &frame.warnings {
            self.say(&format!("warning: {name}: {warning}"));
        }
        Ok(frame)
    }

    /// What `frame`, which is number `index`, shows.
    pub fn content(&mut self, index: usize, frame: &Frame) -> anyhow::Result<Content> {
        let name = self.name(index).to_owned();
        let mut view = self.view.clone();
        if view.quantity.name.is_none() {
            view.quantity.name = self.quantity_of(frame, &name);
        }
        let content = Content::new(frame, view).with_context(|| name.clone())?;
        if let Some(warning) = scene::rejected_warning(frame, &content.particles, &content.quantity) {
            self.say(&format!("warning: {name}: {warning}"));
        }
        Ok(content)
    }

    /// The quantity of a frame where the view names none: that of the frames before it, or the
    /// frame's own where it lacks that.
    fn quantity_of(&mut self, frame: &Frame, name: &str) -> Option<String> {
        let own = Selection::default_of(frame).name();
        if frame.is_empty() {
            return None;
        }
        match &self.quantity {
            Some(before) if Selection::new(frame, Some(before)).is_ok() => Some(before.clone()),
            Some(before) => {
                let shown = own.as_deref().unwrap_or("particles alike");
                self.say(&format!("warning: {name}: has no field `{before}`; shows {shown}"));
                own
            }
            None => {
                self.quantity.clone_from(&own);
                own
            }
        }
    }

    /// Renders a picture of frame `index`, which is the `part` of the work on that frame.
    pub fn render(
        &self,
        renderer: &mut Renderer,
        scene: &Scene,
        index: usize,
        part: Range<f32>,
    ) -> anyhow::Result<Picture> {
        self.follow(index, part, |progress| renderer.render(scene, progress))
    }

    /// The same, with what became of its cells.
    pub fn render_with_cells(
        &self,
        renderer: &mut Renderer,
        scene: &Scene,
        index: usize,
        part: Range<f32>,
    ) -> anyhow::Result<(Picture, CellMap)> {
        self.follow(index, part, |progress| renderer.render_with_cells(scene, progress))
    }

    /// Shows the progress of `work`, and ends it when the user asks for that.
    fn follow<T>(
        &self,
        index: usize,
        part: Range<f32>,
        work: impl FnOnce(&mut Progress) -> Result<T, RenderError>,
    ) -> anyhow::Result<T> {
        let mut progress = |share: f32| {
            show(&self.bar, index, part.start + share * (part.end - part.start));
            if self.interrupt.asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let name = self.name(index);
        match work(&mut progress) {
            Err(RenderError::Cancelled) => bail!(Fatal(INTERRUPTED.to_owned())),
            Err(error @ RenderError::DeviceLost(_)) => bail!(Fatal(format!("{name}: {error}"))),
            result => result.with_context(|| name.to_owned()),
        }
    }

    /// A line on standard error that does not tear the progress bar.
    fn say(&self, line: &str) {
        self.bar.suspend(|| eprintln!("{line}"));
    }
}

impl Content {
    pub fn new(frame: &Frame, view: View) -> anyhow::Result<Content> {
        let radius = view.particles.support_radius;
        let particles = Arc::new(scene::selected_particles(frame, radius, &view.select)?);
        let quantity = Arc::new(scene::quantity(frame, &particles, &view.quantity)?);
        Ok(Content { particles, quantity, view })
    }

    /// The scene that `view` makes of it.
    pub fn scene(&self, view: &View) -> anyhow::Result<Scene> {
        Ok(Scene::new(Arc::clone(&self.particles), Arc::clone(&self.quantity), view)?)
    }
}

/// Steps of the progress bar for one frame.
const STEPS: u64 = 1000;

/// A bar over `frames` frames, on standard error if that is a terminal.
fn bar(frames: usize) -> anyhow::Result<ProgressBar> {
    let bar = ProgressBar::new(frames as u64 * STEPS);
    let template = "{bar:40} {percent:>3} %  {elapsed} gone, {eta} to go  {msg}";
    bar.set_style(ProgressStyle::with_template(template)?);
    Ok(bar)
}

/// Shows that frame `index` is done to the `share`.
fn show(bar: &ProgressBar, index: usize, share: f32) {
    bar.set_position(index as u64 * STEPS + (share * STEPS as f32) as u64);
}
