//! The plain scene with one thing at the end of what makes sense: lenses, depths, lengths, quantities,
//! transfer functions. What is asked of their pictures is the tests' own.

use glam::DVec3;
use renderer::{CameraView, ControlPoint};

use crate::scenes::{self, Scene, grey};

/// Width and height in pixels.
type Size = [u32; 2];

/// A plain scene under another name.
pub fn plain(name: impl Into<String>, seed: u64, [width, height]: Size) -> Scene {
    Scene { name: name.into(), ..scenes::plain(seed, width, height) }
}

/// A plain scene with another camera.
pub fn with_camera(name: &str, size: Size, change: impl Fn(&mut CameraView)) -> Scene {
    let mut scene = plain(name, 30, size);
    change(camera_of(&mut scene));
    scene
}

fn camera_of(scene: &mut Scene) -> &mut CameraView {
    scene.view.camera.as_mut().expect("plain scenes have a camera")
}

pub fn depths_over_six_decades(size: Size) -> [Scene; 3] {
    [
        with_camera("from inside, 1e-3 to 1e3", size, |camera| {
            (camera.eye, camera.near, camera.far) = (DVec3::new(0.1, 0.2, 0.3), Some(1e-3), Some(1e3));
        }),
        with_camera("from outside, 1e-3 to 1e3", size, |camera| {
            (camera.near, camera.far) = (Some(1e-3), Some(1e3));
        }),
        with_camera("a thousandth of a radius deep", size, |camera| {
            (camera.near, camera.far) = (Some(4.0), Some(4.0005));
        }),
    ]
}

pub fn fields_of_view(size: Size) -> [Scene; 3] {
    [
        with_camera("1 degree", size, |camera| {
            camera.eye = DVec3::new(0.0, 30.0, 110.0);
            camera.fov_y_degrees = 1.0;
            (camera.near, camera.far) = (Some(112.0), Some(116.0));
        }),
        with_camera("170 degrees", size, |camera| {
            camera.eye = DVec3::new(0.2, 0.1, 1.3);
            camera.fov_y_degrees = 170.0;
            (camera.near, camera.far) = (Some(0.05), Some(3.0));
        }),
        with_camera("170 degrees, from inside", size, |camera| {
            camera.eye = DVec3::new(0.2, 0.1, 0.3);
            camera.fov_y_degrees = 170.0;
            (camera.near, camera.far) = (Some(0.01), Some(3.0));
        }),
    ]
}

/// From `distance` radii away, with a field of view that the scene fills.
pub fn through_a_long_lens(distance: f64, size: Size) -> Scene {
    let mut scene = plain(format!("{distance} radii away"), 42, size);
    let depth = distance * scene.particles[0].support_radius;
    let camera = camera_of(&mut scene);
    camera.eye = DVec3::new(0.0, 0.0, depth);
    camera.fov_y_degrees = 2.0 * (1.3 / depth).atan().to_degrees();
    (camera.near, camera.far) = (Some(depth - 1.6), Some(depth + 1.6));
    scene
}

pub fn with_reference_length(length: f64, size: Size) -> Scene {
    let mut scene = plain(format!("reference length {length:e}"), 38, size);
    scene.view.transfer.reference_length = Some(length);
    scene
}

pub fn at_rate(rate: f64, size: Size) -> Scene {
    let mut scene = plain(format!("rate {rate}"), 41, size);
    scene.view.sampling.rate = rate;
    scene
}

/// Every seventh quantity is `far` or −`far`, with a range from 0 to 1.
pub fn with_outliers(far: f64, size: Size) -> Scene {
    let mut scene = plain(format!("outliers of {far}"), 41, size);
    for (index, particle) in scene.particles.iter_mut().enumerate().filter(|(index, _)| index % 7 == 0) {
        particle.quantity = if index % 2 == 0 { far } else { -far };
    }
    scene
}

/// With the quantity `quantity` of what it is in the plain scene, and a range of it.
pub fn with_quantity(name: &str, size: Size, range: [f64; 2], quantity: impl Fn(f64) -> f64) -> Scene {
    let mut scene = plain(name, 36, size);
    scene.view.quantity.range = Some(range);
    scene.particles.iter_mut().for_each(|particle| particle.quantity = quantity(particle.quantity));
    scene
}

pub fn quantities_at_the_edge_of_their_numbers(size: Size) -> [Scene; 9] {
    [
        with_quantity("constant, range of no width", size, [0.7, 0.7], |_| 0.7),
        with_quantity("constant 1e38", size, [0.0, 2e38], |_| 1e38),
        with_quantity("up to 3e38", size, [0.0, 3e38], |q| 3e38 * q),
        with_quantity("either sign of 3e38", size, [-3e38, 3e38], |q| 6e38 * (q - 0.5)),
        with_quantity("denormal in f32", size, [0.0, 1e-40], |q| 1e-40 * q),
        with_quantity("constant and denormal", size, [0.0, 1e-310], |_| 5e-311),
        with_quantity("a small difference of large values", size, [1e6, 1e6 + 0.01], |q| 1e6 + 0.01 * q),
        with_quantity("all below the range", size, [5.0, 6.0], |q| q),
        with_quantity("all above the range", size, [-6.0, -5.0], |q| q),
    ]
}

/// Nothing to be seen.
pub fn clear(size: Size) -> Scene {
    with_transfer("clear", size, vec![grey(0.0, 1.0, 0.0), grey(1.0, 0.5, 0.0)])
}

pub fn transfer_functions_at_their_ends(size: Size) -> [Scene; 7] {
    let step = vec![grey(0.0, 0.1, 0.0), grey(0.55, 0.3, 0.0), grey(0.55, 0.9, 1.0)];
    [
        with_transfer("opaque", size, vec![grey(0.0, 0.1, 1.0), grey(1.0, 0.9, 1.0)]),
        with_transfer("clear to opaque", size, vec![grey(0.0, 0.1, 0.0), grey(1.0, 0.9, 1.0)]),
        with_transfer("opaque above a step", size, step),
        with_transfer("one point", size, vec![grey(0.3, 0.6, 0.2)]),
        with_transfer("all but opaque", size, vec![grey(0.0, 0.5, 0.999_999), grey(1.0, 0.5, 0.999_999)]),
        with_transfer("all but clear", size, vec![grey(0.0, 0.5, 1e-6), grey(1.0, 1.0, 1e-6)]),
        with_transfer("black", size, vec![grey(0.0, 0.0, 0.4)]),
    ]
}

fn with_transfer(name: &str, size: Size, points: Vec<ControlPoint>) -> Scene {
    let mut scene = plain(name, 37, size);
    scene.view.transfer.points = points;
    scene
}

pub fn sizes_of_the_image() -> [Scene; 6] {
    [[1, 1], [7, 5], [1, 40], [40, 1], [8, 8], [9, 17]].map(|[w, h]| scenes::plain(39, w, h))
}
