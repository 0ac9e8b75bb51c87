use super::*;
use crate::viewer::orbit_camera::Side;

/// A session with a camera, whose first moment is known, and the time after that.
fn session() -> (Session, Instant) {
    let mut session = Session::new(View::default());
    session.camera = Some(OrbitCamera::overview(None, 0.0, 1.0));
    let now = Instant::now();
    session.remember(now, false);
    (session, now)
}

fn set(session: &mut Session, rate: f64) {
    session.view.sampling.rate = rate;
}

#[test]
fn a_drag_is_one_step() {
    let (mut session, now) = session();
    for step in 1..=10 {
        set(&mut session, 1.0 + f64::from(step));
        session.remember(now + step * REST, true);
    }
    session.remember(now + 10 * REST, false);
    // The next one follows at once, and is a step of its own.
    set(&mut session, 20.0);
    session.remember(now + 10 * REST, true);
    session.remember(now + 10 * REST, false);
    session.undo();
    assert_eq!(session.view.sampling.rate, 11.0);
    session.undo();
    assert_eq!(session.view.sampling.rate, 1.0);
    assert!(!session.can_undo());
    session.redo();
    session.redo();
    assert_eq!(session.view.sampling.rate, 20.0);
    assert!(!session.can_redo());
}

#[test]
fn what_wheel_and_keys_change_is_a_step_when_it_rests() {
    let (mut session, now) = session();
    for tick in 1..=5 {
        set(&mut session, 1.0 + f64::from(tick));
        session.remember(now + tick * REST / 2, false);
    }
    assert!(session.step_due().is_some_and(|due| due > now + 3 * REST));
    session.remember(now + 4 * REST, false);
    assert_eq!(session.step_due(), None);
    set(&mut session, 9.0);
    session.remember(now + 4 * REST, false);
    session.undo();
    assert_eq!(session.view.sampling.rate, 6.0, "what has not yet rested is undone by itself");
    session.undo();
    assert_eq!(session.view.sampling.rate, 1.0);
}

#[test]
fn camera_range_and_size_are_settings_too() {
    let (mut session, now) = session();
    session.range_source = RangeSource::Fixed;
    session.view.quantity.range = Some([1.0, 2.0]);
    session.remember(now, false);
    session.remember(now + REST, false);
    let before = session.camera;
    session.camera.as_mut().unwrap().look_from(Side::NegX);
    session.remember(now + REST, true);
    session.remember(now + REST, false);
    session.undo();
    assert_eq!(session.camera, before);
    session.undo();
    assert_eq!((session.range_source, session.view.quantity.range), (RangeSource::Frame, None));
    session.redo();
    assert_eq!(session.range_source, RangeSource::Fixed);
}

/// Moves the camera as its path does.
fn goes_on(session: &mut Session, by: f64) {
    let camera = session.camera.as_mut().unwrap();
    let before = *camera;
    camera.shift(glam::DVec3::new(by, 0.0, 0.0));
    session.moved_by_itself(before);
}

#[test]
fn a_step_takes_only_a_camera_back_that_the_user_moved() {
    let (mut session, now) = session();
    set(&mut session, 3.0);
    session.remember(now, true);
    session.remember(now, false);
    for _ in 0..50 {
        goes_on(&mut session, 1.0);
        session.remember(now, false);
    }
    let here = session.camera.unwrap().to_view();
    session.undo();
    assert_eq!((session.view.sampling.rate, session.camera.unwrap().to_view()), (1.0, here));
    assert!(!session.can_undo() && session.can_redo(), "to go along is no step, and ends no others");
    goes_on(&mut session, 1.0);
    session.remember(now, false);
    let farther = session.camera.unwrap().to_view();
    session.redo();
    assert_eq!((session.view.sampling.rate, session.camera.unwrap().to_view()), (3.0, farther));
    session.undo();
    session.redo();
    assert_eq!(session.camera.unwrap().to_view(), farther);
}

#[test]
fn a_camera_that_the_user_turns_on_its_way_is_a_step() {
    let (mut session, now) = session();
    goes_on(&mut session, 1.0);
    let before = session.camera.unwrap().to_view();
    session.camera.as_mut().unwrap().look_from(Side::NegX);
    session.remember(now, true);
    goes_on(&mut session, 1.0);
    session.remember(now, true);
    session.remember(now, false);
    assert!(session.can_undo());
    let turned = session.camera.unwrap().to_view();
    session.undo();
    assert_eq!(session.camera.unwrap().to_view(), before);
    session.redo();
    assert_eq!(session.camera.unwrap().to_view(), turned);
    // With the wheel, it is one when the user has rested, although the camera goes on.
    session.camera.as_mut().unwrap().look_from(Side::PosY);
    for tick in 0..5 {
        session.remember(now + tick * REST / 2, false);
        goes_on(&mut session, 1.0);
    }
    assert_eq!((session.history.past.len(), session.step_due()), (2, None));
}

#[test]
fn the_field_of_the_opacity_is_a_setting_with_its_range() {
    let (mut session, now) = session();
    session.remember(now, false);
    session.view.quantity.opacity = Some(renderer::OpacityView::default());
    session.remember(now, true);
    session.remember(now, false);
    session.opacity_source = RangeSource::Seen;
    session.remember(now, true);
    session.remember(now, false);
    session.undo();
    assert_eq!(session.opacity_source, RangeSource::Frame);
    assert!(session.view.quantity.opacity.is_some());
    session.undo();
    assert_eq!(session.view.quantity.opacity, None);
    session.redo();
    session.redo();
    assert_eq!(session.opacity_source, RangeSource::Seen);
}

#[test]
fn neither_the_first_camera_nor_the_size_of_the_window_is_a_step() {
    let mut session = Session::new(View::default());
    let now = Instant::now();
    session.remember(now, false);
    session.camera = Some(OrbitCamera::overview(None, 0.0, 1.0));
    (session.view.image.width, session.view.image.height) = (333, 222);
    session.remember(now, false);
    session.remember(now + 2 * REST, false);
    assert!(!session.can_undo());
    set(&mut session, 3.0);
    session.remember(now + 2 * REST, false);
    session.undo();
    assert!(session.camera.is_some());
    assert_eq!((session.view.image.width, session.view.sampling.rate), (333, 1.0));
}

#[test]
fn a_new_step_ends_what_was_undone_and_old_ones_are_forgotten() {
    let (mut session, now) = session();
    for step in 0..STEPS as u32 + 50 {
        set(&mut session, 2.0 + f64::from(step));
        session.remember(now, true);
        session.remember(now, false);
    }
    session.undo();
    set(&mut session, 1.5);
    session.remember(now, true);
    session.remember(now, false);
    assert!(!session.can_redo());
    let steps = std::iter::from_fn(|| session.can_undo().then(|| session.undo())).count();
    assert_eq!(steps, STEPS);
    session.undo();
    session.redo();
    assert_eq!(session.view.sampling.rate, 52.0);
}
