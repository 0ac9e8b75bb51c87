use super::*;

const SCREEN: Screen = Screen { width: 800.0, height: 600.0 };

fn bounds() -> Option<Bounds> {
    Some(Bounds { min: DVec3::new(-1.0, 0.0, 2.0), max: DVec3::new(3.0, 1.0, 4.0) })
}

fn camera() -> OrbitCamera {
    OrbitCamera::overview(bounds(), 0.1, 4.0 / 3.0)
}

/// Where a point of the world appears on the screen.
fn project(camera: &OrbitCamera, point: DVec3) -> DVec2 {
    camera.projection(SCREEN).project(point).unwrap().at
}

/// The point of the plane through the target that is seen at `cursor`.
fn under(camera: &OrbitCamera, cursor: DVec2) -> DVec3 {
    camera.target + camera.lateral(cursor, SCREEN) * camera.distance
}

#[test]
fn the_overview_is_that_of_a_view_without_camera() {
    let view = renderer::Camera::overview(bounds(), 0.1, 0.7);
    let ours = OrbitCamera::overview(bounds(), 0.1, 0.7).to_view();
    assert!(ours.eye.distance(view.eye) < 1e-12 && ours.target == view.target && ours.up == view.up);
    assert_eq!(ours.fov_y_degrees, view.fov_y_degrees);
}

#[test]
fn orbit_keeps_the_target_and_the_distance() {
    let mut camera = camera();
    let (target, distance) = (camera.target, camera.distance);
    camera.orbit(DVec2::new(123.0, -77.0), SCREEN);
    assert_eq!(camera.target, target);
    assert!((camera.eye().distance(target) - distance).abs() < 1e-12);
    camera.orbit(DVec2::new(0.0, 1e6), SCREEN);
    assert!(camera.to_view().up.is_finite() && camera.up().dot(camera.offset()).abs() < 1e-12);
}

#[test]
fn a_drag_to_the_right_carries_the_front_to_the_right() {
    let mut camera = camera();
    let front = camera.target + 0.1 * camera.offset();
    camera.orbit(DVec2::new(20.0, 0.0), SCREEN);
    assert!(project(&camera, front).x > 400.0);
    let above = camera.target + 0.1 * camera.offset();
    camera.orbit(DVec2::new(0.0, 20.0), SCREEN);
    assert!(project(&camera, above).y > 300.0);
}

#[test]
fn what_is_panned_stays_under_the_cursor() {
    let mut camera = camera();
    let cursor = DVec2::new(250.0, 420.0);
    let point = under(&camera, cursor);
    camera.pan(DVec2::new(90.0, -40.0), SCREEN);
    assert!(project(&camera, point).distance(cursor + DVec2::new(90.0, -40.0)) < 1e-9);
}

#[test]
fn what_is_zoomed_to_stays_under_the_cursor() {
    let mut camera = camera();
    let cursor = DVec2::new(700.0, 100.0);
    let point = under(&camera, cursor);
    camera.zoom(0.25, Some(cursor), SCREEN);
    assert!(project(&camera, point).distance(cursor) < 1e-9);
    for _ in 0..200 {
        camera.zoom(0.5, Some(cursor), SCREEN);
    }
    assert!(camera.distance > 0.0 && camera.eye().is_finite());
}

#[test]
fn looking_around_keeps_the_eye() {
    let mut camera = camera();
    let eye = camera.eye();
    camera.look(DVec2::new(-31.0, 12.0), SCREEN);
    assert!(camera.eye().distance(eye) < 1e-12);
    let ahead = -camera.offset();
    camera.fly(DVec3::new(0.0, 0.0, 0.5));
    assert!((camera.eye() - eye).normalize().distance(ahead) < 1e-9);
}

#[test]
fn axis_views_look_along_their_axis_and_survive_a_saved_view() {
    for axle in [DVec3::Y, DVec3::Z, DVec3::new(0.6, 0.0, 0.8)] {
        for side in Side::ALL {
            let mut camera = camera();
            camera.set_axle(axle);
            camera.look_from(side);
            assert!(camera.offset().distance(side.direction()) < 1e-9, "{axle} {side:?}");
            let mut again = OrbitCamera { yaw: 0.3, ..camera };
            again.adopt(&camera.to_view());
            assert_eq!(again.axle, camera.axle, "{axle} {side:?}");
            for (ours, theirs) in again.axes().into_iter().zip(camera.axes()) {
                assert!(ours.distance(theirs) < 1e-6, "{axle} {side:?}");
            }
        }
    }
}

#[test]
fn a_rolled_camera_survives_a_saved_view_and_keeps_its_axle() {
    let mut camera = camera();
    for angle in [0.4, -2.9, 3.1] {
        camera.set_roll(angle);
        let mut again = OrbitCamera { yaw: 0.3, ..OrbitCamera::overview(bounds(), 0.1, 1.0) };
        again.adopt(&camera.to_view());
        assert_eq!(again.axle, camera.axle);
        assert!((again.roll - angle).abs() < 1e-9, "{angle}: {}", again.roll);
        assert!(again.up().distance(camera.up()) < 1e-9);
    }
    camera.set_roll(camera.roll() - camera.roll());
    assert_eq!(camera.to_view().up, DVec3::Y);
}

#[test]
fn a_drag_around_the_centre_carries_the_scene_along() {
    let mut camera = camera();
    let (from, to) = (DVec2::new(600.0, 300.0), DVec2::new(541.421_356_237, 441.421_356_237));
    let point = under(&camera, from);
    camera.roll_with(from, to, SCREEN);
    assert!(project(&camera, point).distance(to) < 1e-6);
    // And the other drags go on following the cursor.
    let front = camera.target + 0.1 * camera.offset();
    camera.orbit(DVec2::new(20.0, 0.0), SCREEN);
    let moved = project(&camera, front) - DVec2::new(400.0, 300.0);
    assert!(moved.x > 0.0 && moved.y.abs() < 0.1 * moved.x, "{moved}");
}

#[test]
fn walking_keeps_the_height() {
    let mut camera = camera();
    camera.orbit(DVec2::new(40.0, 150.0), SCREEN);
    camera.set_roll(0.7);
    let eye = camera.eye();
    camera.walk(DVec3::new(0.3, 0.0, 0.5));
    let moved = camera.eye() - eye;
    assert!(moved.y.abs() < 1e-12 && moved.length() > 0.5 * camera.scene_radius);
    assert!(moved.dot(-camera.offset()) > 0.0, "forward is where it looks");
    camera.walk(DVec3::new(0.0, 0.5, 0.0));
    assert!((camera.eye() - eye - moved).distance(DVec3::Y * 0.5 * camera.scene_radius) < 1e-12);
}

#[test]
fn a_foreign_up_becomes_the_axle() {
    let mut camera = camera();
    let mut view = camera.to_view();
    view.up = DVec3::new(1.0, 0.2, 0.0);
    camera.adopt(&view);
    assert!(camera.axle.distance(view.up.normalize()) < 1e-12);
    let back = camera.to_view();
    assert!(back.eye.distance(view.eye) < 1e-9);
}
