//! Numbers at their ends, with adaptive sampling on: the tolerance is kept, and the pictures are
//! pictures. Each is compared with full sampling of the same view.

use glam::DVec3;
use reference::Particle;
use reference::compare::compare;
use reference::device::{open, shared};
use reference::extremes;
use reference::guarantee::{alike_but_for_decisions, calm, try_out};
use reference::picture::Image;
use reference::random::Random;
use reference::scenes::{self, Scene, Shape, grey, plain_view};
use renderer::{ControlPoint, GpuOptions, Kernel, Renderer};

const SIZE: [u32; 2] = [57, 43];
const TOLERANCES: [f64; 3] = [1e-3, 1e-2, 0.1];

fn with_tolerance(scene: &Scene, tolerance: f64) -> Scene {
    let mut scene = scene.clone();
    scene.view.sampling.tolerance = Some(tolerance);
    scene.name += &format!(", tolerance {tolerance}");
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
    assert_kept(extremes::depths_over_six_decades(SIZE));
}

#[test]
fn fields_of_view_at_their_ends() {
    assert_kept(extremes::fields_of_view(SIZE));
}

#[test]
fn long_lenses() {
    assert_kept([30.0, 400.0, 1e4, 1e5].map(|distance| extremes::through_a_long_lens(distance, SIZE)));
}

#[test]
fn reference_lengths_far_from_the_scene() {
    assert_kept([1e-6, 1e-3, 1e3, 1e6].map(|length| extremes::with_reference_length(length, SIZE)));
}

/// `count` particles at one point amid others, with quantities around the middle.
fn heap(count: usize, spread: f64, transfer: &[ControlPoint]) -> Scene {
    let mut random = Random::new(31);
    let name = format!("a heap, {spread} apart, {} nodes", transfer.len());
    let mut scene = extremes::plain(name, 31, [24, 17]);
    let position = DVec3::new(0.1, 0.2, 0.3);
    let heap = Particle { position, support_radius: 0.3, volume: 1.0, quantity: 0.5, opacity: 0.0 };
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
    assert_kept(extremes::quantities_at_the_edge_of_their_numbers(SIZE));
    // Far outside their range.
    assert_kept([3e38, 1e30].map(|far| {
        let name = format!("{far:e} with a range of 1");
        extremes::with_quantity(&name, SIZE, [0.0, 1.0], |q| 2.0 * far * (q - 0.5))
    }));
}

#[test]
fn outliers_of_the_quantity() {
    assert_kept([1e3, 1e6, 1e12, 1e30].map(|far| extremes::with_outliers(far, SIZE)));
}

#[test]
fn volumes_over_many_decades() {
    assert_kept([1e6, 1e12].map(|range| {
        let mut random = Random::new(43);
        let mut scene = extremes::plain(format!("volumes over 1:{range}"), 43, SIZE);
        for particle in &mut scene.particles {
            particle.volume = random.log_between(1.0, range);
        }
        scene
    }));
}

#[test]
fn transfer_functions_at_their_ends() {
    assert_kept([extremes::clear(SIZE)]);
    assert_kept(extremes::transfer_functions_at_their_ends(SIZE));
}

#[test]
fn sizes_of_the_image() {
    assert_kept(extremes::sizes_of_the_image());
    let mut large = scenes::plain(40, 333, 217);
    large.view.sampling.rate = 0.5;
    assert_kept([large]);
}

#[test]
fn rates_of_sampling() {
    assert_kept([0.01, 0.3, 2.0, 8.0].map(|rate| extremes::at_rate(rate, [40, 33])));
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
    let mut deep = extremes::plain("many layers", 121, [17, 9]);
    deep.view.camera.as_mut().expect("plain scenes have a camera").near = Some(0.01);
    deep.view.sampling.rate = 8.0;
    let mut dense = extremes::plain("many references", 122, [64, 48]);
    dense.particles.iter_mut().for_each(|particle| particle.support_radius *= 3.0);
    let scenes = [scenes::plain(120, 64, 48), deep, dense];
    for memory in [1 << 20, 256 << 10, 192 << 10] {
        let mut renderer = open(&GpuOptions { memory: Some(memory), ..GpuOptions::default() });
        assert_kept_by(&mut renderer, scenes.clone());
    }
}

/// Scenes that are the same before and after a change of unit, place or order.
fn base_scenes() -> Vec<Scene> {
    let mut cubic = scenes::plain(11, 57, 43);
    cubic.view.particles.kernel = Kernel::Cubic;
    let mut inside = extremes::plain("from inside", 12, SIZE);
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
        let before = Image::from(&try_out(&mut shared(), &scene).adaptive);
        for (what, after) in changed(&scene) {
            let trial = try_out(&mut shared(), &after);
            assert_eq!(trial.violation(), None, "{what}");
            let comparison = compare(&before, &Image::from(&trial.adaptive));
            assert!(alike_but_for_decisions(&comparison, tolerance), "{}, {what}: {comparison}", scene.name);
        }
    }
}
