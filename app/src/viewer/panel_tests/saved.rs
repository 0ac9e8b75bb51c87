use egui_kittest::Harness;
use renderer::{Evaluations, Stats};

use super::{assert_written, fluid, panel, pictured};
use crate::viewer::panels::saved;
use crate::viewer::session::Session;

fn over(tolerance: Option<f64>, evaluations: Evaluations) -> Harness<'static, Session> {
    let mut session = fluid();
    session.view.sampling.tolerance = tolerance;
    let stats = Stats { evaluations, predicted_error: 0.003_123, ..Stats::default() };
    panel(pictured(session, stats), |ui, session| saved::show(ui, session))
}

#[test]
fn the_predicted_error_is_told_beside_the_tolerance_of_the_picture() {
    let mut harness = over(Some(0.004), Evaluations { done: 1_400_000, bounds: 1000, ..Default::default() });
    assert_written(&harness, &["0.00312 of 0.004", "1.40 M"]);
    harness.state_mut().view.sampling.tolerance = Some(0.01);
    harness.run();
    assert_written(&harness, &["0.00312 of 0.004"]);
}

#[test]
fn full_sampling_has_no_error() {
    let full = Evaluations { full: 100, done: 100, ..Default::default() };
    let given_up = Evaluations { done: 120, bounds: 20, ..full };
    for (tolerance, evaluations) in [(None, full), (Some(0.004), given_up)] {
        assert_written(&over(tolerance, evaluations), &["0, sampled in full"]);
    }
}
