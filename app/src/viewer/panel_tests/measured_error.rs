use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::Stats;

use super::{assert_written, fluid, panel, pictured};
use crate::difference::Difference;
use crate::viewer::inspect::measurement::{Measured, SpeedUp, State};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::panels::measured_error;
use crate::viewer::picture::overlay::Kind;
use crate::viewer::session::Session;

type Shown = (Session, Option<State>, Vec<Action>);

fn over(session: Session, measurement: Option<State>) -> Harness<'static, Shown> {
    panel((session, measurement, Vec::new()), |ui, (session, measurement, actions)| {
        measured_error::show(ui, session, measurement.as_ref(), actions);
    })
}

fn click(harness: &mut Harness<'_, Shown>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

#[test]
fn an_adaptive_picture_is_measured_on_demand() {
    let mut harness = over(pictured(fluid(), Stats::default()), None);
    click(&mut harness, "Measure the error");
    assert_eq!(harness.state().2, [Action::MeasureError]);
}

#[test]
fn without_a_picture_or_an_error_there_is_nothing_to_measure() {
    let mut none = over(fluid(), None);
    click(&mut none, "Measure the error");
    let mut session = pictured(fluid(), Stats::default());
    session.view.sampling.tolerance = None;
    let mut full = over(session, None);
    click(&mut full, "Measure the error");
    assert!(none.state().2.is_empty() && full.state().2.is_empty());
}

#[test]
fn what_was_measured_is_told_and_shown_in_the_picture() {
    let measured = Measured {
        tolerance: 0.004,
        error: Difference { max: 0.002, place: [3, 4], mean: 0.0001, above: 0.0 },
        errors: Vec::new(),
        size: [1, 1],
        speed_up: SpeedUp { time: 1.5, evaluations: 4.0, milliseconds: [20.0, 30.0] },
    };
    let measured = Some(State::Done(Box::new(measured)));
    let mut harness = over(pictured(fluid(), Stats::default()), measured);
    assert_written(&harness, &["0.002 = 0.51 of 255", "0.0001 = 0.0255 of 255", "0 %", "1.50 ×", "4.00 ×"]);
    click(&mut harness, "Show the error in the picture");
    assert_eq!(harness.state().0.overlay.kind, Kind::Measured);
    click(&mut harness, "Show the error in the picture");
    assert_eq!(harness.state().0.overlay.kind, Kind::Off);
}
