//! The frames of a run one after the other, and what keeps them alike from frame to frame.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use anyhow::{Context, bail};
use renderer::{
    BandLayers, BandTaker, CellMap, ParticleSet, Picture, Progress, Quantity, RenderError, Renderer, Scene,
    Stats, View,
};

use super::listener::{INTERRUPTED, Listener, Stage};
use super::survey::{Steady, Survey};
use super::{Shard, one_line};
use crate::camera_path;
use crate::frames::{Frame, FrameSource, FrameStream, Sequence, Source, Timed};
use crate::scene::{self, Selection};

/// Bytes of frames that are read ahead.
const READ_AHEAD: usize = 1 << 30;

/// Frames of an opened run.
pub struct Run {
    pub sequence: Sequence,
    /// The number of each of them in the whole run.
    pub numbers: Vec<usize>,
    /// Number of frames of the whole run.
    pub frames: usize,
    /// A frame that need not be read, and its number in the whole run.
    pub in_memory: Option<(usize, Arc<Frame>)>,
}

impl Run {
    /// All frames of `sequence`.
    pub fn whole(sequence: Sequence) -> Run {
        let frames = sequence.len();
        Run { numbers: (0..frames).collect(), sequence, frames, in_memory: None }
    }

    /// Keeps every `step`-th frame of a range.
    ///
    /// # Panics
    /// Where the range goes past the end, or `step` is 0.
    pub fn select(&mut self, range: Range<usize>, step: usize) {
        self.sequence.select(range.clone().step_by(step));
        self.numbers = range.step_by(step).map(|place| self.numbers[place]).collect();
    }

    /// Makes a run of its first frame alone, `pictures` times.
    pub fn repeat(&mut self, pictures: usize) {
        self.sequence.select(std::iter::repeat_n(0, pictures));
        self.numbers = (0..pictures).collect();
        self.frames = pictures;
    }

    /// Where the frame at `place` comes from.
    fn source(&self, place: usize) -> Arc<dyn FrameSource> {
        match &self.in_memory {
            Some((number, frame)) if *number == self.numbers[place] => Arc::new(Arc::clone(frame)),
            _ => Arc::clone(&self.sequence.sources()[place]) as Arc<dyn FrameSource>,
        }
    }

    /// Whether it is one frame, once or more often.
    fn is_one_frame(&self) -> bool {
        self.sequence.sources().windows(2).all(|pair| Arc::ptr_eq(&pair[0], &pair[1]))
    }
}

/// The frames of a run, or a part of them, and the view they are shown in.
pub struct Film {
    run: Run,
    /// Places in the run of the frames that are worked on.
    part: Vec<usize>,
    view: View,
    steady: Steady,
    /// One for each of the part; a frame that is repeated has but one.
    sources: Vec<Arc<Timed>>,
    /// Of the sources.
    stream: FrameStream,
    listener: Arc<dyn Listener>,
    /// What the first frame of the run shows where the view does not say; the others show the same.
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
    /// The frames of `run` that are `shard`'s, or all of them. What they have in common is that of the whole
    /// run, whatever the part.
    pub fn new(run: Run, mut view: View, shard: Option<Shard>, listener: Arc<dyn Listener>) -> Film {
        let taken = |place: &usize| shard.is_none_or(|shard| shard.takes(*place));
        let part: Vec<usize> = (0..run.sequence.len()).filter(taken).collect();
        // They are no part of any picture.
        view.bookmarks.clear();
        let read = if run.is_one_frame() { part.len().min(1) } else { part.len() };
        let sources: Vec<Arc<Timed>> =
            part[..read].iter().map(|&place| Timed::new(run.source(place))).collect();
        let streamed = sources.iter().map(|source| Arc::clone(source) as Arc<dyn FrameSource>).collect();
        let stream = FrameStream::new(streamed, READ_AHEAD, || {});
        Film { run, part, view, steady: Steady::default(), sources, stream, listener, quantity: None }
    }

    /// The same, in ranges of all frames.
    pub fn steady(self, steady: Steady) -> Film {
        Film { steady, ..self }
    }

    /// Number of frames that are worked on.
    pub fn len(&self) -> usize {
        self.part.len()
    }

    /// The number that frame `index` has in the whole run.
    pub fn number(&self, index: usize) -> usize {
        self.run.numbers[self.part[index]]
    }

    pub fn source(&self, index: usize) -> &Source {
        &self.run.sequence.sources()[self.part[index]]
    }

    pub fn name(&self, index: usize) -> &str {
        &self.source(index).name
    }

    /// How long reading frame `index` took.
    pub fn read_milliseconds(&self, index: usize) -> f64 {
        self.sources[self.slot(index)].milliseconds()
    }

    pub fn view(&self) -> &View {
        &self.view
    }

    /// The view with what the frames have in common, once that is known: alike for all of them.
    pub fn common_view(&self) -> View {
        let mut view = self.view.clone();
        view.quantity.name = view.quantity.name.or_else(|| self.quantity.clone());
        view
    }

    /// Frames of the whole run, where the camera goes by how many there are.
    pub fn camera_frames(&self) -> Option<usize> {
        (!self.view.path.is_empty()).then_some(self.run.frames)
    }

    pub fn interrupted(&self) -> bool {
        self.listener.wants_end()
    }

    fn check(&self) -> anyhow::Result<()> {
        if self.interrupted() { bail!(INTERRUPTED) } else { Ok(()) }
    }

    /// The source that frame `index` is read from.
    fn slot(&self, index: usize) -> usize {
        index.min(self.sources.len() - 1)
    }

    /// Whether there is more than one frame in the run, of which some may fail.
    fn is_sequence(&self) -> bool {
        !self.run.is_one_frame()
    }

    /// Does `work` on every frame, and returns the names of those that failed. Each is told when it
    /// fails, and the others go on; the error of an only frame is that of the film.
    pub fn each(
        &mut self,
        mut work: impl FnMut(&mut Film, usize) -> anyhow::Result<()>,
    ) -> anyhow::Result<Vec<String>> {
        self.settle()?;
        self.go_through(&mut work)
    }

    fn go_through(
        &mut self,
        work: &mut impl FnMut(&mut Film, usize) -> anyhow::Result<()>,
    ) -> anyhow::Result<Vec<String>> {
        let mut failed = Vec::new();
        for index in 0..self.len() {
            self.check()?;
            match work(self, index) {
                Ok(()) => {}
                Err(error) if !self.is_sequence() || error.is::<Fatal>() => return Err(error),
                Err(error) => {
                    self.say(&format!("warning: {}", one_line(&error)));
                    failed.push(self.name(index).to_owned());
                }
            }
            self.show(Stage::Pictures, index, 1.0);
        }
        Ok(failed)
    }

    /// Gives the view of several frames what must not change from one to the next, or the film would
    /// flicker: a camera that has the whole run in view, a reference length, and ranges that are to be steady.
    fn settle(&mut self) -> anyhow::Result<()> {
        if !self.is_sequence() || self.len() == 0 {
            return Ok(());
        }
        let camera = self.view.camera.is_some_and(|camera| camera.is_settled());
        let steady = self.steady != Steady::default();
        let settled = camera && self.view.transfer.reference_length.is_some() && !steady;
        if !settled || self.view.quantity.name.is_none() {
            self.survey(settled)?;
        }
        if self.view.quantity.range.is_none() {
            self.say("note: colours span the values of each frame; --steady keeps to those of all frames");
        }
        if self.view.quantity.opacity.as_ref().is_some_and(|opacity| opacity.range.is_none()) {
            self.say("note: opacities span the values of each frame; --steady keeps to those of all frames");
        }
        Ok(())
    }

    /// Looks through the frames of the whole run; for the quantity only, no farther than the first that tells.
    fn survey(&mut self, quantity_only: bool) -> anyhow::Result<()> {
        let count = self.run.sequence.len();
        // What a part reads ahead would not do for the whole.
        let whole = (self.len() < count)
            .then(|| FrameStream::new(self.run.sequence.frame_sources(), READ_AHEAD, || {}));
        let stream = whole.as_ref().unwrap_or(&self.stream);
        let mut survey = Survey::default();
        for index in 0..count {
            self.check()?;
            // A frame that cannot be read is told when its turn comes.
            if let Ok(frame) = stream.wait(index) {
                match quantity_only {
                    true if survey.add_quantity(&frame) => break,
                    true => {}
                    false => survey.add(&frame, &self.view),
                }
            }
            self.listener.show(Stage::Survey, index, 1.0, count);
        }
        self.quantity = survey.quantity();
        if !quantity_only {
            survey.settle(&mut self.view, self.steady);
        }
        Ok(())
    }

    /// Waits for frame `index`.
    pub fn frame(&self, index: usize) -> anyhow::Result<Arc<Frame>> {
        let name = self.name(index);
        let frame = self.stream.wait(self.slot(index)).map_err(|why| anyhow::anyhow!("{name}: {why}"))?;
        for warning in &frame.warnings {
            self.say(&format!("warning: {name}: {warning}"));
        }
        Ok(frame)
    }

    /// What `frame`, which is number `index`, shows.
    pub fn content(&self, index: usize, frame: &Frame) -> anyhow::Result<Content> {
        let name = self.name(index).to_owned();
        let mut view = self.view.clone();
        if view.quantity.name.is_none() {
            view.quantity.name = self.quantity_of(frame, &name);
        }
        let mut content = Content::new(frame, view).with_context(|| name.clone())?;
        let frames = self.run.frames;
        content.view.camera =
            camera_path::camera_of(&content.view, &content.particles, self.number(index), frames);
        if let Some(warning) = scene::rejected_warning(frame, &content.particles, &content.quantity) {
            self.say(&format!("warning: {name}: {warning}"));
        }
        Ok(content)
    }

    /// The quantity of a frame where the view names none: that of the run, or the frame's own where it
    /// lacks that.
    fn quantity_of(&self, frame: &Frame, name: &str) -> Option<String> {
        let own = Selection::default_of(frame).name();
        if frame.is_empty() {
            return None;
        }
        match &self.quantity {
            Some(common) if Selection::new(frame, Some(common)).is_ok() => Some(common.clone()),
            Some(common) => {
                let shown = own.as_deref().unwrap_or("particles alike");
                self.say(&format!("warning: {name}: has no field `{common}`; shows {shown}"));
                own
            }
            None => own,
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

    /// The same in bands of so many rows, for a picture that is not to be held as a whole, with `layers` of each
    /// pixel.
    pub fn render_bands(
        &self,
        renderer: &mut Renderer,
        scene: &Scene,
        index: usize,
        part: Range<f32>,
        (rows, layers): (u32, BandLayers),
        take: &mut BandTaker,
    ) -> anyhow::Result<Stats> {
        self.follow(index, part, |progress| renderer.render_bands(scene, rows, layers, progress, take))
    }

    /// The depths of the pixels of frame `index`.
    pub fn render_depths(
        &self,
        renderer: &mut Renderer,
        scene: &Scene,
        index: usize,
        part: Range<f32>,
    ) -> anyhow::Result<Vec<f32>> {
        self.follow(index, part, |progress| renderer.render_depths(scene, progress))
    }

    /// Shows the progress of `work`, and ends it when the user asks for that.
    fn follow<T>(
        &self,
        index: usize,
        part: Range<f32>,
        work: impl FnOnce(&mut Progress) -> Result<T, RenderError>,
    ) -> anyhow::Result<T> {
        let mut progress = |share: f32| {
            self.show(Stage::Pictures, index, part.start + share * (part.end - part.start));
            if self.interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let name = self.name(index);
        match work(&mut progress) {
            Err(RenderError::Cancelled) => bail!(Fatal(INTERRUPTED.to_owned())),
            Err(error @ RenderError::DeviceLost(_)) => bail!(Fatal(format!("{name}: {error}"))),
            result => result.with_context(|| name.to_owned()),
        }
    }

    fn show(&self, stage: Stage, index: usize, share: f32) {
        self.listener.show(stage, index, share, self.len());
    }

    pub fn say(&self, line: &str) {
        self.listener.say(line);
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
