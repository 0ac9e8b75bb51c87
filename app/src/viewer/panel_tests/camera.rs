use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use renderer::Stats;

use super::{assert_written, fluid, panel, pictured, shown};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::panels::camera;
use crate::viewer::picture::picture_view::Motion;
use crate::viewer::render_thread::Report;
use crate::viewer::session::Session;

type State = (Session, Motion, Vec<Action>);

fn ready() -> Session {
    pictured(fluid(), Stats { near: 3.0, far: 9.0, ..Stats::default() })
}

fn camera_panel(session: Session) -> Harness<'static, State> {
    panel((session, Motion::Orbit, Vec::new()), |ui, (session, motion, actions)| {
        camera::show(ui, session, motion, actions);
    })
}

fn click(harness: &mut Harness<'_, State>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

/// Types a number into a field, as a double click and the keyboard do.
fn type_into(harness: &mut Harness<'_, State>, label: &str, text: &str) {
    harness.get_by_label(label).click();
    harness.run();
    harness.get_by_label(label).type_text(text);
    harness.key_press(egui::Key::Enter);
    harness.run();
    harness.run();
}

#[test]
fn eye_and_target_are_typed() {
    let mut harness = camera_panel(ready());
    type_into(&mut harness, "Eye x", "7.5");
    type_into(&mut harness, "Target z", "-2");
    let view = harness.state().0.camera.unwrap().to_view();
    assert!((view.eye.x - 7.5).abs() < 1e-9 && (view.target.z + 2.0).abs() < 1e-9, "{view:?}");
    type_into(&mut harness, "Field of view", "60");
    assert!((harness.state().0.camera.unwrap().fov_y_degrees - 60.0).abs() < 1e-9);
}

#[test]
fn what_is_no_camera_is_not_taken() {
    let mut session = ready();
    let camera = session.camera.as_mut().unwrap();
    let mut view = camera.to_view();
    (view.eye, view.target) = (DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO);
    camera.adopt(&view);
    let mut harness = camera_panel(session);
    type_into(&mut harness, "Eye z", "0");
    let eye = harness.state().0.camera.unwrap().eye();
    assert!(eye.distance(view.eye) < 1e-9, "eye and target would be one: {eye}");
}

#[test]
fn it_rolls_in_steps_and_back() {
    let mut harness = camera_panel(ready());
    click(&mut harness, "+15°");
    click(&mut harness, "+15°");
    assert!((harness.state().0.camera.unwrap().roll().to_degrees() - 30.0).abs() < 1e-9);
    click(&mut harness, "−15°");
    assert!((harness.state().0.camera.unwrap().roll().to_degrees() - 15.0).abs() < 1e-9);
    click(&mut harness, "Level");
    assert_eq!(harness.state().0.camera.unwrap().roll(), 0.0);
    assert_eq!(harness.state().0.camera.unwrap().to_view().up, DVec3::Y);
    click(&mut harness, "Z up");
    assert_eq!(harness.state().0.camera.unwrap().axle(), DVec3::Z);
}

#[test]
fn the_way_to_move_is_chosen_and_the_camera_is_copied_and_pasted() {
    let mut harness = camera_panel(ready());
    click(&mut harness, "Walk");
    assert_eq!(harness.state().1, Motion::Walk);
    for label in ["Whole scene", "Copy", "Paste"] {
        click(&mut harness, label);
    }
    assert_eq!(harness.state().2, [Action::Reset, Action::CopyCamera, Action::PasteCamera]);
}

#[test]
fn near_and_far_are_automatic_until_they_are_fixed() {
    let mut harness = camera_panel(ready());
    click(&mut harness, "Near automatic");
    assert_eq!(harness.state().0.camera.unwrap().near, Some(3.0));
    click(&mut harness, "Near automatic");
    assert_eq!(harness.state().0.camera.unwrap().near, None);
}

#[test]
fn what_near_cuts_off_is_told_and_given_back() {
    let mut session = ready();
    let distance = session.camera.unwrap().distance();
    session.camera.as_mut().unwrap().near = Some(distance);
    let shown = shown(&session, Stats { near: distance, far: 2.0 * distance, ..Stats::default() });
    assert!(shown.facts.cut[0].is_some_and(|depth| depth < distance) && shown.facts.cut[1].is_none());
    session.note(&Report::Picture(Box::new(shown)));
    let mut harness = camera_panel(session);
    click(&mut harness, "Fit near");
    assert_eq!(harness.state().0.camera.unwrap().near, None);
    assert!(harness.query_by_label("Fit near").is_none(), "nothing is cut off any more");
    assert_written(&harness, &["Near", "Far"]);
}
