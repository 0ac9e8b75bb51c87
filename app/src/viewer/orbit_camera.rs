//! Where the eye is, and how mouse and keys move it. Pure: no window, no egui, all in f64.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};
use renderer::{Bounds, CameraView};

use crate::projection::Projection;

/// A camera on a turntable: it looks at `target` from a distance, and its horizon stays level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitCamera {
    target: DVec3,
    /// From the eye to the target, in the unit of the run.
    distance: f64,
    /// Angle around the axle, in radians.
    yaw: f64,
    /// Angle above the turntable, in radians, −π/2 to π/2.
    pitch: f64,
    /// The turntable's axle, a unit vector.
    axle: DVec3,
    /// Vertical field of view in degrees.
    pub fov_y_degrees: f64,
    /// Near and far view depths fixed by hand.
    pub near: Option<f64>,
    pub far: Option<f64>,
    /// Radius of the scene, which limits the distance and sets the speed of flying.
    scene_radius: f64,
}

/// Field of view of a new camera, in degrees.
const DEFAULT_FOV: f64 = 35.0;
/// Closest and farthest distance, as shares of the scene's radius.
const DISTANCE_LIMITS: [f64; 2] = [1e-3, 1e2];
/// Where a new camera stands: to the front right, a little above (right, up, front).
const OVERVIEW: [f64; 3] = [0.55, 0.40, 0.75];

/// The side from which an axis view looks at the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    PosX,
    NegX,
    PosY,
    NegY,
    PosZ,
    NegZ,
}

impl Side {
    pub const ALL: [Side; 6] = [Side::PosX, Side::NegX, Side::PosY, Side::NegY, Side::PosZ, Side::NegZ];

    pub fn label(self) -> &'static str {
        ["+X", "−X", "+Y", "−Y", "+Z", "−Z"][self as usize]
    }

    fn direction(self) -> DVec3 {
        [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z][self as usize]
    }
}

/// A picture's place on the screen, for turning cursor positions into rays. All in the same unit.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    pub width: f64,
    pub height: f64,
}

impl OrbitCamera {
    /// A camera that has `bounds`, grown by `margin`, in view: the same one that a view without a
    /// camera stands for.
    pub fn overview(bounds: Option<Bounds>, margin: f64, aspect: f64) -> OrbitCamera {
        let mut camera = OrbitCamera {
            target: DVec3::ZERO,
            distance: 1.0,
            yaw: 0.0,
            pitch: 0.0,
            axle: DVec3::Y,
            fov_y_degrees: DEFAULT_FOV,
            near: None,
            far: None,
            scene_radius: 1.0,
        };
        camera.reset(bounds, margin, aspect);
        camera
    }

    /// Goes back to the overview, keeping the axle and the field of view.
    pub fn reset(&mut self, bounds: Option<Bounds>, margin: f64, aspect: f64) {
        let (target, radius) =
            bounds.map_or((DVec3::ZERO, 1.0), |b| (b.centre(), 0.5 * b.diagonal() + margin));
        self.scene_radius = if radius.is_finite() && radius > 0.0 { radius } else { 1.0 };
        let half = (self.fov_y_degrees.to_radians() / 2.0).tan() * aspect.min(1.0);
        self.target = target;
        self.distance = self.scene_radius / half.atan().sin();
        let [right, up, front] = OVERVIEW;
        self.yaw = right.atan2(front);
        self.pitch = up.atan2(right.hypot(front));
        (self.near, self.far) = (None, None);
    }

    /// Takes the camera of a view; keeps the present axle where that shows the same picture.
    pub fn adopt(&mut self, view: &CameraView) {
        let offset = view.eye - view.target;
        self.target = view.target;
        self.distance = offset.length();
        self.fov_y_degrees = view.fov_y_degrees;
        (self.near, self.far) = (view.near, view.far);
        self.face(offset / self.distance, view.up);
        let right = (-offset).cross(view.up).normalize_or_zero();
        if self.right().distance(right) > 1e-6 {
            self.axle = view.up.normalize();
            self.face(offset / self.distance, view.up);
        }
    }

    /// Tells the camera how large the scene is.
    pub fn set_scene(&mut self, bounds: Option<Bounds>, margin: f64) {
        let radius = bounds.map_or(1.0, |b| 0.5 * b.diagonal() + margin);
        if radius.is_finite() && radius > 0.0 {
            self.scene_radius = radius;
        }
    }

    /// The camera as a view holds it.
    pub fn to_view(self) -> CameraView {
        // At the poles the axle lies in the viewing direction and says nothing about up.
        let up = if self.pitch.cos() > 1e-6 { self.axle } else { self.up() };
        CameraView {
            eye: self.eye(),
            target: self.target,
            up,
            fov_y_degrees: self.fov_y_degrees,
            near: self.near,
            far: self.far,
        }
    }

    /// Turns around the target as a drag by `delta` does, so that the scene follows the cursor.
    pub fn orbit(&mut self, delta: DVec2, screen: Screen) {
        self.turn(delta * (PI / screen.height.max(1.0)));
    }

    /// Looks around from where the eye is, as a drag by `delta` does.
    pub fn look(&mut self, delta: DVec2, screen: Screen) {
        let eye = self.eye();
        let tan = (self.fov_y_degrees.to_radians() / 2.0).tan();
        self.turn(delta * (2.0 * tan.atan() / screen.height.max(1.0)));
        self.target = eye - self.distance * self.offset();
    }

    /// Moves in the view plane, so that a point at the target's depth stays under the cursor.
    pub fn pan(&mut self, delta: DVec2, screen: Screen) {
        let scale = self.projection(screen).length_at(self.distance);
        self.target += scale * (delta.y * self.up() - delta.x * self.right());
    }

    /// Multiplies the distance by `factor`; the point at the target's depth under `cursor`
    /// (from the picture's upper left corner; its centre where it is `None`) keeps its place.
    pub fn zoom(&mut self, factor: f64, cursor: Option<DVec2>, screen: Screen) {
        let [nearest, farthest] = DISTANCE_LIMITS.map(|share| share * self.scene_radius);
        let distance =
            (self.distance * factor).clamp(nearest.min(self.distance), farthest.max(self.distance));
        let lateral = cursor.map_or(DVec3::ZERO, |cursor| self.lateral(cursor, screen));
        self.target += lateral * (self.distance - distance);
        self.distance = distance;
    }

    /// Makes the point under `cursor`, at the target's depth, the new target.
    pub fn centre_on(&mut self, cursor: DVec2, screen: Screen) {
        self.target += self.lateral(cursor, screen) * self.distance;
    }

    /// Looks at `point` from as far away, and from the same side, as at the target before.
    pub fn look_at(&mut self, point: DVec3) {
        self.target = point;
    }

    /// Goes along `way`, eye and target alike.
    pub fn shift(&mut self, way: DVec3) {
        self.target += way;
    }

    /// Flies `steps` (right, up, forward) in shares of the scene's radius.
    pub fn fly(&mut self, steps: DVec3) {
        let [right, up, forward] = steps.to_array();
        let direction = right * self.right() + up * self.up() - forward * self.offset();
        self.target += direction * self.scene_radius;
    }

    /// Looks at the target from `side`.
    pub fn look_from(&mut self, side: Side) {
        let up = if side.direction().dot(self.axle).abs() > 0.5 {
            // Seen from above, what was in front is at the bottom.
            -self.basis().0 * side.direction().dot(self.axle).signum()
        } else {
            self.axle
        };
        self.face(side.direction(), up);
    }

    /// The turntable's axle.
    pub fn axle(&self) -> DVec3 {
        self.axle
    }

    /// Puts the turntable on another axle, and looks from the front right again.
    pub fn set_axle(&mut self, axle: DVec3) {
        self.axle = axle.try_normalize().unwrap_or(DVec3::Y);
        let [right, up, front] = OVERVIEW;
        self.yaw = right.atan2(front);
        self.pitch = up.atan2(right.hypot(front));
    }

    pub fn eye(&self) -> DVec3 {
        self.target + self.distance * self.offset()
    }

    /// From the eye to the target, in the unit of the run.
    pub fn distance(&self) -> f64 {
        self.distance
    }

    /// Unit vectors of the picture's axes: right, up, and towards the viewer.
    pub fn axes(&self) -> [DVec3; 3] {
        [self.right(), self.up(), self.offset()]
    }

    /// Where points of the world are on `screen`.
    pub fn projection(&self, screen: Screen) -> Projection {
        Projection {
            eye: self.eye(),
            right: self.right(),
            up: self.up(),
            forward: -self.offset(),
            tan_half_fov: (self.fov_y_degrees.to_radians() / 2.0).tan(),
            width: screen.width,
            height: screen.height.max(1.0),
        }
    }

    fn turn(&mut self, angles: DVec2) {
        self.yaw = (self.yaw - angles.x).rem_euclid(2.0 * PI);
        self.pitch = (self.pitch + angles.y).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// Sets the angles so that the eye lies in direction `offset` (a unit vector) of the target; at
    /// the poles, so that `up` is up.
    fn face(&mut self, offset: DVec3, up: DVec3) {
        let (front, side) = self.basis();
        self.pitch = offset.dot(self.axle).clamp(-1.0, 1.0).asin();
        let level = if self.pitch.cos() > 1e-6 { offset } else { -up * self.pitch.signum() };
        self.yaw = level.dot(side).atan2(level.dot(front)).rem_euclid(2.0 * PI);
    }

    /// Unit vectors of the turntable: where yaw 0 stands, and a quarter turn further.
    fn basis(&self) -> (DVec3, DVec3) {
        let front = match self.axle {
            DVec3::Y => DVec3::Z,
            DVec3::Z => DVec3::NEG_Y,
            axle => axle.any_orthonormal_vector(),
        };
        (front, self.axle.cross(front))
    }

    /// From the target to the eye, a unit vector.
    fn offset(&self) -> DVec3 {
        self.pitch.cos() * self.level() + self.pitch.sin() * self.axle
    }

    fn up(&self) -> DVec3 {
        self.pitch.cos() * self.axle - self.pitch.sin() * self.level()
    }

    fn right(&self) -> DVec3 {
        self.up().cross(self.offset())
    }

    fn level(&self) -> DVec3 {
        let (front, side) = self.basis();
        self.yaw.cos() * front + self.yaw.sin() * side
    }

    /// Sideways part of the ray under `cursor`, for each unit of depth.
    fn lateral(&self, cursor: DVec2, screen: Screen) -> DVec3 {
        self.projection(screen).sideways(cursor)
    }
}

#[cfg(test)]
mod tests {
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
    fn a_foreign_up_becomes_the_axle() {
        let mut camera = camera();
        let mut view = camera.to_view();
        view.up = DVec3::new(1.0, 0.2, 0.0);
        camera.adopt(&view);
        assert!(camera.axle.distance(view.up.normalize()) < 1e-12);
        let back = camera.to_view();
        assert!(back.eye.distance(view.eye) < 1e-9);
    }
}
