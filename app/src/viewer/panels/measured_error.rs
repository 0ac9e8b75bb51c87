//! The error that the picture in view has, measured on demand.

use egui::{Ui, vec2};

use crate::viewer::inspect::measurement::{Measured, State};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::picture::overlay::Kind;
use crate::viewer::session::Session;
use crate::viewer::theme;
use crate::viewer::widgets::{self, Areas};

use super::sampling::{in_steps, plain};

pub fn show(ui: &mut Ui, session: &mut Session, measurement: Option<&State>, actions: &mut Vec<Action>) {
    ui.add_space(4.0);
    match measurement {
        Some(State::Done(measured)) => {
            facts(ui, measured);
            let overlay = &mut session.overlay;
            let mut shown = overlay.kind == Kind::Measured;
            let switch = ui
                .checkbox(&mut shown, "Show the error in the picture")
                .on_hover_text("Of the worst channel of each pixel; red above the tolerance");
            if switch.changed() {
                overlay.kind = if shown { Kind::Measured } else { Kind::Off };
            }
        }
        state => button(ui, session, state.is_some(), actions),
    }
}

fn button(ui: &mut Ui, session: &Session, running: bool, actions: &mut Vec<Action>) {
    let ready = session.picture.is_some() && session.view.sampling.tolerance.is_some() && !running;
    let label = if running { "Measuring the error…" } else { "Measure the error" };
    let button = egui::Button::new(label).min_size(vec2(ui.available_width(), theme::ROW_HEIGHT));
    // In a row, its text stands in its middle.
    let response = ui.horizontal(|ui| ui.add_enabled(ready, button)).inner;
    Areas::mark(ui, "measure", response.rect);
    let response = response
        .on_hover_text("Draws the same view at full sampling, in the background, and compares the two")
        .on_disabled_hover_text(if running {
            "Progress, and a way to stop it, are shown over the picture"
        } else {
            "The picture is sampled in full: there is no error to measure"
        });
    if response.clicked() {
        actions.push(Action::MeasureError);
    }
}

fn facts(ui: &mut Ui, measured: &Measured) {
    let Measured { error, speed_up, tolerance, .. } = measured;
    ui.scope(|ui| {
        widgets::fact(ui, "Measured error", with_steps(error.max)).on_hover_text(format!(
            "The largest: at pixel {}, {}; the tolerance is {tolerance}",
            error.place[0], error.place[1],
        ));
        widgets::fact(ui, "Mean error", with_steps(error.mean))
            .on_hover_text("Over all channels of all pixels");
        widgets::fact(ui, "Pixels above", widgets::percent(error.above))
            .on_hover_text("Pixels with an error above the tolerance");
        let [ours, full] = speed_up.milliseconds;
        widgets::fact(ui, "Speed-up in time", format!("{:.2} ×", speed_up.time)).on_hover_text(format!(
            "{full:.0} ms at full sampling, {ours:.0} ms as in view: grid, analysis and ray cast, in one go \
             on one device"
        ));
        widgets::fact(ui, "Speed-up in evaluations", format!("{:.2} ×", speed_up.evaluations));
    });
}

fn with_steps(error: f64) -> String {
    format!("{} = {}", plain(error), in_steps(error))
}
