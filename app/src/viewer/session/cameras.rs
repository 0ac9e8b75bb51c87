//! Bookmarks, the way to them, and the path that the camera follows while frames go by.

use std::time::{Duration, Instant};

use renderer::{Bookmark, CameraView, Keyframe, PathView};

use super::Session;
use crate::camera_path::{Pose, camera_at, turned};
use crate::frames::Insertion;
use crate::viewer::orbit_camera::Side;

/// How the camera moves by itself.
#[derive(Default)]
pub struct Cameras {
    /// Whether it follows the view's path from frame to frame.
    follows: bool,
    /// The frame that it last went to on the path.
    last: Option<usize>,
    flight: Option<Flight>,
}

impl Cameras {
    pub(super) fn renumber(&mut self, insertion: &Insertion) {
        self.last = self.last.map(|frame| insertion.moved(frame));
    }
}

/// On the way to another camera.
struct Flight {
    from: Pose,
    to: CameraView,
    begun: Instant,
}

/// How long a flight takes: long enough to see where it goes.
const FLIGHT: Duration = Duration::from_millis(350);
/// From one camera on the way to the next, at most.
const STEP: Duration = Duration::from_millis(16);

impl Session {
    /// Says that the user moved the camera: where it goes by itself, it goes no farther.
    pub fn steered(&mut self, now: Instant) {
        self.cameras.flight = None;
        self.touch(now);
    }

    /// Looks at the target from `side`.
    pub fn look_from(&mut self, side: Side) {
        self.cameras.flight = None;
        if let Some(camera) = &mut self.camera {
            camera.look_from(side);
        }
    }

    /// Goes to another camera, which is settled and valid, on a smooth way.
    pub fn fly_to(&mut self, to: CameraView, now: Instant) {
        if let Some(camera) = self.camera {
            self.cameras.flight = Some(Flight { from: Pose::of(&camera.to_view()), to, begun: now });
            self.touch(now);
        }
    }

    /// Goes to a valid camera; the run settles what it leaves open.
    pub fn paste_camera(&mut self, camera: &CameraView, now: Instant) {
        let [width, height] = self.fitted();
        let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
        let (bounds, margin) = self.extent;
        self.fly_to(camera.settled(bounds, margin, aspect), now);
    }

    /// When the camera is to move on.
    pub(super) fn flight_due(&self, now: Instant) -> Option<Instant> {
        self.cameras.flight.as_ref().map(|_| now + STEP)
    }

    /// Moves the camera on its way, and along the path.
    pub(super) fn move_camera(&mut self, now: Instant) {
        if let (Some(flight), Some(camera)) = (&self.cameras.flight, &mut self.camera) {
            let share = now.saturating_duration_since(flight.begun).as_secs_f64() / FLIGHT.as_secs_f64();
            if share < 1.0 {
                // Starts and ends slowly.
                let eased = share * share * (3.0 - 2.0 * share);
                camera.adopt(&flight.from.mix(&Pose::of(&flight.to), eased).to_camera());
            } else {
                camera.adopt(&flight.to);
                self.cameras.flight = None;
            }
            self.touch(now);
        }
        self.go_along();
    }

    /// Puts the camera where the path has it at the frame in view, once for each frame.
    fn go_along(&mut self) {
        let Some(frame) = self.frame.as_ref().map(|(index, _)| *index) else { return };
        let before = self.cameras.last.replace(frame);
        let Some(camera) = self.camera.as_mut().filter(|_| self.cameras.follows) else { return };
        if before == Some(frame) {
            return;
        }
        let (path, count) = (&self.view.path, self.playback.count());
        let (here, now) = (*camera, camera.to_view());
        let next = match (path.keyframes.is_empty(), before) {
            (false, _) => camera_at(path, &now, frame as f64, count),
            // From wherever the user has turned it to.
            (true, Some(before)) => {
                let frames = frame as f64 - before as f64;
                turned(&now, path.revolutions * frames / count.max(1) as f64)
            }
            (true, None) => now,
        };
        if next != now {
            camera.adopt(&next);
            self.moved_by_itself(here);
        }
    }

    /// Drops what another run was looked at from, and what it is called in pictures.
    pub(super) fn forget_cameras(&mut self) {
        self.view.path = PathView::default();
        self.view.bookmarks.clear();
        if let Some(look) = &mut self.view.annotations {
            look.title.clear();
        }
    }

    pub fn follows_path(&self) -> bool {
        self.cameras.follows
    }

    /// Follows the path from the frame in view on, or no longer.
    pub fn set_following(&mut self, follows: bool) {
        self.cameras.follows = follows;
        if !self.view.path.keyframes.is_empty() {
            self.cameras.last = None;
        }
    }

    /// The camera that a saved view starts from: on a turntable, that of the first frame.
    pub(super) fn first_camera(&self) -> Option<CameraView> {
        let camera = self.camera?.to_view();
        let path = &self.view.path;
        let turntable = self.cameras.follows && path.keyframes.is_empty();
        let frame = self.cameras.last.filter(|_| turntable).unwrap_or(0);
        Some(turned(&camera, -path.revolutions * frame as f64 / self.playback.count().max(1) as f64))
    }

    /// Names the present camera.
    pub fn add_bookmark(&mut self) {
        let Some(camera) = self.camera else { return };
        let taken = |name: &str| self.view.bookmarks.iter().any(|bookmark| bookmark.name == name);
        let names = (self.view.bookmarks.len() + 1..).map(|number| format!("Camera {number}"));
        let name = names.into_iter().find(|name| !taken(name)).unwrap_or_default();
        self.messages.note(format!("{name} is bookmarked"));
        self.view.bookmarks.push(Bookmark { name, camera: camera.to_view() });
    }

    /// Goes to a bookmark, where there is one of that number.
    pub fn go_to_bookmark(&mut self, index: usize, now: Instant) {
        if let Some(bookmark) = self.view.bookmarks.get(index) {
            self.fly_to(bookmark.camera, now);
        }
    }

    /// The keyframe at the playhead.
    pub fn keyframe_here(&self) -> Option<usize> {
        let here = self.playback.index() as f64;
        self.view.path.keyframes.iter().position(|key| key.frame == here)
    }

    /// Makes the present camera the keyframe at the playhead.
    pub fn set_keyframe(&mut self) {
        let Some(camera) = self.camera.map(|camera| camera.to_view()) else { return };
        let frame = self.playback.index() as f64;
        let keys = &mut self.view.path.keyframes;
        match keys.iter().position(|key| key.frame >= frame) {
            Some(place) if keys[place].frame == frame => keys[place].camera = camera,
            place => keys.insert(place.unwrap_or(keys.len()), Keyframe { frame, camera }),
        }
    }

    /// Sets a keyframe at the playhead, or takes away the one that is there.
    pub fn toggle_keyframe(&mut self) {
        match self.keyframe_here() {
            Some(place) => {
                self.view.path.keyframes.remove(place);
            }
            None => self.set_keyframe(),
        }
    }
}
