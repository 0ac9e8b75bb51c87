//! What becomes of the fields that were shown when another run is opened that lacks them.

use renderer::{Scale, View};

use super::Session;
use crate::frames::Frame;
use crate::scene::Selection;

/// Names of fields, as a view has them, that a frame lacks.
struct Missing {
    colour: Option<String>,
    opacity: Option<String>,
}

impl Missing {
    fn of(view: &View, frame: &Frame) -> Missing {
        let lacks = |name: &String| Selection::new(frame, Some(name)).is_err();
        let opacity = view.quantity.opacity.as_ref().and_then(|opacity| opacity.name.clone());
        Missing { colour: view.quantity.name.clone().filter(lacks), opacity: opacity.filter(lacks) }
    }

    /// Gives the names up, with the scales that were chosen for these fields.
    fn drop_from(&self, view: &mut View) {
        let quantity = &mut view.quantity;
        if self.colour.is_some() && quantity.name == self.colour {
            (quantity.name, quantity.scale) = (None, Scale::Linear);
        }
        let of_opacity = quantity.opacity.as_ref().and_then(|opacity| opacity.name.as_ref());
        if self.opacity.is_some() && of_opacity == self.opacity.as_ref() {
            quantity.opacity = None;
        }
    }
}

impl Session {
    /// Gives up fields that another run had and that `frame`, the first of this run, lacks. Those of a view
    /// that was given or loaded stay: that they are not there is an error.
    pub(super) fn drop_missing_fields(&mut self, frame: &Frame) {
        // A frame without particles has every field, so it tells nothing.
        if frame.is_empty() || !std::mem::take(&mut self.inherits_fields) {
            return;
        }
        let missing = Missing::of(&self.view, frame);
        missing.drop_from(&mut self.view);
        // Going back must not end without a picture.
        self.history.each_view(|view| missing.drop_from(view));
        let run = self.run.as_ref().map_or("The run", |run| run.title.as_str()).to_owned();
        if let Some(name) = missing.colour {
            let shown = match Selection::default_of(frame).name() {
                Some(own) => format!("its {own} is shown"),
                None => "its particles are shown alike".to_owned(),
            };
            self.messages.note(format!("{run} has no field {name}: {shown}"));
        }
        if let Some(name) = missing.opacity {
            self.messages.note(format!("{run} has no field {name}: one field decides colour and opacity"));
        }
    }
}
