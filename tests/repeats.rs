//! A picture is the same to the last bit whenever it is rendered, and in whatever order its particles
//! come: sums over the particles of a cell have an order of their own. An adaptive picture depends on
//! it most, since the last bit of a bound may decide whether a brick is sampled.

use glam::DVec3;
use reference::Particle;
use reference::device::{open, prepare, render};
use reference::random::Random;
use reference::scenes::{Scene, plain_view};
use renderer::{GpuOptions, GridCell};

/// A jittered lattice of `side`³ particles with a field that is smooth but for some noise.
fn dense(side: usize, width: u32, height: u32) -> Scene {
    let mut random = Random::new(side as u64);
    let spacing = 2.0 / side as f64;
    let places = (0..side.pow(3)).map(|i| [i / side / side, i / side % side, i % side]);
    let particles = places
        .map(|index| {
            let corner = DVec3::from_array(index.map(|i| i as f64));
            let position = spacing * (corner + 0.3 * random.in_cube() + 0.5) - 1.0;
            let quantity = 0.5 + 0.3 * (2.0 * position.x + position.y).sin() + 0.1 * random.unit();
            Particle { position, support_radius: 0.4, volume: 1.0, quantity, opacity: 0.0 }
        })
        .collect();
    let mut scene = Scene { name: format!("dense {side}"), particles, view: plain_view(width, height) };
    scene.view.sampling.tolerance = Some(0.01);
    scene
}

fn grid(scene: &Scene) -> Vec<GridCell> {
    open(&GpuOptions::default()).inspect_grid(&prepare(scene)).expect("a grid")
}

/// Numbers of particles of the cells of `scene`, in ascending order.
fn crowds(scene: &Scene) -> Vec<usize> {
    let mut crowds: Vec<usize> = grid(scene).iter().map(|cell| cell.particles.len()).collect();
    crowds.sort_unstable();
    crowds
}

/// Fails unless pictures of `scene` by several renderers, of which each knows nothing from before, are
/// the same, and those of its particles in another order.
fn assert_repeats(mut scene: Scene) {
    let first = render(&mut open(&GpuOptions::default()), &prepare(&scene));
    assert!(first.pixels.iter().filter(|pixel| pixel[3] > 0.1).count() > 100, "it shows something");
    let mut random = Random::new(3);
    for turn in 0..4 {
        if turn >= 2 {
            random.shuffle(&mut scene.particles);
        }
        let again = render(&mut open(&GpuOptions::default()), &prepare(&scene));
        let changed = first.pixels.iter().zip(&again.pixels).filter(|(a, b)| a != b).count();
        assert_eq!(changed, 0, "{}, turn {turn}: {changed} pixels have changed", scene.name);
    }
}

#[test]
fn cells_of_usual_numbers() {
    let scene = dense(9, 64, 48);
    let crowds = crowds(&scene);
    assert!(crowds[crowds.len() / 2] > 16 && crowds[crowds.len() - 1] <= 512, "{crowds:?}");
    assert_repeats(scene);
}

#[test]
fn cells_of_many_particles() {
    let scene = dense(22, 48, 36);
    let crowds = crowds(&scene);
    assert!(crowds[2 * crowds.len() / 3] > 512, "{crowds:?}");
    assert_repeats(scene);
}

#[test]
fn cells_of_thousands_of_particles() {
    let scene = dense(30, 24, 17);
    let crowds = crowds(&scene);
    assert!(crowds[crowds.len() / 2] > 2048 && crowds[crowds.len() - 1] > 5000, "{crowds:?}");
    assert_repeats(scene);
}

/// Many particles at one place have one key all together.
#[test]
fn cells_of_coincident_particles() {
    let mut scene = dense(9, 64, 48);
    let heap = Particle { position: DVec3::new(0.1, 0.2, 0.3), ..scene.particles[0] };
    scene.particles.extend([heap; 400]);
    assert_repeats(scene);
}

#[test]
fn a_cell_holds_each_particle_once_and_in_its_place() {
    let mut heap = dense(9, 64, 48);
    heap.particles.extend([heap.particles[300]; 100]);
    for scene in [heap, dense(22, 48, 36)] {
        let [first, second] = [grid(&scene), grid(&scene)];
        assert!(first == second, "{}: cells are in another order", scene.name);
        for GridCell { mut particles, .. } in first {
            let count = particles.len();
            particles.sort_unstable();
            particles.dedup();
            assert_eq!(particles.len(), count, "{}", scene.name);
        }
    }
}
