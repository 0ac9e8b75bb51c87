//! Numbers at their ends, with adaptive sampling on: the tolerance is kept, and the pictures are
//! pictures. Each is compared with full sampling of the same view.

use glam::DVec3;
use reference::Particle;
use reference::compare::compare;
use reference::device::{open, picture, shared};
use reference::guarantee::{alike_but_for_decisions, calm, try_out};
use reference::picture::Image;
use reference::random::Random;
use reference::scenes::{self, Scene, Shape, grey, plain_view};
use renderer::{CameraView, ControlPoint, GpuOptions, Kernel, Renderer};

const TOLERANCES: [f64; 3] = [1e-3, 1e-2, 0.1];

fn with_tolerance(scene: &Scene, tolerance: f64) -> Scene {
    let mut scene = scene.clone();
    scene.view.sampling.tolerance = Some(tolerance);
    scene.name += &format!(", tolerance {tolerance}");
    scene
}

fn named(name: impl Into<String>, mut scene: Scene) -> Scene {
    scene.name = name.into();
    scene
}

fn with_camera(name: &str, change: impl Fn(&mut CameraView)) -> Scene {
    let mut scene = named(name, scenes::plain(30, 57, 43));
    change(scene.view.camera.as_mut().expect("plain scenes have a camera"));
    scene
}

/// Fails with a line for each tolerance that was not kept.
fn assert_kept_by(renderer: &mut Renderer, scenes: impl IntoIterator<Item = Scene>) {
    let trials = scenes.into_iter().flat_map(|scene| TOLERANCES.map(|e| with_tolerance(&scene, e)));
    let violations: Vec<String> = trials.filter_map(|scene| try_out(renderer, &scene).violation()).collect();
    assert!(violations.is_empty(), "{} pictures:\n{}", violations.len(), violations.join("\n"));
}

fn assert_kept(scenes: impl IntoIterator<Item = Scene>) {
    assert_kept_by(&mut shared(), scenes);
}

#[test]
fn depths_over_six_decades() {
    assert_kept([
        with_camera("from inside, 1e-3 to 1e3", |camera| {
            (camera.eye, camera.near, camera.far) = (DVec3::new(0.1, 0.2, 0.3), Some(1e-3), Some(1e3));
        }),
        with_camera("from outside, 1e-3 to 1e3", |camera| {
            (camera.near, camera.far) = (Some(1e-3), Some(1e3));
        }),
        with_camera("a thousandth of a radius deep", |camera| {
            (camera.near, camera.far) = (Some(4.0), Some(4.0005));
        }),
    ]);
}

#[test]
fn fields_of_view_at_their_ends() {
    assert_kept([
        with_camera("1 degree", |camera| {
            camera.eye = DVec3::new(0.0, 30.0, 110.0);
            camera.fov_y_degrees = 1.0;
            (camera.near, camera.far) = (Some(112.0), Some(116.0));
        }),
        with_camera("170 degrees", |camera| {
            camera.eye = DVec3::new(0.2, 0.1, 1.3);
            camera.fov_y_degrees = 170.0;
            (camera.near, camera.far) = (Some(0.05), Some(3.0));
        }),
        with_camera("170 degrees, from inside", |camera| {
            camera.eye = DVec3::new(0.2, 0.1, 0.3);
            camera.fov_y_degrees = 170.0;
            (camera.near, camera.far) = (Some(0.01), Some(3.0));
        }),
    ]);
}

/// The plain scene from `distance` radii away, with a field of view that it fills.
fn through_a_long_lens(distance: f64) -> Scene {
    let mut scene = named(format!("{distance} radii away"), scenes::plain(42, 57, 43));
    let depth = distance * scene.particles[0].support_radius;
    let camera = scene.view.camera.as_mut().expect("plain scenes have a camera");
    camera.eye = DVec3::new(0.0, 0.0, depth);
    camera.fov_y_degrees = 2.0 * (1.3 / depth).atan().to_degrees();
    (camera.near, camera.far) = (Some(depth - 1.6), Some(depth + 1.6));
    scene
}

#[test]
fn long_lenses() {
    assert_kept([30.0, 400.0, 1e4, 1e5].map(through_a_long_lens));
}

#[test]
fn reference_lengths_far_from_the_scene() {
    assert_kept([1e-6, 1e-3, 1e3, 1e6].map(|length| {
        let mut scene = named(format!("reference length {length:e}"), scenes::plain(38, 57, 43));
        scene.view.transfer.reference_length = Some(length);
        scene
    }));
}

/// `count` particles at one point amid others, with quantities around the middle.
fn heap(count: usize, spread: f64, transfer: &[ControlPoint]) -> Scene {
    let mut random = Random::new(31);
    let name = format!("a heap, {spread} apart, {} nodes", transfer.len());
    let mut scene = named(name, scenes::plain(31, 24, 17));
    let position = DVec3::new(0.1, 0.2, 0.3);
    let heap = Particle { position, support_radius: 0.3, volume: 1.0, quantity: 0.5 };
    let some = |_| Particle { quantity: 0.5 + spread * (random.unit() - 0.5), ..heap };
    scene.particles.extend((0..count).map(some));
    scene.view.transfer.points = transfer.to_vec();
    scene
}

#[test]
fn very_many_particles_at_one_point() {
    let smooth = plain_view(1, 1).transfer.points;
    let spike = [0.49, 0.4999, 0.5, 0.5001].map(|u| grey(u, 0.9, if u == 0.5 { 0.9 } else { 0.0 }));
    let step = [grey(0.0, 0.1, 0.0), grey(0.5, 0.1, 0.0), grey(0.5, 0.9, 0.3)];
    let spreads = [0.0, 1e-3, 1.0];
    let heaps = spreads
        .into_iter()
        .flat_map(|spread| [&smooth[..], &spike, &step].map(|transfer| heap(100_000, spread, transfer)));
    assert_kept(heaps);
}

#[test]
fn quantities_at_the_edge_of_their_numbers() {
    let with = |name: &str, range: [f64; 2], quantity: &dyn Fn(f64) -> f64| {
        let mut scene = named(name, scenes::plain(36, 57, 43));
        scene.view.quantity.range = Some(range);
        scene.particles.iter_mut().for_each(|particle| particle.quantity = quantity(particle.quantity));
        scene
    };
    assert_kept([
        with("constant, range of no width", [0.7, 0.7], &|_| 0.7),
        with("constant 1e38", [0.0, 2e38], &|_| 1e38),
        with("up to 3e38", [0.0, 3e38], &|q| 3e38 * q),
        with("either sign of 3e38", [-3e38, 3e38], &|q| 6e38 * (q - 0.5)),
        with("3e38 with a range of 1", [0.0, 1.0], &|q| 6e38 * (q - 0.5)),
        with("1e30 with a range of 1", [0.0, 1.0], &|q| 1e30 * (q - 0.5)),
        with("denormal in f32", [0.0, 1e-40], &|q| 1e-40 * q),
        with("constant and denormal", [0.0, 1e-310], &|_| 5e-311),
        with("a small difference of large values", [1e6, 1e6 + 0.01], &|q| 1e6 + 0.01 * q),
        with("all below the range", [5.0, 6.0], &|q| q),
        with("all above the range", [-6.0, -5.0], &|q| q),
    ]);
}

#[test]
fn outliers_of_the_quantity() {
    assert_kept([1e3, 1e6, 1e12, 1e30].map(|far| {
        let mut scene = named(format!("outliers of {far}"), scenes::plain(41, 57, 43));
        for (index, particle) in scene.particles.iter_mut().enumerate().filter(|(index, _)| index % 7 == 0) {
            particle.quantity = if index % 2 == 0 { far } else { -far };
        }
        scene
    }));
}

#[test]
fn volumes_over_many_decades() {
    assert_kept([1e6, 1e12].map(|range| {
        let mut random = Random::new(43);
        let mut scene = named(format!("volumes over 1:{range}"), scenes::plain(43, 57, 43));
        for particle in &mut scene.particles {
            particle.volume = random.log_between(1.0, range);
        }
        scene
    }));
}

#[test]
fn transfer_functions_at_their_ends() {
    let with = |name: &str, points: Vec<ControlPoint>| {
        let mut scene = named(name, scenes::plain(37, 57, 43));
        scene.view.transfer.points = points;
        scene
    };
    assert_kept([
        with("clear", vec![grey(0.0, 1.0, 0.0), grey(1.0, 0.5, 0.0)]),
        with("opaque", vec![grey(0.0, 0.1, 1.0), grey(1.0, 0.9, 1.0)]),
        with("clear to opaque", vec![grey(0.0, 0.1, 0.0), grey(1.0, 0.9, 1.0)]),
        with("opaque above a step", vec![grey(0.0, 0.1, 0.0), grey(0.55, 0.3, 0.0), grey(0.55, 0.9, 1.0)]),
        with("one point", vec![grey(0.3, 0.6, 0.2)]),
        with("all but opaque", vec![grey(0.0, 0.5, 0.999_999), grey(1.0, 0.5, 0.999_999)]),
        with("all but clear", vec![grey(0.0, 0.5, 1e-6), grey(1.0, 1.0, 1e-6)]),
        with("black", vec![grey(0.0, 0.0, 0.4)]),
    ]);
}

#[test]
fn sizes_of_the_image() {
    assert_kept([[1, 1], [7, 5], [1, 40], [40, 1], [8, 8], [9, 17]].map(|[w, h]| scenes::plain(39, w, h)));
    let mut large = scenes::plain(40, 333, 217);
    large.view.sampling.rate = 0.5;
    assert_kept([large]);
}

#[test]
fn rates_of_sampling() {
    assert_kept([0.01, 0.3, 2.0, 8.0].map(|rate| {
        let mut scene = named(format!("rate {rate}"), scenes::plain(41, 40, 33));
        scene.view.sampling.rate = rate;
        scene
    }));
}

#[test]
fn tolerances_at_their_ends() {
    let scenes = || {
        let random = Shape::ALL.into_iter().zip(50..);
        random
            .map(|(shape, seed)| scenes::random(seed, shape, [33, 21], Kernel::Cubic))
            .chain([scenes::plain(44, 57, 43)])
    };
    for scene in scenes() {
        let nothing = try_out(&mut shared(), &with_tolerance(&scene, 0.0));
        assert_eq!(nothing.full.pixels, nothing.adaptive.pixels, "{}", scene.name);
        let everything = try_out(&mut shared(), &with_tolerance(&scene, 1.0));
        assert_eq!(everything.violation(), None);
    }
}

#[test]
fn little_memory() {
    let mut deep = scenes::plain(121, 17, 9);
    deep.view.camera.as_mut().expect("plain scenes have a camera").near = Some(0.01);
    deep.view.sampling.rate = 8.0;
    let mut dense = scenes::plain(122, 64, 48);
    dense.particles.iter_mut().for_each(|particle| particle.support_radius *= 3.0);
    let scenes = [scenes::plain(120, 64, 48), named("many layers", deep), named("many references", dense)];
    for memory in [1 << 20, 256 << 10, 192 << 10] {
        let mut renderer = open(&GpuOptions { memory: Some(memory), ..GpuOptions::default() });
        assert_kept_by(&mut renderer, scenes.clone());
    }
}

/// Scenes that are the same before and after a change of unit, place or order.
fn base_scenes() -> Vec<Scene> {
    let mut cubic = scenes::plain(11, 57, 43);
    cubic.view.particles.kernel = Kernel::Cubic;
    let mut inside = named("from inside", scenes::plain(12, 57, 43));
    let camera = inside.view.camera.as_mut().expect("plain scenes have a camera");
    (camera.eye, camera.target) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(-1.0, 0.5, -0.2));
    (camera.near, camera.far, camera.fov_y_degrees) = (Some(0.05), Some(2.5), 75.0);
    let mut mixed = scenes::random(13, Shape::MixedRadii, [47, 38], Kernel::WendlandC2);
    mixed.view.transfer.points = plain_view(1, 1).transfer.points;
    vec![scenes::plain(10, 57, 43), cubic, inside, mixed, calm(15, 57, 43)]
}

fn transformed(scene: &Scene, unit: f64, origin: DVec3) -> Scene {
    let mut moved = scene.clone();
    scenes::transform(&mut moved.particles, &mut moved.view, unit, origin);
    moved
}

fn changed(scene: &Scene) -> Vec<(String, Scene)> {
    let h = scene.particles[0].support_radius;
    let mut changed = vec![("again".to_owned(), scene.clone())];
    for direction in [DVec3::X, DVec3::new(-0.6, 0.0, 0.8), DVec3::new(1.0, 1.0, -1.0)] {
        changed.push((format!("along {direction}"), transformed(scene, 1.0, 1e7 * h * direction)));
    }
    for unit in [1e-12, 1e-3, 1e12] {
        changed.push((format!("in units of {unit:e}"), transformed(scene, unit, DVec3::ZERO)));
    }
    let mut shuffled = scene.clone();
    Random::new(17).shuffle(&mut shuffled.particles);
    changed.push(("shuffled".to_owned(), shuffled));
    changed
}

#[test]
fn unit_place_and_order_change_little() {
    for (scene, tolerance) in base_scenes().iter().flat_map(|scene| TOLERANCES.map(|e| (scene, e))) {
        let scene = with_tolerance(scene, tolerance);
        let before = picture(&scene);
        for (what, after) in changed(&scene) {
            let trial = try_out(&mut shared(), &after);
            assert_eq!(trial.violation(), None, "{what}");
            let comparison = compare(&before, &Image::from(&trial.adaptive));
            assert!(alike_but_for_decisions(&comparison, tolerance), "{}, {what}: {comparison}", scene.name);
        }
    }
}
