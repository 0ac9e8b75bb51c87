//! What a cursor over the picture reaches in the world. Pure, in f64.

use glam::{DVec2, DVec3};

use crate::projection::Projection;

/// The ray under the cursor: a point of it, and its direction as a unit vector.
pub fn ray(projection: &Projection, cursor: DVec2, depth: f64) -> (DVec3, DVec3) {
    let [from, to] = [depth, 2.0 * depth].map(|depth| projection.unproject(cursor, depth));
    (from, (to - from).normalize_or(projection.forward))
}

/// How far along `direction` (a unit vector) from `point` the cursor is; `None` where the direction
/// points at the eye, so that all of it is under one cursor.
pub fn along(projection: &Projection, cursor: DVec2, point: DVec3, direction: DVec3) -> Option<f64> {
    let depth = projection.project(point)?.depth;
    let (from, ray) = ray(projection, cursor, depth);
    let (way, slant) = (point - from, direction.dot(ray));
    let across = 1.0 - slant * slant;
    (across > 1e-3).then(|| (slant * way.dot(ray) - way.dot(direction)) / across)
}

/// The direction (a unit vector) from `centre` to where the cursor meets the sphere of `radius` around
/// it: its side towards the eye, or the `far` one; past its edge, the nearest point of the edge.
pub fn around(
    projection: &Projection,
    cursor: DVec2,
    centre: DVec3,
    radius: f64,
    far: bool,
) -> Option<DVec3> {
    let depth = projection.project(centre)?.depth;
    let (from, ray) = ray(projection, cursor, depth);
    let nearest = from + (centre - from).dot(ray) * ray;
    let miss = nearest - centre;
    let half_chord = (radius * radius - miss.length_squared()).max(0.0).sqrt();
    let way = if far { half_chord } else { -half_chord };
    (miss + way * ray).try_normalize()
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use renderer::CameraView;

    /// Looks at the origin from the front right.
    pub fn projection() -> Projection {
        let camera = CameraView {
            eye: DVec3::new(3.0, 2.0, 6.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            fov_y_degrees: 40.0,
            near: None,
            far: None,
        };
        Projection::new(&camera, [800.0, 600.0])
    }

    #[test]
    fn the_cursor_reaches_along_a_line() {
        let p = projection();
        let (point, direction) = (DVec3::new(0.3, -0.2, 0.5), DVec3::new(0.6, 0.8, 0.0));
        for way in [-0.7, 0.0, 1.3] {
            let cursor = p.project(point + way * direction).unwrap().at;
            assert!((along(&p, cursor, point, direction).unwrap() - way).abs() < 1e-9);
        }
        let at_the_eye = (p.eye - point).normalize();
        assert_eq!(along(&p, p.project(point).unwrap().at, point, at_the_eye), None);
    }

    #[test]
    fn the_cursor_reaches_around_a_sphere() {
        let p = projection();
        let centre = DVec3::new(0.1, 0.2, 0.0);
        let towards = (p.eye - centre).normalize();
        for direction in [towards, (towards + 0.4 * p.right).normalize(), (-towards + 0.3 * p.up).normalize()]
        {
            let cursor = p.project(centre + 0.5 * direction).unwrap().at;
            let far = direction.dot(towards) < 0.0;
            let found = around(&p, cursor, centre, 0.5, far).unwrap();
            assert!(found.distance(direction) < 1e-6, "{found} is not {direction}");
        }
        let past = around(&p, DVec2::new(520.0, 300.0), centre, 0.5, false).unwrap();
        assert!(past.dot(p.right) > 0.8);
    }
}
