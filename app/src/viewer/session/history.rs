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
mod tests {
    use super::*;
    use crate::viewer::orbit_camera::Side;

    /// A session with a camera, whose first moment is known, and the time after that.
    fn session() -> (Session, Instant) {
        let mut session = Session::new(View::default());
        session.camera = Some(OrbitCamera::overview(None, 0.0, 1.0));
        let now = Instant::now();
        session.remember(now, false);
        (session, now)
    }

    fn set(session: &mut Session, rate: f64) {
        session.view.sampling.rate = rate;
    }

    #[test]
    fn a_drag_is_one_step() {
        let (mut session, now) = session();
        for step in 1..=10 {
            set(&mut session, 1.0 + f64::from(step));
            session.remember(now + step * REST, true);
        }
        session.remember(now + 10 * REST, false);
        // The next one follows at once, and is a step of its own.
        set(&mut session, 20.0);
        session.remember(now + 10 * REST, true);
        session.remember(now + 10 * REST, false);
        session.undo();
        assert_eq!(session.view.sampling.rate, 11.0);
        session.undo();
        assert_eq!(session.view.sampling.rate, 1.0);
        assert!(!session.can_undo());
        session.redo();
        session.redo();
        assert_eq!(session.view.sampling.rate, 20.0);
        assert!(!session.can_redo());
    }

    #[test]
    fn what_wheel_and_keys_change_is_a_step_when_it_rests() {
        let (mut session, now) = session();
        for tick in 1..=5 {
            set(&mut session, 1.0 + f64::from(tick));
            session.remember(now + tick * REST / 2, false);
        }
        assert!(session.step_due().is_some_and(|due| due > now + 3 * REST));
        session.remember(now + 4 * REST, false);
        assert_eq!(session.step_due(), None);
        set(&mut session, 9.0);
        session.remember(now + 4 * REST, false);
        session.undo();
        assert_eq!(session.view.sampling.rate, 6.0, "what has not yet rested is undone by itself");
        session.undo();
        assert_eq!(session.view.sampling.rate, 1.0);
    }

    #[test]
    fn camera_range_and_size_are_settings_too() {
        let (mut session, now) = session();
        session.range_source = RangeSource::Fixed;
        session.view.quantity.range = Some([1.0, 2.0]);
        session.remember(now, false);
        session.remember(now + REST, false);
        let before = session.camera;
        session.camera.as_mut().unwrap().look_from(Side::NegX);
        session.remember(now + REST, true);
        session.remember(now + REST, false);
        session.undo();
        assert_eq!(session.camera, before);
        session.undo();
        assert_eq!((session.range_source, session.view.quantity.range), (RangeSource::Frame, None));
        session.redo();
        assert_eq!(session.range_source, RangeSource::Fixed);
    }

    /// Moves the camera as its path does.
    fn goes_on(session: &mut Session, by: f64) {
        let camera = session.camera.as_mut().unwrap();
        let before = *camera;
        camera.shift(glam::DVec3::new(by, 0.0, 0.0));
        session.moved_by_itself(before);
    }

    #[test]
    fn a_step_takes_only_a_camera_back_that_the_user_moved() {
        let (mut session, now) = session();
        set(&mut session, 3.0);
        session.remember(now, true);
        session.remember(now, false);
        for _ in 0..50 {
            goes_on(&mut session, 1.0);
            session.remember(now, false);
        }
        let here = session.camera.unwrap().to_view();
        session.undo();
        assert_eq!((session.view.sampling.rate, session.camera.unwrap().to_view()), (1.0, here));
        assert!(!session.can_undo() && session.can_redo(), "to go along is no step, and ends no others");
        goes_on(&mut session, 1.0);
        session.remember(now, false);
        let farther = session.camera.unwrap().to_view();
        session.redo();
        assert_eq!((session.view.sampling.rate, session.camera.unwrap().to_view()), (3.0, farther));
        session.undo();
        session.redo();
        assert_eq!(session.camera.unwrap().to_view(), farther);
    }

    #[test]
    fn a_camera_that_the_user_turns_on_its_way_is_a_step() {
        let (mut session, now) = session();
        goes_on(&mut session, 1.0);
        let before = session.camera.unwrap().to_view();
        session.camera.as_mut().unwrap().look_from(Side::NegX);
        session.remember(now, true);
        goes_on(&mut session, 1.0);
        session.remember(now, true);
        session.remember(now, false);
        assert!(session.can_undo());
        let turned = session.camera.unwrap().to_view();
        session.undo();
        assert_eq!(session.camera.unwrap().to_view(), before);
        session.redo();
        assert_eq!(session.camera.unwrap().to_view(), turned);
        // With the wheel, it is one when the user has rested, although the camera goes on.
        session.camera.as_mut().unwrap().look_from(Side::PosY);
        for tick in 0..5 {
            session.remember(now + tick * REST / 2, false);
            goes_on(&mut session, 1.0);
        }
        assert_eq!((session.history.past.len(), session.step_due()), (2, None));
    }

    #[test]
    fn the_field_of_the_opacity_is_a_setting_with_its_range() {
        let (mut session, now) = session();
        session.remember(now, false);
        session.view.quantity.opacity = Some(renderer::OpacityView::default());
        session.remember(now, true);
        session.remember(now, false);
        session.opacity_source = RangeSource::Seen;
        session.remember(now, true);
        session.remember(now, false);
        session.undo();
        assert_eq!(session.opacity_source, RangeSource::Frame);
        assert!(session.view.quantity.opacity.is_some());
        session.undo();
        assert_eq!(session.view.quantity.opacity, None);
        session.redo();
        session.redo();
        assert_eq!(session.opacity_source, RangeSource::Seen);
    }

    #[test]
    fn neither_the_first_camera_nor_the_size_of_the_window_is_a_step() {
        let mut session = Session::new(View::default());
        let now = Instant::now();
        session.remember(now, false);
        session.camera = Some(OrbitCamera::overview(None, 0.0, 1.0));
        (session.view.image.width, session.view.image.height) = (333, 222);
        session.remember(now, false);
        session.remember(now + 2 * REST, false);
        assert!(!session.can_undo());
        set(&mut session, 3.0);
        session.remember(now + 2 * REST, false);
        session.undo();
        assert!(session.camera.is_some());
        assert_eq!((session.view.image.width, session.view.sampling.rate), (333, 1.0));
    }

    #[test]
    fn a_new_step_ends_what_was_undone_and_old_ones_are_forgotten() {
        let (mut session, now) = session();
        for step in 0..STEPS as u32 + 50 {
            set(&mut session, 2.0 + f64::from(step));
            session.remember(now, true);
            session.remember(now, false);
        }
        session.undo();
        set(&mut session, 1.5);
        session.remember(now, true);
        session.remember(now, false);
        assert!(!session.can_redo());
        let steps = std::iter::from_fn(|| session.can_undo().then(|| session.undo())).count();
        assert_eq!(steps, STEPS);
        session.undo();
        session.redo();
        assert_eq!(session.view.sampling.rate, 52.0);
    }
}
