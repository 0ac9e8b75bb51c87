//! Undo and redo of what defines the picture: the settings of the view, and the camera.
//!
//! A step is what one gesture changed. A drag is over when the button is released; what wheel and keys
//! change is over when it has rested for a while. Where the camera goes by itself, along its path or after a
//! particle, that is no step: a step takes the camera back only where the user moved it.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use renderer::{CameraView, View};

use super::{RangeSource, Session};
use crate::viewer::orbit_camera::OrbitCamera;

/// The most steps that are kept.
const STEPS: usize = 200;
/// What has not changed for so long is a step of its own.
const REST: Duration = Duration::from_millis(400);

/// What one step goes back to.
#[derive(Clone, Debug)]
struct Moment {
    view: View,
    camera: Option<OrbitCamera>,
    range_sources: [RangeSource; 2],
    quantiles: [[f64; 2]; 2],
    fits_window: bool,
}

impl Moment {
    fn of(session: &Session) -> Moment {
        let mut view = session.view.clone();
        if session.fits_window {
            // The window's size is no setting.
            (view.image.width, view.image.height) = (0, 0);
        }
        if session.camera.is_some() {
            // It is the one that the camera came from.
            view.camera = None;
        }
        Moment {
            view,
            camera: session.camera,
            range_sources: [session.range_source, session.opacity_source],
            quantiles: session.ranges.quantiles,
            fits_window: session.fits_window,
        }
    }

    fn is_same(&self, other: &Moment) -> bool {
        self.view == other.view
            && self.range_sources == other.range_sources
            && self.quantiles == other.quantiles
            && self.fits_window == other.fits_window
            && self.camera_view() == other.camera_view()
    }

    fn camera_view(&self) -> Option<CameraView> {
        self.camera.map(OrbitCamera::to_view)
    }

    fn restore(self, session: &mut Session) {
        let size = (session.view.image.width, session.view.image.height);
        session.view = self.view;
        if self.fits_window {
            (session.view.image.width, session.view.image.height) = size;
        }
        session.camera = self.camera.or(session.camera);
        [session.range_source, session.opacity_source] = self.range_sources;
        session.ranges.quantiles = self.quantiles;
        session.fits_window = self.fits_window;
    }
}

/// What the user changed at once.
#[derive(Clone, Debug)]
struct Step {
    /// What it leads back to, or on to where it was undone.
    to: Moment,
    /// Whether the camera is one of the things that were changed.
    steered: bool,
}

impl Step {
    /// Puts the session where the step leads. Returns the step that leads back here.
    fn take(mut self, session: &mut Session) -> Option<Step> {
        let camera = session.camera;
        if !self.steered {
            self.to.camera = camera.or(self.to.camera);
        }
        let present = session.history.present.replace(self.to.clone());
        self.to.restore(session);
        present.map(|moment| Step { to: Moment { camera, ..moment }, steered: self.steered })
    }
}

/// Steps back and forth, and the one that is being made.
#[derive(Default)]
pub struct History {
    past: VecDeque<Step>,
    /// The last moment at rest.
    present: Option<Moment>,
    future: Vec<Step>,
    /// How things were at the last look, and since when.
    latest: Option<(Moment, Instant)>,
    held: bool,
}

impl History {
    /// Changes the views of all steps in a way that is no step itself.
    pub(super) fn each_view(&mut self, change: impl Fn(&mut View)) {
        let History { past, present, future, latest, held: _ } = self;
        let latest = latest.as_mut().map(|(moment, _)| moment);
        let steps = past.iter_mut().chain(future).map(|step| &mut step.to);
        steps.chain(present).chain(latest).for_each(|moment| change(&mut moment.view));
    }

    fn commit(&mut self, moment: Moment) {
        let after = moment.camera_view();
        let Some(before) = self.present.replace(moment) else { return };
        self.future.clear();
        let steered = before.camera_view() != after;
        self.past.push_back(Step { to: before, steered });
        if self.past.len() > STEPS {
            self.past.pop_front();
        }
    }
}

impl Session {
    /// Takes note of how things are. `held`: whether a hand is on something, so that a gesture goes on.
    pub fn remember(&mut self, now: Instant, held: bool) {
        let moment = Moment::of(self);
        let history = &mut self.history;
        let released = history.held && !held;
        history.held = held;
        let Some(present) = &mut history.present else {
            history.present = Some(moment);
            return;
        };
        match (present.camera, moment.camera) {
            // The next picture finds a place for the camera of a view that was loaded.
            (Some(_), None) => return,
            // To find the first one is no step of the user's.
            (None, Some(_)) => {
                (present.camera, present.view.camera) = (moment.camera, None);
            }
            _ => {}
        }
        if present.is_same(&moment) {
            history.latest = None;
            return;
        }
        let since = match &history.latest {
            Some((latest, since)) if latest.is_same(&moment) => *since,
            _ => now,
        };
        if released || (!held && now >= since + REST) {
            history.latest = None;
            history.commit(moment);
        } else {
            history.latest = Some((moment, since));
        }
    }

    /// Says that the camera went on from `before` by itself: that is no step of the user's. Where the user had
    /// moved it since the last step, that is still one.
    pub(super) fn moved_by_itself(&mut self, before: OrbitCamera) {
        let History { present, latest, .. } = &mut self.history;
        for moment in present.iter_mut().chain(latest.iter_mut().map(|(moment, _)| moment)) {
            if moment.camera_view() == Some(before.to_view()) {
                moment.camera = self.camera;
            }
        }
    }

    /// When what has changed last is a step, if nothing else happens.
    pub(super) fn step_due(&self) -> Option<Instant> {
        let history = &self.history;
        history.latest.as_ref().filter(|_| !history.held).map(|(_, since)| *since + REST)
    }

    pub fn can_undo(&self) -> bool {
        !self.history.past.is_empty() || self.history.latest.is_some()
    }

    pub fn can_redo(&self) -> bool {
        !self.history.future.is_empty() && self.history.latest.is_none()
    }

    /// Goes back by one step. What is not yet a step becomes one first.
    pub fn undo(&mut self) {
        if let Some((moment, _)) = self.history.latest.take() {
            self.history.commit(moment);
        }
        let Some(step) = self.history.past.pop_back() else { return };
        let back = step.take(self);
        self.history.future.extend(back);
        self.log("undone");
    }

    /// Takes back what was last undone.
    pub fn redo(&mut self) {
        if !self.can_redo() {
            return;
        }
        let Some(step) = self.history.future.pop() else { return };
        let back = step.take(self);
        self.history.past.extend(back);
        self.log("redone");
    }
}

#[cfg(test)]
#[path = "history_tests.rs"]
mod tests;
