use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{Bound, BrickWidth, SamplingView};

use super::{assert_written, fluid, panel, texts};
use crate::viewer::panels::sampling::SamplingPanel;
use crate::viewer::session::Session;

fn sampling(change: impl FnOnce(&mut SamplingView)) -> Harness<'static, Session> {
    let mut session = fluid();
    change(&mut session.view.sampling);
    let mut sampling = SamplingPanel::new();
    panel(session, move |ui, session| sampling.show(ui, session))
}

fn click(harness: &mut Harness<'_, Session>, label: &str) -> SamplingView {
    harness.get_by_label(label).click();
    harness.run();
    harness.state().view.sampling
}

#[test]
fn from_full_sampling_the_way_leads_back_to_the_same_tolerance() {
    let mut harness = sampling(|sampling| sampling.tolerance = Some(0.02));
    assert_eq!(click(&mut harness, "Full sampling").tolerance, None);
    assert!(harness.query_by_role(Role::Slider).is_none(), "there is nothing to set");
    assert_eq!(click(&mut harness, "Adaptive").tolerance, Some(0.02));
}

#[test]
fn a_tolerance_is_chosen_dragged_and_typed() {
    let mut harness = sampling(|_| {});
    assert_eq!(click(&mut harness, "2.55").tolerance, Some(0.01));
    assert_written(&harness, &["2.55 of 255"]);
    let slider = |harness: &mut Harness<'_, Session>, value| {
        harness.get_by_role_and_label(Role::Slider, "Tolerance").set_value_accesskit(value);
        harness.run();
        harness.state().view.sampling.tolerance
    };
    assert_eq!(slider(&mut harness, 0.012_345), Some(0.012), "two digits are enough");
    assert_eq!(slider(&mut harness, 0.7), Some(0.1), "the slider has an end");
    harness.get_by_role_and_label(Role::SpinButton, "Tolerance").set_value_accesskit(0.7);
    harness.run();
    assert_eq!(harness.state().view.sampling.tolerance, Some(0.7), "a number by hand goes beyond it");
}

#[test]
fn looking_at_a_tolerance_from_a_file_leaves_it_alone() {
    for tolerance in [0.0, 1e-7, 0.5, 1.0] {
        let harness = sampling(|sampling| sampling.tolerance = Some(tolerance));
        assert_eq!(harness.state().view.sampling.tolerance, Some(tolerance));
    }
}

#[test]
fn each_switch_changes_its_own_setting() {
    let mut harness = sampling(|_| {});
    let before = harness.state().view.sampling;
    let mut expected = SamplingView { brick_width: BrickWidth::Two, ..before };
    assert_eq!(click(&mut harness, "2 × 2 rays"), expected);
    expected.bound = Bound::Paper;
    assert_eq!(click(&mut harness, "Interval"), expected);
    expected.super_pixels = false;
    assert_eq!(click(&mut harness, "One colour a brick"), expected);
    expected.always_adaptive = true;
    assert_eq!(click(&mut harness, "Even where it hardly pays"), expected);
    expected.z_adaptive = false;
    assert_eq!(click(&mut harness, "Slopes and longer steps"), expected);
}

#[test]
fn relaxation_is_offered_where_it_acts_and_said_to_be_no_guarantee() {
    let mut harness = sampling(|_| {});
    assert_written(&harness, &["Guaranteed: no pixel exceeds the tolerance"]);
    harness.get_by_role_and_label(Role::Slider, "Relaxation").set_value_accesskit(0.333);
    harness.run();
    assert_eq!(harness.state().view.sampling.relaxation, 0.33);
    assert_written(&harness, &["Relaxed: the tolerance is no guarantee"]);
    click(&mut harness, "Slopes and longer steps");
    assert!(!texts(&harness).iter().any(|text| text.starts_with("Relax")));
}
