//! The state of the program: run, playhead, view, messages. Knows no window and no egui.

mod cameras;
mod costs;
mod fields;
mod history;
mod live;
mod looking;
mod picture;
mod playhead;
mod pooled;
mod range;
mod reading;
mod renumber;
mod space;
mod wish;

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use renderer::{Bounds, SelectView, View};

use crate::frames::{Frame, FrameState, Insertion};

use super::kept::LastSession;
use super::messages::Messages;
use super::orbit_camera::OrbitCamera;
use super::playback::Playback;
use super::render_thread::Job;
use super::run::Run;
use crate::viewer::analysis::distribution::{Analysis, Question};
use crate::viewer::analysis::field_ranges::FieldRanges;
use crate::viewer::analysis::pool::Pool;
use crate::viewer::analysis::statistics;
use crate::viewer::picture::overlay::Overlay;
use crate::viewer::render_thread::budget::Budget;
use cameras::Cameras;
pub use costs::{Costs, Entry, Stage};
use history::History;
pub use looking::{End, Looking, Tool};
pub use picture::PictureFacts;
pub use range::{RangeSource, Ranges, Role, Survey};
use reading::GLANCE;
pub use renumber::Numbering;

pub struct Session {
    run: Option<Run>,
    /// Everything that defines the picture, except for the camera and a range of all frames seen.
    pub view: View,
    /// `None` until the size of the scene is known.
    pub camera: Option<OrbitCamera>,
    pub playback: Playback,
    pub messages: Messages,
    pub range_source: RangeSource,
    /// The same of the field that decides the opacity, where that is another one.
    pub opacity_source: RangeSource,
    /// Whether the image has the size that it has in the window.
    pub fits_window: bool,
    /// The last frame that was read at the playhead.
    frame: Option<(usize, Arc<Frame>)>,
    pub picture: Option<PictureFacts>,
    /// What the pictures drawn lately took.
    pub costs: Costs,
    /// What moving pictures may take.
    pub budget: Budget,
    /// What lies over the picture.
    pub overlay: Overlay,
    /// The pixel of the full-size picture whose bundle is looked at.
    pub probe: Option<[u32; 2]>,
    /// The tool in hand, and what was found with it.
    pub looking: Looking,
    pub analysis: Option<Analysis>,
    /// The values in all frames in memory, and whether they are wanted.
    pub pool: Pool,
    pub wants_pool: bool,
    /// Of the fields of a frame, and whether they are wanted.
    pub field_ranges: Option<FieldRanges>,
    pub wants_field_ranges: bool,
    /// Of the particles in the picture, and whether they are wanted.
    pub statistics: Option<statistics::Answer>,
    pub wants_statistics: bool,
    /// Adapter's name, and whether it is a program on the CPU.
    pub adapter: Option<(String, bool)>,
    pub ranges: Ranges,
    /// How many runs were opened.
    openings: usize,
    /// Frames of this run that came between others.
    insertions: Vec<Insertion>,
    /// Whether the fields in the view were chosen for another run, no frame of this one being known.
    inherits_fields: bool,
    /// Frames that were reported as bad.
    told: BTreeSet<usize>,
    /// Whether the playhead goes to each new frame of a run that is being written.
    following: bool,
    /// Frames of which it was said that particles are left out.
    told_left_out: BTreeSet<usize>,
    /// The frame whose picture failed, so that playing goes on.
    without_picture: Option<usize>,
    /// Box around the particles of all frames pictured so far, and their largest support radius.
    extent: (Option<Bounds>, f64),
    moving_until: Option<Instant>,
    /// How the camera moves by itself.
    cameras: Cameras,
    asked: Option<Job>,
    /// Room for the picture in the window, in physical pixels.
    room: [u32; 2],
    history: History,
    /// Lines for whoever follows the program from outside.
    events: Vec<String>,
}

/// How long after the last change the picture counts as moving.
const SETTLE: Duration = Duration::from_millis(200);

impl Session {
    pub fn new(view: View) -> Session {
        let mut session = Session {
            run: None,
            view: View::default(),
            camera: None,
            playback: Playback::new(0),
            messages: Messages::default(),
            range_source: RangeSource::Frame,
            opacity_source: RangeSource::Frame,
            fits_window: true,
            frame: None,
            picture: None,
            costs: Costs::default(),
            budget: Budget::default(),
            overlay: Overlay::default(),
            probe: None,
            looking: Looking::default(),
            analysis: None,
            pool: Pool::default(),
            wants_pool: false,
            field_ranges: None,
            wants_field_ranges: false,
            statistics: None,
            wants_statistics: false,
            adapter: None,
            ranges: Ranges::default(),
            openings: 0,
            insertions: Vec::new(),
            inherits_fields: false,
            told: BTreeSet::new(),
            following: false,
            told_left_out: BTreeSet::new(),
            without_picture: None,
            extent: (None, 0.0),
            moving_until: None,
            cameras: Cameras::default(),
            asked: None,
            room: [0, 0],
            history: History::default(),
            events: Vec::new(),
        };
        session.adopt(view);
        session
    }

    /// Shows another run, from its first frame on. Keeps what is not about the run itself.
    pub fn open(&mut self, run: Run) {
        let first = self.run.is_none();
        if run.stream.len() > 1 {
            // Colours that jump from frame to frame hide what changes.
            self.range_sources().into_iter().for_each(RangeSource::steady);
        }
        self.playback = self.playback.restarted(run.stream.len());
        self.log(format!("opened {} frames={}", run.title, run.stream.len()));
        self.run = Some(run);
        // What is still being found out about the run before is of no use any more.
        self.openings += 1;
        self.insertions.clear();
        self.ask_again();
        (self.frame, self.picture, self.analysis, self.without_picture) = (None, None, None, None);
        self.pool = Pool::default();
        self.probe = None;
        self.looking.forget();
        (self.field_ranges, self.statistics) = (None, None);
        self.inherits_fields = !first;
        self.history = History::default();
        self.cameras = Cameras::default();
        self.ranges.clear();
        self.told.clear();
        self.told_left_out.clear();
        self.following = false;
        self.extent = (None, 0.0);
        if !first {
            // The settings of another run's place and scale.
            (self.camera, self.view.camera) = (None, None);
            self.view.particles.support_radius = None;
            self.view.select = SelectView::default();
            self.view.transfer.reference_length = None;
            self.forget_ranges();
            self.forget_cameras();
        }
    }

    /// Takes over the settings of a view that is valid.
    pub fn adopt(&mut self, view: View) {
        match (&mut self.camera, &view.camera) {
            (Some(camera), Some(given)) if given.is_settled() => camera.adopt(given),
            _ => self.camera = None,
        }
        self.inherits_fields = false;
        self.range_source = RangeSource::of(view.quantity.range);
        self.opacity_source = RangeSource::of(view.quantity.opacity.as_ref().and_then(|field| field.range));
        let size = [view.image.width, view.image.height];
        self.fits_window = self.fits_window && (self.room == [0, 0] || size == self.room);
        self.view = view;
    }

    /// Goes on as in `last`, whose run is open.
    pub fn restore(&mut self, last: LastSession) {
        self.adopt(last.view);
        // The room was another one, so sizes tell nothing.
        self.fits_window = last.fits_window.unwrap_or(self.fits_window);
        self.jump(last.frame);
    }

    pub fn run(&self) -> Option<&Run> {
        self.run.as_ref()
    }

    /// The frame in view and its place in the sequence; behind the playhead while that one is read.
    pub fn frame(&self) -> Option<&(usize, Arc<Frame>)> {
        self.frame.as_ref()
    }

    /// Why the frame at the playhead is not in view, where it cannot be.
    pub fn trouble(&self) -> Option<Arc<str>> {
        match self.run.as_ref()?.stream.get(self.playback.index()) {
            FrameState::Failed(why) if !self.is_being_written() => Some(why),
            _ => None,
        }
    }

    /// Whether the frame at the playhead may be only half written yet.
    fn is_being_written(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.is_unsettled(self.playback.index()))
    }

    /// Whether the frame at the playhead is still being read.
    pub fn waiting(&self) -> bool {
        let index = self.playback.index();
        let here = self.frame.as_ref().is_some_and(|(frame, _)| *frame == index);
        self.playback.count() > 0 && !here && self.trouble().is_none()
    }

    /// Says that something moves, so that the next pictures must be quick.
    pub fn touch(&mut self, now: Instant) {
        self.moving_until = Some(now + SETTLE);
    }

    /// Looks for frames that have arrived, moves the playhead while playing, and the camera on its way.
    pub fn poll(&mut self, now: Instant) {
        self.messages.expire(now);
        self.take_changes();
        self.move_playhead(now);
        self.move_camera(now);
    }

    /// What is to be counted for the histogram, where that is not known.
    pub fn question(&self) -> Option<Question> {
        let (index, frame) = self.frame.as_ref()?;
        let settled = self.complete_view().quantity;
        let question = Question {
            index: *index,
            frame: Arc::clone(frame),
            colour: self.axis(Role::Colour, settled.range)?,
            opacity: settled.opacity.and_then(|opacity| self.axis(Role::Opacity, opacity.range)),
        };
        let known = self.analysis.as_ref().is_some_and(|answer| question.is_answered_by(answer));
        (!known).then_some(question)
    }

    pub fn answer(&mut self, analysis: Analysis) {
        self.see(&analysis);
        self.analysis = Some(analysis);
    }

    /// Puts the whole run, as far as it was seen, in view.
    pub fn reset_camera(&mut self) {
        let [width, height] = self.fitted();
        let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
        if let (Some(camera), (bounds @ Some(_), margin)) = (&mut self.camera, self.extent) {
            camera.reset(bounds, margin, aspect);
        }
    }

    /// Says what went wrong.
    pub fn complain(&mut self, text: impl Into<String>) {
        let text = text.into();
        self.log(format!("error {text}"));
        self.messages.error(text);
    }

    /// Says that a device was lost, and that work goes on.
    pub fn recovered(&mut self, text: &str) {
        self.log(format!("recovered {text}"));
        self.messages.warn(text);
    }

    /// When to look again although nothing happens.
    pub fn due(&self, now: Instant) -> Option<Instant> {
        let settled = self.moving_until.filter(|until| now < *until);
        let reading = self.reading().map(|_| now + GLANCE);
        let own = [self.playback.due(), self.messages.due(), self.step_due()];
        own.into_iter().chain([settled, reading, self.flight_due(now)]).flatten().min()
    }

    pub fn log(&mut self, event: impl Into<String>) {
        self.events.push(event.into());
    }

    /// The events since the last call.
    pub fn take_events(&mut self) -> Vec<String> {
        std::mem::take(&mut self.events)
    }
}

#[cfg(test)]
#[path = "session_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "session/opening_tests.rs"]
mod opening_tests;
