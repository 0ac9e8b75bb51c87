use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

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
        ("First frame  (Ctrl+Left)", Action::First),
        ("Previous frame  (Left)", Action::StepBack),
        ("Play  (Space)", Action::PlayPause),
        ("Next frame  (Right)", Action::StepForward),
        ("Last frame  (Ctrl+Right)", Action::Last),
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
fn the_speed_is_chosen_from_the_menu() {
    let mut harness = three_frames();
    harness.get_by_role_and_label(Role::ComboBox, "Speed").click();
    harness.run();
    harness.get_by_label("24 fps").click();
    harness.run();
    assert_eq!(harness.state().0.playback.speed, 24.0);
}
