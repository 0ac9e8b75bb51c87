//! What the session wants: the job for the renderer, and the view that is saved.

use std::sync::Arc;
use std::time::Instant;

use renderer::{AnnotationsView, PathView, View};

use super::{Role, Session};
use crate::viewer::render_thread::{Job, Looks};

impl Session {
    /// The job for the renderer, where what is wanted has changed. `room` is the place for the
    /// picture in the window, in physical pixels.
    pub fn job(&mut self, now: Instant, room: [u32; 2]) -> Option<Job> {
        self.room = room;
        let moving = self.playback.playing() || self.moving_until.is_some_and(|until| now < until);
        let (index, frame) = self.frame.as_ref()?;
        if self.without_picture == Some(*index) && self.playback.playing() {
            return None;
        }
        let looks =
            Looks { cells: self.overlay.needs_cells(), probe: self.probe, shot: self.looking.needs_shot() };
        let job = Job {
            frame: Arc::clone(frame),
            numbering: self.numbering(),
            index: *index,
            view: self.drawn_view(),
            moving,
            budget: self.budget,
            looks,
        };
        if job.view.image.width == 0 || job.view.image.height == 0 {
            return None;
        }
        let same = |asked: &Job| {
            let about = |job: &Job| (job.moving, job.looks);
            Arc::ptr_eq(&asked.frame, &job.frame) && asked.view == job.view && about(asked) == about(&job)
        };
        if self.asked.as_ref().is_some_and(same) {
            return None;
        }
        self.asked = Some(job.clone());
        Some(job)
    }

    /// Asks for the next job although nothing has changed.
    pub fn ask_again(&mut self) {
        self.asked = None;
    }

    /// The view as the window draws it: as large as there is room, and without what is laid over the
    /// picture afterwards.
    pub fn drawn_view(&self) -> View {
        let mut view = self.complete_view();
        view.annotations = None;
        view.bookmarks.clear();
        view.path = PathView::default();
        [view.image.width, view.image.height] = self.fitted();
        view
    }

    /// The largest picture of the image's shape that fits into the window, in physical pixels.
    pub fn fitted(&self) -> [u32; 2] {
        let [width, height] = self.room;
        if self.fits_window {
            return [width, height];
        }
        let (across, down) = (self.view.image.width.max(1), self.view.image.height.max(1));
        let (across, down) = (u64::from(across), u64::from(down));
        let high = u64::from(width) * down / across;
        match high <= u64::from(height) {
            true => [width, (high as u32).max(1)],
            false => [((u64::from(height) * across / down) as u32).max(1), height],
        }
    }

    /// What the window shows over the picture.
    pub fn annotations(&self) -> AnnotationsView {
        self.view.annotations.clone().unwrap_or_else(AnnotationsView::of_window)
    }

    /// Puts `look` in the place of `before`. What was switched on for the first time is meant for saved
    /// pictures, too.
    pub fn annotate(&mut self, before: &AnnotationsView, mut look: AnnotationsView) {
        if look == *before {
            return;
        }
        let items = |look: &AnnotationsView| {
            let bars = [look.colour_bar, look.opacity_bar, look.scale_bar];
            let others = [look.axes, look.time, look.frame_number, !look.title.is_empty()];
            bars.into_iter().chain(others)
        };
        let added = items(&look).zip(items(before)).any(|(now, then)| now && !then);
        look.in_pictures |= added && self.view.annotations.is_none();
        self.view.annotations = Some(look);
    }

    /// The view as it is saved to a file: a turntable starts from where it stands at the first frame.
    pub fn saved_view(&self) -> View {
        View { camera: self.first_camera().or(self.view.camera), ..self.complete_view() }
    }

    /// The view with everything that the session decides, of the frame in view: what a saved picture is
    /// made from.
    pub fn complete_view(&self) -> View {
        let mut view = self.view.clone();
        if let Some(camera) = self.camera {
            view.camera = Some(camera.to_view());
        }
        if self.fits_window && self.room != [0, 0] {
            [view.image.width, view.image.height] = self.room;
        }
        let quantity = &mut view.quantity;
        quantity.range = self.settled_range(Role::Colour, quantity.range);
        if let Some(opacity) = &mut quantity.opacity {
            opacity.range = self.settled_range(Role::Opacity, opacity.range);
        }
        view
    }
}
