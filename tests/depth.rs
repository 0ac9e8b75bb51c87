//! The depth of what is seen in each pixel is that of the f64 twin, however the picture is cut, and whatever
//! the colours are sampled like.

#[path = "depth/in_parts.rs"]
mod in_parts;
#[path = "depth/scales.rs"]
mod scales;

use std::ops::ControlFlow;

use glam::DVec3;
use reference::Particle;
use reference::depth::{Sample, mean, of_pixels, opacity};
use reference::device::{prepare, render, shared};
use reference::guarantee::{calm, with_opacity};
use reference::picture::raised;
use reference::random::Random;
use reference::scenes::{self, Scene, Shape, grey, plain_view};
use reference::setup::Setup;
use renderer::{Kernel, Renderer};

/// Opacity from which on the depth of a pixel is told to be right.
const SEEN: f64 = 1e-3;

fn go_on(_: f32) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn depths_by(renderer: &mut Renderer, scene: &Scene) -> Vec<f32> {
    renderer
        .render_depths(&prepare(scene), &mut go_on)
        .unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

fn depths(scene: &Scene) -> Vec<f32> {
    depths_by(&mut shared(), scene)
}

/// How far `found` is from the depths that `definition` gives, as a share of these, in the pixels of the twin
/// where anything is seen; infinitely where only one of the two sees something.
fn errors_by(scene: &Scene, found: &[f32], definition: impl Fn(&Setup, &[Sample]) -> f64 + Sync) -> Vec<f64> {
    let setup = Setup::new(&scene.view);
    let twin = of_pixels(&setup, &raised(&setup, &scene.particles), |samples| {
        (definition(&setup, samples), opacity(samples))
    });
    assert_eq!(found.len(), twin.len(), "{}", scene.name);
    let pairs = twin.into_iter().zip(found).filter(|((_, opacity), depth)| {
        let apart = (*opacity > 0.0) != depth.is_finite();
        *opacity > SEEN || apart
    });
    pairs
        .map(|((expected, _), &depth)| {
            let error = (f64::from(depth) / expected - 1.0).abs();
            if error.is_nan() { f64::INFINITY } else { error }
        })
        .collect()
}

fn errors(scene: &Scene, found: &[f32]) -> Vec<f64> {
    errors_by(scene, found, |_, samples| mean(samples))
}

fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

/// As with colours, a rare sample on the edge of a support or at a step of the transfer function may fall on
/// either side of it.
fn is_alike(errors: &[f64]) -> bool {
    let far = errors.iter().filter(|error| **error > 1e-5).count();
    !errors.is_empty() && far as f64 <= 1e-3 * errors.len() as f64
}

fn random_scenes(first_seed: u64) -> impl Iterator<Item = Scene> {
    let kernels = Shape::ALL.into_iter().flat_map(|shape| Kernel::ALL.map(|kernel| (shape, kernel)));
    kernels.zip(first_seed..).map(|((shape, kernel), seed)| scenes::random(seed, shape, [33, 21], kernel))
}

/// Looks from the middle of the run.
fn inside(seed: u64) -> Scene {
    let mut scene = scenes::plain(seed, 33, 21);
    let camera = scene.view.camera.as_mut().expect("plain scenes have a camera");
    (camera.eye, camera.target) = (DVec3::new(0.1, 0.0, 0.2), DVec3::new(0.3, 0.2, -1.0));
    (camera.near, camera.far, camera.fov_y_degrees) = (Some(0.01), Some(3.0), 90.0);
    scene.name += ", from inside";
    scene
}

#[test]
fn depths_are_those_of_the_twin() {
    let all: Vec<f64> = random_scenes(5_000).flat_map(|scene| errors(&scene, &depths(&scene))).collect();
    let far = all.iter().filter(|error| **error > 1e-5).count();
    println!("{far} of {} pixels farther than 1e-5, {:.1e} at most", all.len(), largest(&all));
    assert!(all.len() > 5_000 && is_alike(&all), "{far} of {} pixels", all.len());
}

#[test]
fn smooth_scenes_lose_nothing_but_rounding() {
    for scene in [scenes::plain(1, 33, 21), scenes::plain(2, 64, 48), inside(3)] {
        let far = largest(&errors(&scene, &depths(&scene)));
        println!("{}: {far:.1e}", scene.name);
        assert!(far <= 1e-6, "{}: {far:.1e}", scene.name);
    }
}

#[test]
fn other_meanings_of_depth_are_noticed() {
    let scene = scenes::plain(7, 33, 21);
    let found = depths(&scene);
    assert!(is_alike(&errors(&scene, &found)));
    type Definition = fn(&Setup, &[Sample]) -> f64;
    let wrong: [(&str, Definition); 5] = [
        ("of the fronts of slabs", |setup, samples| {
            let front = |s: &Sample| Sample { depth: setup.slices.depth(f64::from(s.slab)), ..*s };
            mean(&samples.iter().map(front).collect::<Vec<_>>())
        }),
        ("of samples alike", |_, samples| {
            samples.iter().map(|s| s.depth).sum::<f64>() / samples.len().max(1) as f64
        }),
        ("of the first sample", |_, samples| samples.first().map_or(f64::INFINITY, |s| s.depth)),
        ("where half of the light is gone", |_, samples| {
            let mut opacity = 0.0;
            let half = samples.iter().find(|s| {
                opacity += s.weight;
                opacity >= 0.5
            });
            half.map_or(f64::INFINITY, |s| s.depth)
        }),
        ("not divided by the opacity", |_, samples| samples.iter().map(|s| s.weight * s.depth).sum()),
    ];
    for (what, definition) in wrong {
        let errors = errors_by(&scene, &found, definition);
        let noticed = errors.iter().filter(|error| **error > 1e-5).count();
        assert!(2 * noticed > errors.len(), "{what}: noticed in {noticed} of {} pixels", errors.len());
    }
}

#[test]
fn depth_is_measured_along_the_axis_of_the_camera() {
    // An opaque wall across the view: as deep at the corners as in the middle.
    let mut view = plain_view(24, 16);
    view.camera.as_mut().expect("a plain view has a camera").fov_y_degrees = 90.0;
    view.transfer.points = vec![grey(0.0, 1.0, 1.0)];
    let wall = |x: i32, y: i32| Particle {
        position: DVec3::new(0.2 * f64::from(x), 0.2 * f64::from(y), 0.0),
        support_radius: 0.5,
        volume: 1.0,
        quantity: 0.5,
        opacity: 0.0,
    };
    let particles = (-50..50).flat_map(|x| (-50..50).map(move |y| wall(x, y))).collect();
    let scene = Scene { name: "wall".to_owned(), particles, view };
    let found = depths(&scene);
    let slab = Setup::new(&scene.view).slices.relative_step() * 4.0;
    for depth in found {
        assert!((f64::from(depth) - 3.5).abs() < 0.1 + slab, "{depth}");
    }
}

#[test]
fn where_nothing_is_seen_it_is_infinite() {
    let mut scene = scenes::plain(8, 33, 21);
    scene.particles.truncate(40);
    let picture = render(&mut shared(), &prepare(&scene));
    let found = depths(&scene);
    let clear = picture.pixels.iter().filter(|pixel| pixel[3] == 0.0).count();
    assert!((50..600).contains(&clear), "{clear} pixels are clear");
    let [near, far] = [1.0, 7.0];
    for (pixel, depth) in picture.pixels.iter().zip(&found) {
        assert!(if pixel[3] == 0.0 { *depth == f32::INFINITY } else { (near..=far).contains(depth) });
    }
    scene.particles.clear();
    assert!(depths(&scene).iter().all(|depth| *depth == f32::INFINITY));
}

#[test]
fn the_opacity_of_another_field_decides() {
    let two =
        |seed: u64| with_opacity(seed, scenes::random(seed, Shape::JitteredLattice, [33, 21], Kernel::Cubic));
    let all: Vec<f64> = (20..26).map(two).flat_map(|scene| errors(&scene, &depths(&scene))).collect();
    assert!(is_alike(&all), "{} of {} far", all.iter().filter(|e| **e > 1e-5).count(), all.len());
    let scene = with_opacity(9, scenes::plain(9, 33, 21));
    let mut one = scene.clone();
    one.view.quantity.opacity = None;
    assert!(is_alike(&errors(&scene, &depths(&scene))) && !is_alike(&errors(&one, &depths(&scene))));
}

/// More particles in one place than one workgroup walks over.
fn crowded() -> Scene {
    let mut scene = scenes::plain(14, 33, 21);
    let mut random = Random::new(14);
    let heap = Particle { position: DVec3::new(0.1, 0.2, 0.3), ..scene.particles[0] };
    scene.particles.extend((0..5000).map(|_| Particle { quantity: random.unit(), ..heap }));
    scene.name += ", a crowd";
    scene
}

#[test]
fn crowds_have_depths() {
    let scene = crowded();
    let far = largest(&errors(&scene, &depths(&scene)));
    assert!(far <= 1e-5, "{far:.1e}");
}

#[test]
fn the_tolerance_of_the_colours_is_none_of_depth() {
    let mut scene = calm(63, 48, 40);
    let mut found = [None, Some(0.001), Some(0.1)].map(|tolerance| {
        scene.view.sampling.tolerance = tolerance;
        scene.view.sampling.always_adaptive = true;
        depths(&scene)
    });
    assert!(found[0] == found[1] && found[0] == found[2]);
    // Nor is it in the way of the next picture.
    let mut renderer = shared();
    let prepared = prepare(&scene);
    let before = render(&mut renderer, &prepared).pixels;
    found[1] = renderer.render_depths(&prepared, &mut go_on).expect("it is rendered");
    let (picture, map) = renderer.render_with_cells(&prepared, &mut go_on).expect("it is rendered");
    assert!(
        found[0] == found[1] && picture.pixels == before && map.bundles.iter().any(|b| !b.cells.is_empty())
    );
}
