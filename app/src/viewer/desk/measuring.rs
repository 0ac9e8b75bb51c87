//! Measuring the error of the picture in view.

use std::sync::Arc;

use super::Desk;
use crate::viewer::Wake;
use crate::viewer::inspect::measurement::{Measurement, State};
use crate::viewer::picture::error_map;
use crate::viewer::task::Outcome;

impl Desk {
    /// Starts to measure the error of the picture in view.
    pub(super) fn measure_error(&mut self) {
        let session = &mut self.session;
        let Some(tolerance) = session.view.sampling.tolerance else {
            session.messages.note("Full sampling has no error to measure: set a tolerance under Sampling");
            return;
        };
        let Some((_, frame)) = session.frame() else {
            session.messages.note("There is no picture to measure: open files first");
            return;
        };
        let (frame, view) = (Arc::clone(frame), session.drawn_view());
        let wake = Wake::clone(&self.wake);
        self.measurement = Some(Measurement::start(frame, &view, tolerance, self.gpu.clone(), wake));
    }

    /// Takes in what was measured, and forgets it with the picture that it is about.
    pub(super) fn follow_measurement(&mut self) {
        let view = self.session.drawn_view();
        let session = &mut self.session;
        let Some(measurement) = &mut self.measurement else { return };
        let in_view = session.frame().is_some_and(|(_, frame)| measurement.is_of(frame, &view));
        let outcome = if in_view { measurement.poll() } else { Some(Outcome::Cancelled) };
        match outcome {
            None => return,
            Some(Outcome::Done(())) => {
                if let State::Done(measured) = &measurement.state {
                    session
                        .log(format!("measured max={:e} above={}", measured.error.max, measured.error.above));
                    self.picture.layers.set_errors(Some(error_map::sheet(measured)));
                }
                return;
            }
            Some(Outcome::Failed(text)) => session.complain(text),
            Some(Outcome::Cancelled) => session.log("no measurement"),
        }
        self.measurement = None;
        self.picture.layers.set_errors(None);
    }
}
