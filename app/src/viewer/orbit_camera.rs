//! Where the eye is, and how mouse and keys move it. Pure: no window, no egui, all in f64.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};
use renderer::{Bounds, CameraView};

use crate::projection::Projection;

/// A camera on a turntable: it looks at `target` from a distance, and its horizon stays level unless it
/// is rolled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitCamera {
    target: DVec3,
    /// From the eye to the target, in the unit of the run.
    distance: f64,
    /// Angle around the axle, in radians.
    yaw: f64,
    /// Angle above the turntable, in radians, −π/2 to π/2.
    pitch: f64,
    /// Angle around the view, in radians, −π to π: by so much up leans to the right.
    roll: f64,
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
            roll: 0.0,
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
        self.roll = 0.0;
        (self.near, self.far) = (None, None);
    }

    /// Takes the camera of a view. Keeps the present axle where that shows the same picture, and where up
    /// is the picture's own, which rolls the camera; any other up becomes the axle.
    pub fn adopt(&mut self, view: &CameraView) {
        let offset = view.eye - view.target;
        self.target = view.target;
        self.distance = offset.length();
        self.fov_y_degrees = view.fov_y_degrees;
        (self.near, self.far) = (view.near, view.far);
        self.roll = 0.0;
        let offset = offset / self.distance;
        let up = view.up.normalize();
        self.face(offset, up);
        let right = up.cross(offset).normalize_or_zero();
        if self.right().distance(right) <= 1e-6 {
            return;
        }
        if up.dot(offset).abs() > 1e-9 || up.abs().max_element() == 1.0 {
            self.axle = up;
            self.face(offset, up);
        } else {
            self.roll = up.dot(self.right()).atan2(up.dot(self.up()));
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
        let level = self.roll == 0.0 && self.pitch.cos() > 1e-6;
        let up = if level { self.axle } else { self.up() };
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

    /// Walks `steps` (right, up, forward) in shares of the scene's radius: up is along the axle, and the
    /// others keep the height above the turntable, whatever the camera looks at.
    pub fn walk(&mut self, steps: DVec3) {
        let [right, up, forward] = steps.to_array();
        let direction = right * self.axle.cross(self.level()) + up * self.axle - forward * self.level();
        self.target += direction * self.scene_radius;
    }

    /// How far the camera is rolled, in radians: by so much up leans to the right.
    pub fn roll(&self) -> f64 {
        self.roll
    }

    /// Rolls the camera around the view to `angle`, in radians.
    pub fn set_roll(&mut self, angle: f64) {
        let angle = (angle + PI).rem_euclid(2.0 * PI) - PI;
        // Level is level: not almost.
        self.roll = if angle.abs() < 1e-9 { 0.0 } else { angle };
    }

    /// Rolls the camera as a drag from `from` to `to` does, so that the scene follows the cursor around
    /// the picture's centre.
    pub fn roll_with(&mut self, from: DVec2, to: DVec2, screen: Screen) {
        let centre = 0.5 * DVec2::new(screen.width, screen.height);
        let (from, to) = (from - centre, to - centre);
        if from.length() > 1.0 && to.length() > 1.0 {
            self.set_roll(self.roll - from.angle_to(to));
        }
    }

    /// Looks at the target from `side`.
    pub fn look_from(&mut self, side: Side) {
        self.roll = 0.0;
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
        self.roll = 0.0;
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

    /// Turns by angles to the right and downwards in the picture.
    fn turn(&mut self, angles: DVec2) {
        let angles = DVec2::from_angle(self.roll).rotate(angles);
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
        let (right, up) = self.unrolled();
        self.roll.cos() * up + self.roll.sin() * right
    }

    fn right(&self) -> DVec3 {
        self.up().cross(self.offset())
    }

    /// Right and up of a level camera.
    fn unrolled(&self) -> (DVec3, DVec3) {
        let up = self.pitch.cos() * self.axle - self.pitch.sin() * self.level();
        (up.cross(self.offset()), up)
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
#[path = "orbit_camera_tests.rs"]
mod tests;
