//! Where the camera is at each frame of a run: pure, for the window and for saved pictures alike.
//!
//! Between keyframes, it moves on a Catmull–Rom spline over the frames' numbers, by the pyramid of linear
//! mixtures of Barry and Goldman (*A Recursive Evaluation Algorithm for a Class of Catmull–Rom Splines*,
//! SIGGRAPH 1988). Its knots are the keyframes' frames, so that the speed does not jump at a keyframe
//! however unevenly they are set. Mixtures of directions are spherical ones of quaternions (Schlag,
//! *Using Geometric Constructions to Interpolate Orientation with Quaternions*, Graphics Gems II, 1991);
//! those of distances, fields of view and depths are mixtures of their logarithms. Beyond the first and
//! last keyframe it stands still.

mod pose;

use std::f64::consts::TAU;

use glam::DQuat;
use renderer::{Camera, CameraView, Keyframe, ParticleSet, PathView, View};

pub use pose::Pose;

/// The camera of `view` at frame `number` of a run of `frames` frames, with what it leaves open settled by
/// the frame's `particles`; the view's own, open or not, where it has no path.
pub fn camera_of(view: &View, particles: &ParticleSet, number: usize, frames: usize) -> Option<CameraView> {
    match view.path.is_empty() {
        true => view.camera,
        false => Some(camera_at(&view.path, &settled(view, particles), number as f64, frames)),
    }
}

/// The camera that `view` has without a path.
pub fn settled(view: &View, particles: &ParticleSet) -> CameraView {
    let aspect = f64::from(view.image.width) / f64::from(view.image.height);
    let whole = particles.whole();
    let (bounds, margin) = (whole.bounds, whole.support_radii[1]);
    match view.camera {
        Some(camera) => camera.settled(bounds, margin, aspect),
        None => Camera::overview(bounds, margin, aspect),
    }
}

/// The camera at `frame` of a run of `frames` frames, both counted as the keyframes are. `base` is where
/// it stands without keyframes; it is settled.
pub fn camera_at(path: &PathView, base: &CameraView, frame: f64, frames: usize) -> CameraView {
    let camera = between(&path.keyframes, frame).unwrap_or(*base);
    // The last frame stands just before the first one, so that a film of it can be played in a loop.
    turned(&camera, path.revolutions * frame / frames.max(1) as f64)
}

/// The same camera after so many turns around its target, counter-clockwise as seen from above.
pub fn turned(camera: &CameraView, revolutions: f64) -> CameraView {
    let turns = revolutions.fract();
    let Some(up) = camera.up.try_normalize().filter(|_| turns != 0.0) else { return *camera };
    let turn = DQuat::from_axis_angle(up, TAU * turns);
    CameraView { eye: camera.target + turn * (camera.eye - camera.target), ..*camera }
}

/// The camera between keyframes; `None` without any.
fn between(keys: &[Keyframe], frame: f64) -> Option<CameraView> {
    let (first, last) = (keys.first()?, keys.last()?);
    let after = keys.partition_point(|key| key.frame <= frame);
    if after == 0 || after == keys.len() {
        return Some(if after == 0 { first.camera } else { last.camera });
    }
    let knot = |place: usize| (keys[place].frame, Pose::of(&keys[place].camera));
    let (from, to) = (knot(after - 1), knot(after));
    if from.0 == frame {
        return Some(keys[after - 1].camera);
    }
    // Before the first keyframe and behind the last one, the way goes on straight.
    let mirrored = |end: (f64, Pose), inner: (f64, Pose)| (2.0 * end.0 - inner.0, inner.1.mix(&end.1, 2.0));
    let before = if after >= 2 { knot(after - 2) } else { mirrored(from, to) };
    let behind = if after + 1 < keys.len() { knot(after + 1) } else { mirrored(to, from) };
    Some(spline([before, from, to, behind], frame).to_camera())
}

/// The pyramid: mixtures of neighbours, of those mixtures, and of those again.
fn spline(knots: [(f64, Pose); 4], t: f64) -> Pose {
    let mix = |a: &Pose, b: &Pose, from: f64, to: f64| a.mix(b, (t - from) / (to - from));
    let [(t0, p0), (t1, p1), (t2, p2), (t3, p3)] = knots;
    let (a, b, c) = (mix(&p0, &p1, t0, t1), mix(&p1, &p2, t1, t2), mix(&p2, &p3, t2, t3));
    let (a, b) = (mix(&a, &b, t0, t2), mix(&b, &c, t1, t3));
    mix(&a, &b, t1, t2)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn camera(eye: [f64; 3], target: [f64; 3]) -> CameraView {
        CameraView {
            eye: DVec3::from_array(eye),
            target: DVec3::from_array(target),
            up: DVec3::Y,
            fov_y_degrees: 35.0,
            near: None,
            far: None,
        }
    }

    fn path(cameras: &[(f64, CameraView)]) -> PathView {
        let keyframes = cameras.iter().map(|&(frame, camera)| Keyframe { frame, camera }).collect();
        PathView { keyframes, revolutions: 0.0 }
    }

    fn uneven() -> PathView {
        path(&[
            (2.0, camera([0.0, 1.0, 5.0], [0.0; 3])),
            (5.0, camera([4.0, 2.0, 4.0], [0.5, 0.0, 0.0])),
            (15.0, camera([6.0, -1.0, -3.0], [1.0, 0.5, 0.0])),
            (20.0, CameraView { fov_y_degrees: 60.0, ..camera([-1.0, 0.0, -8.0], [0.0, 1.0, 0.0]) }),
        ])
    }

    const BASE: CameraView = CameraView {
        eye: DVec3::new(0.0, 0.0, 9.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_y_degrees: 35.0,
        near: None,
        far: None,
    };

    #[test]
    fn at_its_keyframes_it_is_where_they_are_and_beyond_them_it_stands() {
        let path = uneven();
        for key in &path.keyframes {
            assert_eq!(camera_at(&path, &BASE, key.frame, 30), key.camera);
        }
        assert_eq!(camera_at(&path, &BASE, 0.0, 30), path.keyframes[0].camera);
        assert_eq!(camera_at(&path, &BASE, 29.0, 30), path.keyframes[3].camera);
        assert_eq!(camera_at(&PathView::default(), &BASE, 7.0, 30), BASE);
    }

    #[test]
    fn it_moves_without_a_jump_in_place_or_speed_and_stays_level() {
        let path = uneven();
        let step = 1e-3;
        let eye = |frame: f64| camera_at(&path, &BASE, frame, 30).eye;
        let speed = |frame: f64| (eye(frame + step) - eye(frame)) / step;
        let mut frame = 2.0;
        while frame < 20.0 - 2.0 * step {
            let change = (speed(frame + step) - speed(frame)).length();
            assert!(change < 0.05, "at {frame} the speed changes by {change}");
            let camera = camera_at(&path, &BASE, frame, 30);
            assert!(camera.validate().is_ok() && camera.up.distance(DVec3::Y) < 1e-12);
            frame += 7.0 * step;
        }
    }

    #[test]
    fn two_keyframes_are_a_straight_way_at_an_even_pace() {
        let near = camera([0.0, 0.0, 1.0], [0.0; 3]);
        let far = camera([16.0, 0.0, 0.0], [0.0; 3]);
        let path = path(&[(0.0, near), (4.0, far)]);
        for (frame, distance) in [(1.0, 2.0), (2.0, 4.0), (3.0, 8.0)] {
            let eye = camera_at(&path, &BASE, frame, 5).eye;
            assert!((eye.length() / distance - 1.0).abs() < 1e-9, "{eye}");
            let angle = eye.angle_between(DVec3::Z).to_degrees();
            assert!((angle - 22.5 * frame).abs() < 1e-6, "{angle}");
        }
    }

    #[test]
    fn a_turntable_comes_back_after_the_last_frame() {
        let path = PathView { revolutions: 1.0, ..PathView::default() };
        let eye = |frame: f64| camera_at(&path, &BASE, frame, 8).eye;
        assert_eq!(eye(0.0), BASE.eye);
        assert!(eye(2.0).distance(DVec3::new(9.0, 0.0, 0.0)) < 1e-9, "counter-clockwise from above");
        assert!(eye(8.0).distance(BASE.eye) < 1e-9);
        assert!((1..8).all(|frame| eye(f64::from(frame)).distance(BASE.eye) > 1.0));
    }

    #[test]
    fn cameras_that_are_rolled_or_look_along_the_axle_are_passed_through() {
        let above = CameraView { up: DVec3::NEG_Z, ..camera([0.0, 5.0, 0.0], [0.0; 3]) };
        let rolled =
            CameraView { up: DVec3::new(1.0, 1.0, 0.0).normalize(), ..camera([0.0, 0.0, 5.0], [0.0; 3]) };
        let path = path(&[(0.0, rolled), (4.0, above), (8.0, camera([5.0, 0.0, 0.0], [0.0; 3]))]);
        for quarter in 0..=32 {
            let camera = camera_at(&path, &BASE, f64::from(quarter) / 4.0, 9);
            assert!(camera.validate().is_ok(), "{quarter}: {camera:?}");
        }
    }
}
