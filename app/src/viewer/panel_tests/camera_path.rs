use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use renderer::{PathView, Stats};

use super::{assert_written, panel, pictured, session_over};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::orbit_camera::Side;
use crate::viewer::panels::camera_path;
use crate::viewer::session::Session;

type State = (Session, Vec<Action>);

/// A run of five frames, the first of them in view.
fn run() -> Session {
    pictured(session_over(&["demo:radial:27"; 5]), Stats::default())
}

fn path_panel(session: Session) -> Harness<'static, State> {
    panel((session, Vec::new()), |ui, (session, actions)| camera_path::show(ui, session, actions))
}

/// Goes to a frame, and waits until it is there.
fn go_to(session: &mut Session, frame: usize) {
    session.jump(frame);
    let limit = Instant::now() + Duration::from_secs(20);
    while session.frame().is_none_or(|(index, _)| *index != frame) {
        assert!(Instant::now() < limit);
        session.poll(Instant::now());
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn look(session: &mut Session, side: Side) -> DVec3 {
    let camera = session.camera.as_mut().unwrap();
    camera.look_from(side);
    camera.eye()
}

#[test]
fn the_camera_follows_its_keyframes_where_that_is_on() {
    let mut session = run();
    let front = look(&mut session, Side::PosZ);
    session.toggle_keyframe();
    go_to(&mut session, 4);
    let right = look(&mut session, Side::PosX);
    session.toggle_keyframe();
    let frames: Vec<f64> = session.view.path.keyframes.iter().map(|key| key.frame).collect();
    assert_eq!(frames, [0.0, 4.0]);
    go_to(&mut session, 0);
    assert!(session.camera.unwrap().eye().distance(right) < 1e-9, "it does not follow yet");

    let mut harness = path_panel(session);
    harness.get_by_label("Follow path").click();
    harness.run();
    let session = &mut harness.state_mut().0;
    session.poll(Instant::now());
    assert!(session.camera.unwrap().eye().distance(front) < 1e-9);
    go_to(session, 2);
    let (between, target) = (session.camera.unwrap().eye(), session.camera.unwrap().to_view().target);
    let angle = (between - target).angle_between(front - target).to_degrees();
    assert!((angle - 45.0).abs() < 1e-6, "{angle}");
    go_to(session, 4);
    assert!(session.camera.unwrap().eye().distance(right) < 1e-9);
    // To go along the path is no step to undo.
    let before = session.can_undo();
    session.remember(Instant::now(), false);
    assert_eq!(session.can_undo(), before);
    assert!(session.drawn_view().path.is_empty(), "a path changes no picture of one frame");
}

#[test]
fn keyframes_are_set_moved_to_and_removed() {
    let mut session = run();
    go_to(&mut session, 1);
    session.toggle_keyframe();
    go_to(&mut session, 3);
    let mut harness = path_panel(session);
    assert_written(&harness, &["1, none at frame 3"]);
    harness.get_by_label("Set keyframe").click();
    harness.run();
    assert_eq!(std::mem::take(&mut harness.state_mut().1), [Action::Keyframe]);
    harness.get_by_label("Previous keyframe").click();
    harness.run();
    assert_eq!(harness.state().0.playback.index(), 1);
    assert_written(&harness, &["1 of 1, at frame 1"]);
    let eye = look(&mut harness.state_mut().0, Side::NegX);
    harness.get_by_label("Update keyframe").click();
    harness.run();
    assert_eq!(harness.state().0.view.path.keyframes[0].camera.eye, eye);
    harness.state_mut().0.toggle_keyframe();
    assert_eq!(harness.state().0.view.path, PathView::default());
}

#[test]
fn a_turntable_turns_with_the_frames_from_wherever_the_user_has_it() {
    let mut session = run();
    let front = look(&mut session, Side::PosZ);
    session.view.path.revolutions = 1.25;
    session.set_following(true);
    session.poll(Instant::now());
    go_to(&mut session, 1);
    let target = session.camera.unwrap().to_view().target;
    let angle = (session.camera.unwrap().eye() - target).angle_between(front - target).to_degrees();
    assert!((angle - 90.0).abs() < 1e-6, "{angle}");
    let saved = session.saved_view().camera.unwrap();
    assert!(saved.eye.distance(front) < 1e-9, "it is saved as it stands at the first frame");
}

#[test]
fn a_path_over_one_frame_can_be_removed() {
    let mut session = session_over(&["demo:radial:27"]);
    session.view.path.revolutions = 1.0;
    let mut harness = path_panel(session);
    harness.get_by_label("Remove path").click();
    harness.run();
    assert!(harness.state().0.view.path.is_empty() && harness.query_by_label("Remove path").is_none());
}
