//! A camera as what can be mixed with another one.

use glam::{DMat3, DQuat, DVec3};
use renderer::CameraView;

/// A camera taken apart so that halfway between two cameras lies a camera that looks like it: as far
/// again from one as from the other in sight, and turned by half.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    target: DVec3,
    /// From target to eye. Distances, fields of view and depths are seen by their ratios.
    log_distance: f64,
    /// Turns X, Y and Z to the camera's right, up and backwards.
    turn: DQuat,
    /// Up as the camera gives it, a unit vector: between level cameras, all are level.
    up: DVec3,
    /// ln tan(σ/2) of the vertical field of view σ.
    log_zoom: f64,
    log_near: Option<f64>,
    log_far: Option<f64>,
}

impl Pose {
    /// Of a camera that is settled and valid.
    pub fn of(camera: &CameraView) -> Pose {
        let back = camera.eye - camera.target;
        let (distance, up) = (back.length(), camera.up.normalize());
        let back = back / distance;
        let right = up.cross(back).normalize();
        Pose {
            target: camera.target,
            log_distance: distance.ln(),
            turn: DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)),
            up,
            log_zoom: (camera.fov_y_degrees.to_radians() / 2.0).tan().ln(),
            log_near: camera.near.map(f64::ln),
            log_far: camera.far.map(f64::ln),
        }
    }

    /// The pose at the share `s` of the way from `self` to `other`: 0 and 1 are the two, and beyond them
    /// the way goes on.
    pub fn mix(&self, other: &Pose, s: f64) -> Pose {
        let mix = |a: f64, b: f64| a + s * (b - a);
        let both = |a: Option<f64>, b: Option<f64>| Some(mix(a?, b?));
        Pose {
            target: self.target + s * (other.target - self.target),
            log_distance: mix(self.log_distance, other.log_distance),
            // The shorter way round.
            turn: self.turn.slerp(other.turn, s).normalize(),
            up: self.up + s * (other.up - self.up),
            log_zoom: mix(self.log_zoom, other.log_zoom),
            log_near: both(self.log_near, other.log_near),
            log_far: both(self.log_far, other.log_far),
        }
    }

    pub fn to_camera(self) -> CameraView {
        let back = self.turn * DVec3::Z;
        // Where the view passes the axle, up comes from the turn.
        let up = self.up.try_normalize().filter(|up| up.cross(back).length() > 1e-3);
        CameraView {
            eye: self.target + self.log_distance.exp() * back,
            target: self.target,
            up: up.unwrap_or(self.turn * DVec3::Y),
            fov_y_degrees: 2.0 * self.log_zoom.exp().atan().to_degrees(),
            near: self.log_near.map(f64::exp),
            far: self.log_far.map(f64::exp),
        }
    }
}
