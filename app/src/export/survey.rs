//! What all frames of a run have in common, for a film that does not flicker.

use renderer::{Bounds, Camera, QuantityView, Scale, View};

use crate::frames::Frame;
use crate::scene::{self, Selection, extremes, union};

/// Whose ranges are those of all frames, as far as the view does not have them wider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steady {
    /// That of the field that is shown.
    pub colour: bool,
    /// That of the field that decides the opacity, where it is another one.
    pub opacity: bool,
}

/// Room that the particles of the frames seen so far take, in the unit of the run.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    bounds: Option<Bounds>,
    largest_radius: f64,
    /// What the first frame with particles shows, where the view does not say.
    quantity: Option<Option<String>>,
    ranges: Ranges,
}

/// Of the fields that decide colour and opacity.
#[derive(Clone, Copy, Debug, Default)]
struct Ranges {
    colour: Option<[f64; 2]>,
    opacity: Option<[f64; 2]>,
}

impl Survey {
    /// Looks at the next frame of the run.
    pub fn add(&mut self, frame: &Frame, view: &View) {
        self.add_quantity(frame);
        self.add_ranges(frame, &view.quantity);
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

    fn add_ranges(&mut self, frame: &Frame, view: &QuantityView) {
        let shown = view.name.clone().or_else(|| self.quantity());
        let range = |name: Option<&str>, scale, known: Option<[f64; 2]>| {
            let found = Selection::new(frame, name).ok().and_then(|field| extremes(frame, &field, scale));
            known.into_iter().chain(found).reduce(union)
        };
        self.ranges.colour = range(shown.as_deref(), view.scale, self.ranges.colour);
        if let Some(opacity) = &view.opacity {
            let name = opacity.name.as_deref().or(shown.as_deref());
            self.ranges.opacity = range(name, opacity.scale, self.ranges.opacity);
        }
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
    /// [`Scene::new`](renderer::Scene::new) does for one frame, and the ranges that are to be `steady`.
    pub fn settle(&self, view: &mut View, steady: Steady) {
        let aspect = f64::from(view.image.width) / f64::from(view.image.height);
        view.camera = Some(match view.camera {
            Some(camera) => camera.settled(self.bounds, self.largest_radius, aspect),
            None => Camera::overview(self.bounds, self.largest_radius, aspect),
        });
        if let Some(bounds) = self.bounds {
            let length = (bounds.diagonal() + 2.0 * self.largest_radius) / 30.0;
            view.transfer.reference_length.get_or_insert(length);
        }
        let widened = |range: Option<[f64; 2]>, all, scale: Scale| {
            range.into_iter().chain(all).reduce(union).map(|range| scale.fitted(range))
        };
        if steady.colour {
            view.quantity.range = widened(view.quantity.range, self.ranges.colour, view.quantity.scale);
        }
        if let Some(opacity) = view.quantity.opacity.as_mut().filter(|_| steady.opacity) {
            opacity.range = widened(opacity.range, self.ranges.opacity, opacity.scale);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Column, Field, Metadata};

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
        survey.settle(&mut view, Steady::default());
        assert_eq!(view.camera.unwrap().target, glam::DVec3::new(2.5, 0.0, 0.0));
        assert_eq!(view.transfer.reference_length, Some(6.0 / 30.0));
        let settled = view.clone();
        survey.add(&frame(100.0), &view);
        survey.settle(&mut view, Steady::default());
        assert_eq!(view, settled, "what the view says itself stays");
    }

    #[test]
    fn a_steady_range_is_that_of_all_frames_and_never_narrower_than_the_views() {
        let frame = |values: [f64; 2]| {
            let field = |name: &str, values: [f64; 2]| Field {
                name: name.into(),
                column: Column::scalars(values.to_vec()),
            };
            let fields = vec![field("density", values), field("heat", values.map(|x| -x))];
            Frame::new(Column::new(3, vec![0.0; 6]).unwrap(), fields, Metadata::default()).unwrap()
        };
        let frames = [[2.0, f64::NAN], [0.0, 3.0], [-1.0, 7.0]].map(frame);
        let settled = |quantity: &str, steady| {
            let mut view = View::from_json(&format!(r#"{{"quantity": {quantity}}}"#)).unwrap();
            view.particles.support_radius = Some(0.5);
            let mut survey = Survey::default();
            frames.iter().for_each(|frame| survey.add(frame, &view));
            survey.settle(&mut view, steady);
            let opacity = view.quantity.opacity.and_then(|opacity| opacity.range);
            (view.quantity.range, opacity)
        };
        let both = Steady { colour: true, opacity: true };
        assert_eq!(settled("{}", both), (Some([-1.0, 7.0]), None));
        assert_eq!(settled("{}", Steady::default()), (None, None));
        assert_eq!(settled(r#"{"scale": "log"}"#, both), (Some([2.0, 7.0]), None));
        assert_eq!(settled(r#"{"range": [0, 9]}"#, both), (Some([-1.0, 9.0]), None));
        let two = r#"{"name": "density", "opacity": {"name": "heat"}}"#;
        assert_eq!(settled(two, both), (Some([-1.0, 7.0]), Some([-7.0, 1.0])));
        assert_eq!(settled(two, Steady { colour: false, ..both }), (None, Some([-7.0, 1.0])));
    }
}
