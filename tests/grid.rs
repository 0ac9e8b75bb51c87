//! The view-aligned grid: what a cell must hold by the twin, what it may, and what it does hold on
//! the device.

use std::collections::BTreeSet;

use glam::DVec3;
use reference::Particle;
use reference::device::{prepare, shared};
use reference::floor;
use reference::grid::{Reference, may, must};
use reference::scenes::{self, Scene, Shape, plain_view};
use reference::setup::Setup;

/// A random scene of at most 400 particles, few enough for the twin.
fn random(seed: u64, shape: Shape, size: [u32; 2]) -> Scene {
    let mut scene = scenes::random(seed, shape, size, renderer::Kernel::Poly6);
    scene.view.sampling.rate = 0.5;
    scene.particles.truncate(400);
    scene
}

/// Setup and particles with their sub-pixel floor in place, as the device grid has them.
fn twin(scene: &Scene) -> (Setup, Vec<Particle>) {
    let setup = Setup::new(&scene.view);
    let raised = scene.particles.iter().map(|particle| floor::raise(particle, &setup)).collect();
    (setup, raised)
}

/// The references of the grid on the device, which must not hold one twice.
fn on_device(scene: &Scene) -> BTreeSet<Reference> {
    let grid = shared().inspect_grid(&prepare(scene)).unwrap_or_else(|error| panic!("{error}"));
    let references: Vec<Reference> = grid
        .iter()
        .flat_map(|cell| {
            let ([x, y], layer) = (cell.bundle, cell.layer);
            cell.particles.iter().map(move |&particle| (x, y, layer, particle))
        })
        .collect();
    let set: BTreeSet<Reference> = references.iter().copied().collect();
    assert_eq!(set.len(), references.len(), "{}: references twice", scene.name);
    set
}

/// Room for rounding and for the device's slack of a fiftieth of a pixel and slice, in support
/// radii, none of which is below 0.9 pixels.
const SLACK: f64 = 0.03;

fn assert_between(
    name: &str,
    must: &BTreeSet<Reference>,
    grid: &BTreeSet<Reference>,
    may: &BTreeSet<Reference>,
) {
    let missing: Vec<&Reference> = must.difference(grid).take(5).collect();
    let needless: Vec<&Reference> = grid.difference(may).take(5).collect();
    assert!(missing.is_empty() && needless.is_empty(), "{name}: missing {missing:?}, needless {needless:?}");
}

#[test]
fn the_device_holds_what_it_must_and_nothing_that_it_may_not() {
    for (round, shape) in (0..3).flat_map(|round| Shape::ALL.map(|shape| (round, shape))) {
        for size in [[1, 1], [7, 5], [33, 21]] {
            let scene = random(500 + round, shape, size);
            let (setup, particles) = twin(&scene);
            let (must, may) = (must(&setup, &particles), may(&setup, &particles, SLACK));
            assert_between(&scene.name, &must, &on_device(&scene), &may);
        }
    }
}

#[test]
fn the_device_grid_of_wide_and_narrow_views() {
    for (fov_y_degrees, distance) in [(1.0, 110.0), (170.0, 1.3), (120.0, 0.5)] {
        let mut scene = scenes::plain(92, 33, 21);
        scene.name = format!("{fov_y_degrees} degrees");
        let camera = scene.view.camera.as_mut().expect("plain scenes have a camera");
        (camera.eye, camera.fov_y_degrees) = (DVec3::new(0.1, 0.2, distance), fov_y_degrees);
        (camera.near, camera.far) = (Some((distance - 2.0_f64).max(0.02)), Some(distance + 2.0));
        let (setup, particles) = twin(&scene);
        let (must, may) = (must(&setup, &particles), may(&setup, &particles, SLACK));
        let grid = on_device(&scene);
        assert!(must.is_subset(&grid), "{}: {:?} is missing", scene.name, must.difference(&grid).next());
        // Where a slab is deep beside its width the device's bound of a support is a little wide.
        let needless = grid.difference(&may).count();
        assert!(100 * needless <= must.len(), "{}: {needless} needless of {}", scene.name, must.len());
    }
}

#[test]
fn what_a_grid_must_hold_it_may_hold() {
    for (seed, shape) in (70..).zip(Shape::ALL) {
        for size in [[1, 1], [7, 5], [33, 21]] {
            let scene = random(seed, shape, size);
            let (setup, particles) = twin(&scene);
            let (must, may) = (must(&setup, &particles), may(&setup, &particles, 1e-9));
            let forbidden: Vec<&Reference> = must.difference(&may).take(5).collect();
            assert!(forbidden.is_empty(), "{}: {forbidden:?}", scene.name);
        }
    }
}

#[test]
fn a_hull_is_tight_where_particles_are_larger_than_pixels() {
    let Scene { particles, view, .. } = scenes::plain(80, 32, 24);
    let setup = Setup::new(&view);
    let (must, may) = (must(&setup, &particles).len(), may(&setup, &particles, 0.0).len());
    assert!(must > 1000 && may < must + must / 20, "{must} must, {may} may");
}

/// 16 × 16 pixels at 90°, two bundles each way; ln(7)·16/2 = 15.6 slabs make one layer.
fn four_cells(far: f64) -> Setup {
    let mut view = plain_view(16, 16);
    let camera = view.camera.as_mut().expect("plain views have a camera");
    (camera.eye, camera.target, camera.fov_y_degrees) = (DVec3::ZERO, DVec3::NEG_Z, 90.0);
    camera.far = Some(far);
    Setup::new(&view)
}

fn at(x: f64, y: f64, depth: f64, support_radius: f64) -> Particle {
    Particle { position: DVec3::new(x, y, -depth), support_radius, volume: 1.0, quantity: 0.0, opacity: 0.0 }
}

#[test]
fn cells_by_hand() {
    let setup = four_cells(7.0);
    assert_eq!(setup.slices.layers(), 1);
    // One in each corner and one in the middle: y points up, bundles count downwards.
    let particles = [
        at(-1.0, 1.0, 2.0, 0.5),
        at(1.0, 1.0, 2.0, 0.5),
        at(-1.0, -1.0, 2.0, 0.5),
        at(1.0, -1.0, 2.0, 0.5),
        at(0.0, 0.0, 2.0, 0.5),
        at(1.0, 0.0, 0.2, 0.5),
        at(0.0, 0.0, 9.0, 0.5),
    ];
    let corners = [(0, 0, 0, 0), (1, 0, 0, 1), (0, 1, 0, 2), (1, 1, 0, 3)];
    let middle = [(0, 0, 0, 4), (1, 0, 0, 4), (0, 1, 0, 4), (1, 1, 0, 4)];
    let expected: BTreeSet<Reference> = corners.into_iter().chain(middle).collect();
    assert_eq!(must(&setup, &particles), expected);
    assert_eq!(may(&setup, &particles, 0.0), expected);
}

#[test]
fn layers_by_hand() {
    // ln(49)·16/2 = 31.1 slabs: two layers, which meet at depth 7.
    let setup = four_cells(49.0);
    assert_eq!(setup.slices.layers(), 2);
    let upper_left = |depth: f64, h: f64| at(-0.5 * depth, 0.5 * depth, depth, h);
    let particles = [upper_left(5.0, 1.0), upper_left(7.0, 1.0), upper_left(9.0, 1.0)];
    let expected: BTreeSet<Reference> =
        [(0, 0, 0, 0), (0, 0, 0, 1), (0, 0, 1, 1), (0, 0, 1, 2)].into_iter().collect();
    assert_eq!(must(&setup, &particles), expected);
    assert_eq!(may(&setup, &particles, 0.0), expected);
}

#[test]
fn a_grid_that_is_too_small_is_noticed() {
    let (setup, particles) = twin(&random(90, Shape::JitteredLattice, [33, 21]));
    let needed = must(&setup, &particles);
    let shrunk: Vec<Particle> = particles
        .iter()
        .map(|particle| Particle { support_radius: 0.9 * particle.support_radius, ..*particle })
        .collect();
    assert!(!needed.is_subset(&may(&setup, &shrunk, 0.0)), "radii a tenth too small");
    let shifted = needed.iter().map(|&(x, y, layer, particle)| (x, y, layer + 1, particle)).collect();
    assert!(!needed.is_subset(&shifted), "layers that count from one");
    let mut upside_down = setup.clone();
    upside_down.camera.up = -setup.camera.up;
    assert!(!needed.is_subset(&may(&upside_down, &particles, 0.0)), "bundles that count upwards");
}

#[test]
fn a_grid_that_is_too_large_is_noticed() {
    let (setup, particles) = twin(&random(91, Shape::Clusters, [33, 21]));
    let allowed = may(&setup, &particles, 1e-6);
    let grown: Vec<Particle> = particles
        .iter()
        .map(|particle| Particle { support_radius: 1.2 * particle.support_radius, ..*particle })
        .collect();
    assert!(!must(&setup, &grown).is_subset(&allowed), "radii a fifth too large");
}
