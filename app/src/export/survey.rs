//! What all frames of a run have in common, for a film that does not flicker.

use renderer::{Bounds, Camera, View};

use crate::frames::Frame;
use crate::scene::{self, Selection};

/// Room that the particles of the frames seen so far take, in the unit of the run.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    bounds: Option<Bounds>,
    largest_radius: f64,
    /// What the first frame with particles shows, where the view does not say.
    quantity: Option<Option<String>>,
}

impl Survey {
    /// Looks at the next frame of the run.
    pub fn add(&mut self, frame: &Frame, view: &View) {
        self.add_quantity(frame);
        // A frame that makes no particle set fails when it is rendered, and is told then.
        let Ok(particles) = scene::particles(frame, view.particles.support_radius) else {
            return;
        };
        self.bounds = match (self.bounds, particles.bounds()) {
            (Some(all), Some(new)) => Some(all.union(&new)),
            (all, new) => all.or(new),
        };
        self.largest_radius = self.largest_radius.max(particles.support_radii()[1]);
    }

    /// Looks only at what the frame shows. Returns whether that says what the run shows.
    pub fn add_quantity(&mut self, frame: &Frame) -> bool {
        if self.quantity.is_none() && !frame.is_empty() {
            self.quantity = Some(Selection::default_of(frame).name());
        }
        self.quantity.is_some()
    }

    /// What all frames show where the view does not say; `None` where each shows its own.
    pub fn quantity(&self) -> Option<String> {
        self.quantity.clone().flatten()
    }

    /// Fills in the camera and the reference length that `view` leaves open, as
    /// [`Scene::new`](renderer::Scene::new) does for one frame.
    pub fn settle(&self, view: &mut View) {
        let aspect = f64::from(view.image.width) / f64::from(view.image.height);
        view.camera = Some(match view.camera {
            Some(camera) => camera.settled(self.bounds, self.largest_radius, aspect),
            None => Camera::overview(self.bounds, self.largest_radius, aspect),
        });
        if let Some(bounds) = self.bounds {
            let length = (bounds.diagonal() + 2.0 * self.largest_radius) / 30.0;
            view.transfer.reference_length.get_or_insert(length);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Column, Metadata};

    #[test]
    fn the_camera_and_the_reference_length_are_those_of_the_whole_run() {
        let frame = |x: f64| {
            let positions = Column::new(3, vec![x, 0.0, 0.0, x + 1.0, 0.0, 0.0]).unwrap();
            Frame::new(positions, Vec::new(), Metadata::default()).unwrap()
        };
        let mut view = View::default();
        view.particles.support_radius = Some(0.5);
        let mut survey = Survey::default();
        survey.add(&frame(0.0), &view);
        survey.add(&frame(4.0), &view);
        survey.settle(&mut view);
        assert_eq!(view.camera.unwrap().target, glam::DVec3::new(2.5, 0.0, 0.0));
        assert_eq!(view.transfer.reference_length, Some(6.0 / 30.0));
        let settled = view.clone();
        survey.add(&frame(100.0), &view);
        survey.settle(&mut view);
        assert_eq!(view, settled, "what the view says itself stays");
    }
}
