//! Undo and redo of what defines the picture: the settings of the view, and the camera.
//!
//! A step is what one gesture changed. A drag is over when the button is released; what wheel and keys
//! change is over when it has rested for a while.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use renderer::View;

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
        let camera = |moment: &Moment| moment.camera.map(OrbitCamera::to_view);
        self.view == other.view
            && self.range_sources == other.range_sources
            && self.quantiles == other.quantiles
            && self.fits_window == other.fits_window
            && camera(self) == camera(other)
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

/// Steps back and forth, and the one that is being made.
#[derive(Default)]
pub struct History {
    past: VecDeque<Moment>,
    /// The last moment at rest.
    present: Option<Moment>,
    future: Vec<Moment>,
    /// How things were at the last look, and since when.
    latest: Option<(Moment, Instant)>,
    held: bool,
}

impl History {
    /// Changes the views of all steps in a way that is no step itself.
    pub(super) fn each_view(&mut self, change: impl Fn(&mut View)) {
        let History { past, present, future, latest, held: _ } = self;
        let latest = latest.as_mut().map(|(moment, _)| moment);
        let moments = past.iter_mut().chain(present).chain(future).chain(latest);
        moments.for_each(|moment| change(&mut moment.view));
    }

    fn commit(&mut self, moment: Moment) {
        let Some(before) = self.present.replace(moment) else { return };
        self.future.clear();
        self.past.push_back(before);
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

    /// Says that the camera went along its path: that is no step of the user's.
    pub(super) fn moved_by_itself(&mut self) {
        if let Some(present) = &mut self.history.present {
            present.camera = self.camera;
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
        let history = &mut self.history;
        let Some(before) = history.past.pop_back() else { return };
        history.future.extend(history.present.replace(before.clone()));
        before.restore(self);
        self.log("undone");
    }

    /// Takes back what was last undone.
    pub fn redo(&mut self) {
        if !self.can_redo() {
            return;
        }
        let history = &mut self.history;
        let Some(after) = history.future.pop() else { return };
        history.past.extend(history.present.replace(after.clone()));
        after.restore(self);
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
