use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use super::{assert_written, panel, session_over};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::panels::timeline;
use crate::viewer::session::Session;

type State = (Session, Vec<Action>);

fn three_frames() -> Harness<'static, State> {
    let session = session_over(&["demo:radial:27", "demo:radial:64", "demo:radial:8"]);
    panel((session, Vec::new()), |ui, (session, actions)| timeline::show(ui, session, actions))
}

#[test]
fn the_transport_buttons_call_their_actions() {
    let mut harness = three_frames();
    for (label, action) in [
        ("First frame", Action::First),
        ("Previous frame", Action::StepBack),
        ("Play", Action::PlayPause),
        ("Next frame", Action::StepForward),
        ("Last frame", Action::Last),
    ] {
        harness.get_by_label(label).click();
        harness.run();
        assert_eq!(std::mem::take(&mut harness.state_mut().1), [action]);
    }
    harness.get_by_label("Play in a loop").click();
    harness.run();
    assert!(!harness.state().0.playback.looping);
}

#[test]
fn the_playhead_goes_where_the_track_is_clicked() {
    let mut harness = three_frames();
    assert_written(&harness, &["0 / 2"]);
    harness.get_by_label("Timeline").click();
    harness.run();
    assert_eq!(harness.state().0.playback.index(), 1);
    assert_written(&harness, &["1 / 2"]);
}

#[test]
fn a_screen_reader_moves_the_playhead_and_hears_where_it_is() {
    let mut harness = three_frames();
    let heard = |harness: &Harness<State>| {
        let timeline = harness.get_by_role_and_label(Role::Slider, "Timeline");
        let node = timeline.accesskit_node();
        [node.min_numeric_value(), node.numeric_value(), node.max_numeric_value()].map(Option::unwrap)
    };
    assert_eq!(heard(&harness), [0.0, 0.0, 2.0]);
    for (wanted, reached) in [(2.0, 2.0), (-5.0, 0.0), (1.0, 1.0), (f64::NAN, 0.0), (1e300, 2.0)] {
        harness.get_by_label("Timeline").set_value_accesskit(wanted);
        harness.run();
        assert_eq!(harness.state().0.playback.index() as f64, reached);
        assert_eq!(heard(&harness), [0.0, reached, 2.0]);
    }
}

#[test]
fn a_switch_says_whether_it_is_on() {
    let mut harness = three_frames();
    for on in [true, false, true] {
        let node = harness.get_by_role_and_label(Role::Button, "Play in a loop");
        assert_eq!(node.accesskit_node().toggled(), Some(on.into()));
        node.click();
        harness.run();
    }
}

#[test]
fn the_speed_is_chosen_from_the_menu() {
    let mut harness = three_frames();
    harness.get_by_role_and_label(Role::ComboBox, "Speed").click();
    harness.run();
    harness.get_by_label("24 fps").click();
    harness.run();
    assert_eq!(harness.state().0.playback.speed, 24.0);
}
