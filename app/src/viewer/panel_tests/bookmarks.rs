use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{Stats, View};

use super::{fluid, panel, pictured};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::orbit_camera::Side;
use crate::viewer::panels::bookmarks;
use crate::viewer::session::Session;

type State = (Session, Vec<Action>);

fn list(session: Session) -> Harness<'static, State> {
    panel((session, Vec::new()), |ui, (session, actions)| bookmarks::show(ui, session, actions))
}

/// A session with two bookmarks, from +X and from +Z, that looks from +Z.
fn two() -> Session {
    let mut session = pictured(fluid(), Stats::default());
    for side in [Side::PosX, Side::PosZ] {
        session.camera.as_mut().unwrap().look_from(side);
        session.add_bookmark();
    }
    session
}

fn click(harness: &mut Harness<'_, State>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

#[test]
fn the_way_to_a_bookmark_is_smooth_and_ends_there() {
    let mut harness = list(two());
    let (from, to) = (harness.state().0.camera.unwrap(), harness.state().0.view.bookmarks[0].camera);
    click(&mut harness, "Go to Camera 1");
    let session = &mut harness.state_mut().0;
    let now = Instant::now();
    assert!(session.due(now).is_some_and(|due| due < now + Duration::from_millis(50)));
    session.poll(now + Duration::from_millis(150));
    let between = session.camera.unwrap().eye();
    assert!(between.distance(from.eye()) > 0.1 && between.distance(to.eye) > 0.1);
    session.poll(now + Duration::from_secs(1));
    assert!(session.camera.unwrap().eye().distance(to.eye) < 1e-9);
    assert_eq!(session.camera.unwrap().axle(), from.axle());
    // Whoever takes the camera in hand ends the flight.
    session.go_to_bookmark(1, now);
    session.steered(now);
    session.poll(now + Duration::from_millis(200));
    assert!(session.camera.unwrap().eye().distance(to.eye) < 1e-9);
}

#[test]
fn bookmarks_are_renamed_updated_and_deleted() {
    let mut harness = list(two());
    harness.get_by_label("Name of bookmark 2").focus();
    harness.run();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.get_by_label("Name of bookmark 2").type_text("top");
    harness.run();
    assert_eq!(harness.state().0.view.bookmarks[1].name, "top");
    harness.state_mut().0.camera.as_mut().unwrap().look_from(Side::PosY);
    click(&mut harness, "Update top");
    let eye = harness.state().0.camera.unwrap().eye();
    assert_eq!(harness.state().0.view.bookmarks[1].camera.eye, eye);
    click(&mut harness, "Delete Camera 1");
    assert_eq!(harness.state().0.view.bookmarks.len(), 1);
    click(&mut harness, "Bookmark this camera");
    assert_eq!(harness.state().1, [Action::Bookmark]);
}

#[test]
fn they_are_saved_with_the_view_and_change_no_picture() {
    let session = two();
    let saved = View::from_json(&session.saved_view().to_json()).unwrap();
    assert!(saved.validate().is_ok() && saved.bookmarks == session.view.bookmarks);
    assert!(session.drawn_view().bookmarks.is_empty());
}
