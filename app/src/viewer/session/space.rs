//! Where the run is, where that is in the picture, and what is counted of it.

use std::sync::Arc;

use renderer::Bounds;

use super::Session;
use crate::projection::Projection;
use crate::scene::Selection;
use crate::viewer::analysis::statistics::Question;
use crate::viewer::orbit_camera::Screen;

impl Session {
    /// Where points of the world are in a picture of this size.
    pub fn projection(&self, [width, height]: [f64; 2]) -> Option<Projection> {
        self.camera.map(|camera| camera.projection(Screen { width, height }))
    }

    /// Around the supports of the particles of all frames pictured so far, selected or not.
    pub fn scene_bounds(&self) -> Option<Bounds> {
        let (bounds, margin) = self.extent;
        bounds.map(|Bounds { min, max }| Bounds { min: min - margin, max: max + margin })
    }

    /// What is to be counted of the particles in the picture, where that is not known.
    pub fn statistics_question(&self) -> Option<Question> {
        let (index, frame) = self.frame.as_ref()?;
        let question = Question {
            index: *index,
            frame: Arc::clone(frame),
            select: self.view.select.clone(),
            quantity: self.view.quantity.name.clone(),
        };
        let known = self.statistics.as_ref().is_some_and(|answer| question.is_same(&answer.question));
        (!known).then_some(question)
    }

    /// The name of the quantity in view; `None` where the frame has no field.
    pub fn shown_quantity(&self) -> Option<String> {
        let of_frame = || Selection::default_of(&self.frame.as_ref()?.1).name();
        self.view.quantity.name.clone().or_else(of_frame)
    }
}
