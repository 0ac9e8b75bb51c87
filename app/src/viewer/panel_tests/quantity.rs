use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{OpacityView, Scale};

use super::{count, fluid, panel, session_over};
use crate::viewer::analysis::survey::look_through;
use crate::viewer::panels::quantity;
use crate::viewer::session::{RangeSource, Role, Session, Survey};

#[test]
fn a_field_is_chosen_from_the_menu() {
    let mut harness = panel(fluid(), |ui, session| {
        quantity::show(ui, session);
        count(session);
    });
    harness.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Field").click();
    harness.run();
    harness.get_by_label("velocity.x").click();
    harness.run();
    assert_eq!(harness.state().view.quantity.name.as_deref(), Some("velocity.x"));
}

#[test]
fn a_fixed_range_is_the_one_in_effect_until_it_is_edited() {
    let mut harness = panel(fluid(), quantity::show);
    let before = harness.state().range();
    harness.get_by_label("Fixed").click();
    harness.run();
    assert_eq!(harness.state().range_source, RangeSource::Fixed);
    assert_eq!(harness.state().view.quantity.range, before);
}

/// The panel after `name` was chosen in the menu of the opacity.
fn with_opacity_by<'a>(name: &str) -> Harness<'a, Session> {
    let mut harness = panel(fluid(), |ui, session| {
        quantity::show(ui, session);
        count(session);
    });
    harness.get_by_label("Opacity by").click();
    harness.run();
    harness.get_by_label(name).click();
    harness.run();
    harness
}

#[test]
fn another_field_decides_the_opacity() {
    let mut harness = with_opacity_by("density");
    let opacity = |harness: &Harness<Session>| harness.state().view.quantity.opacity.clone();
    let density = OpacityView { name: Some("density".into()), ..OpacityView::default() };
    assert_eq!(opacity(&harness), Some(density.clone()));
    assert_eq!(harness.state().range_of(Role::Opacity), Some([1000.0, 1030.0]));
    harness.get_by_label(
        "In the transfer function, nodes and histogram are of density, colours of velocity. Outside its range, \
         density is as opaque as at the nearer end.",
    );
    // Its range is its own.
    harness.get_all_by_label("Fixed").last().unwrap().click();
    harness.run();
    assert_eq!(harness.state().range_source, RangeSource::Frame);
    assert_eq!(harness.state().opacity_source, RangeSource::Fixed);
    assert_eq!(opacity(&harness), Some(OpacityView { range: Some([1000.0, 1030.0]), ..density }));
    // And back to one field.
    harness.get_by_label("Opacity by").click();
    harness.run();
    harness.get_by_label("the same field").click();
    harness.run();
    assert_eq!(opacity(&harness), None);
    assert!(harness.query_by_label("Highest value of the opacity").is_none());
}

#[test]
fn numbers_of_the_opacity_leave_the_colour_alone() {
    let mut harness = with_opacity_by("velocity.x");
    let before = harness.state().complete_view().quantity;
    harness.get_by_label("Highest value of the opacity").click();
    harness.run();
    harness.get_by_label("Highest value of the opacity").type_text("2");
    harness.key_press(egui::Key::Enter);
    harness.run();
    let after = harness.state().complete_view().quantity;
    assert_eq!(after.opacity.unwrap().range, Some([0.0, 2.0]));
    assert_eq!((after.name, after.range), (before.name, before.range));
}

#[test]
fn the_opacity_has_a_scale_and_percentiles_of_its_own() {
    let mut harness = with_opacity_by("velocity.x");
    harness.get_all_by_label("Logarithmic").last().unwrap().click();
    harness.run();
    let session = harness.state();
    let quantity = &session.view.quantity;
    assert_eq!((quantity.scale, quantity.opacity.as_ref().unwrap().scale), (Scale::Linear, Scale::Log));
    // Of what is positive.
    assert_eq!(session.range_of(Role::Opacity), Some([0.25, 0.75]));
    assert!(session.complete_view().validate().is_ok());
    harness.get_all_by_label("Percentile").last().unwrap().click();
    harness.run();
    harness.state_mut().ranges.quantiles[1] = [0.4, 0.6];
    harness.run();
    let session = harness.state();
    assert_eq!((session.range_source, session.opacity_source), (RangeSource::Frame, RangeSource::Quantiles));
    assert_eq!(session.complete_view().quantity.opacity.unwrap().range, Some([0.5, 0.5]));
    assert_eq!(session.ranges.quantiles[0], [0.01, 0.99]);
}

#[test]
fn a_range_by_hand_that_the_scale_cannot_have_is_given_up() {
    let mut harness = with_opacity_by("velocity.x");
    harness.get_all_by_label("Fixed").last().unwrap().click();
    harness.run();
    assert_eq!(harness.state().range_of(Role::Opacity), Some([0.0, 0.75]));
    harness.get_all_by_label("Logarithmic").last().unwrap().click();
    harness.run();
    assert_eq!(harness.state().opacity_source, RangeSource::Frame);
    assert_eq!(harness.state().range_of(Role::Opacity), Some([0.25, 0.75]));
}

#[test]
fn particles_that_lack_either_value_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gaps.csv");
    let rows = ["0,0,0,1,nan", "1,0,0,nan,2", "0,1,0,nan,nan", "0,0,1,4,5", "1,1,1,5,6"];
    std::fs::write(&path, format!("x,y,z,temperature,pressure\n{}\n", rows.join("\n"))).unwrap();
    let mut session = session_over(&[path.to_str().unwrap()]);
    session.view.quantity.name = Some("temperature".into());
    session.view.quantity.opacity = Some(OpacityView { name: Some("pressure".into()), ..Default::default() });
    let harness = panel(session, |ui, session| {
        quantity::show(ui, session);
        count(session);
    });
    assert_eq!(harness.state().analysis.as_ref().unwrap().left_out, 3);
    assert_eq!(harness.query_all_by_label("2, left out").count(), 2, "each field tells its own");
}

#[test]
fn opacities_of_a_sequence_keep_the_range_of_all_frames_seen() {
    let mut harness = with_opacity_by("density");
    let session = harness.state_mut();
    session.opacity_source = RangeSource::Seen;
    assert_eq!(session.complete_view().quantity.opacity.unwrap().range, Some([1000.0, 1030.0]));
    session.adopt(session.complete_view());
    assert_eq!(session.opacity_source, RangeSource::Fixed);
}

#[test]
fn a_logarithmic_scale_begins_at_what_is_positive() {
    let mut session = fluid();
    session.view.quantity.name = Some("velocity.x".into());
    count(&mut session);
    assert_eq!(session.range(), Some([0.0, 0.75]));
    (session.range_source, session.view.quantity.range) = (RangeSource::Fixed, Some([0.0, 0.75]));
    let mut harness = panel(session, |ui, session| {
        quantity::show(ui, session);
        count(session);
    });
    harness.get_by_label("Logarithmic").click();
    harness.run();
    let session = harness.state();
    assert_eq!((session.view.quantity.scale, session.range()), (Scale::Log, Some([0.25, 0.75])));
    assert!(session.complete_view().validate().is_ok());
}

#[test]
fn percentiles_of_the_frame_are_numbers_of_the_view() {
    let mut harness = panel(fluid(), |ui, session| {
        quantity::show(ui, session);
        count(session);
    });
    harness.get_by_label("Percentile").click();
    harness.run();
    harness.state_mut().ranges.quantiles[0] = [0.3, 0.7];
    harness.run();
    let session = harness.state();
    let [low, high] = session.complete_view().quantity.range.unwrap();
    let [least, most] = session.analysis.as_ref().unwrap().colour.extremes.unwrap();
    assert!(least < low && low < high && high < most, "{low} {high}");
    assert!(harness.query_by_label("Left out below").is_some());
}

#[test]
fn all_frames_are_read_when_that_is_asked_for() {
    let mut session = session_over(&["demo:radial:8", "demo:radial:64", "demo:radial:1000"]);
    session.range_source = RangeSource::Seen;
    let mut harness = panel(session, quantity::show);
    harness.get_by_label("Read all").click();
    harness.run();
    assert_eq!(harness.state().ranges.survey, Survey::Wanted);
    harness.state_mut().ranges.survey = Survey::Running(0.5);
    harness.run();
    harness.get_by_label("Cancel").click();
    harness.run();
    assert_eq!(harness.state().ranges.survey, Survey::Unwanted);
    let before = harness.state().range().unwrap();
    let sources = harness.state().run().unwrap().sequence.frame_sources();
    let found = look_through(&sources, &mut |_| std::ops::ControlFlow::Continue(())).unwrap();
    harness.state_mut().ranges.survey = Survey::Idle;
    harness.state_mut().learn(found);
    harness.run();
    let after = harness.state().range().unwrap();
    assert!(after[0] <= before[0] && after[1] >= before[1] && after != before, "{before:?} {after:?}");
    assert!(harness.query_by_label("Read all").is_none());
}
