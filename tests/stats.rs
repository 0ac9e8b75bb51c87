//! What the renderer says a picture cost (contract, section 4), as far as the twin can count it too.

use std::collections::BTreeSet;

use reference::Particle;
use reference::device::{prepare, render, shared};
use reference::floor;
use reference::grid::{may, must};
use reference::guarantee::prepare_anyway;
use reference::neighbours::Neighbours;
use reference::scenes::{self, Scene, Shape, grey};
use reference::setup::Setup;
use renderer::{BrickWidth, Gpu, GpuOptions, Kernel, Renderer, Stats};

/// Scenes in which every ray goes all the way through.
fn clear_scenes() -> Vec<Scene> {
    let mut scenes = vec![scenes::plain(130, 33, 21), scenes::plain(131, 7, 5)];
    let shapes = [Shape::JitteredLattice, Shape::Clusters, Shape::Sheet, Shape::MixedRadii, Shape::Giants];
    scenes.extend(shapes.into_iter().zip(132..).map(|(shape, seed)| {
        let mut scene = scenes::random(seed, shape, [33, 21], Kernel::Poly6);
        scene.view.sampling.rate = 0.5;
        scene
    }));
    scenes.iter_mut().for_each(|scene| scene.view.transfer.points = vec![grey(0.0, 0.5, 1e-4)]);
    scenes
}

fn stats(scene: &Scene) -> (Stats, Setup, Vec<Particle>) {
    let stats = render(&mut shared(), &prepare(scene)).stats;
    let setup = Setup::new(&scene.view);
    let raised = scene.particles.iter().map(|particle| floor::raise(particle, &setup)).collect();
    (stats, setup, raised)
}

/// Samples inside supports, counted once for each particle.
fn samples_inside(setup: &Setup, particles: &[Particle]) -> u64 {
    let neighbours = Neighbours::new(particles);
    let camera = &setup.camera;
    let pixels = (0..camera.height).flat_map(|y| (0..camera.width).map(move |x| (x, y)));
    let inside = pixels.flat_map(|(x, y)| {
        let (neighbours, d) = (&neighbours, camera.ray(x, y));
        (0..setup.slices.count).map(move |i| {
            let point = camera.eye + setup.slices.depth(f64::from(i) + 0.5) * d;
            let reached = |&index: &usize| {
                (point - particles[index].position).length() < particles[index].support_radius
            };
            neighbours.around(point).filter(reached).count() as u64
        })
    });
    inside.sum()
}

#[test]
fn slices_bundles_and_particles() {
    for scene in clear_scenes() {
        let (stats, setup, _) = stats(&scene);
        assert_eq!(stats.slices, u64::from(setup.slices.count), "{}", scene.name);
        let bundles = setup.camera.width.div_ceil(8) * setup.camera.height.div_ceil(8);
        assert_eq!(stats.bundles, u64::from(bundles), "{}", scene.name);
        assert_eq!(stats.particles, scene.particles.len() as u64, "{}", scene.name);
        assert_eq!([stats.near, stats.far], [setup.camera.near, setup.camera.far], "{}", scene.name);
    }
}

#[test]
fn the_grid_holds_what_it_must_and_little_more() {
    for scene in clear_scenes() {
        let (stats, setup, particles) = stats(&scene);
        let (must, may) = (must(&setup, &particles), may(&setup, &particles, 0.02));
        let cells = must.iter().map(|&(x, y, layer, _)| (x, y, layer)).collect::<BTreeSet<_>>().len() as u64;
        let (least, most) = (must.len() as u64, may.len() as u64);
        assert!(
            (least..=most).contains(&stats.pairs),
            "{}: {least} <= {} <= {most}",
            scene.name,
            stats.pairs
        );
        assert!(stats.cells >= cells, "{}: {} cells of at least {cells}", scene.name, stats.cells);
    }
}

#[test]
fn full_sampling_evaluates_every_sample_inside_a_support() {
    for scene in clear_scenes() {
        let (stats, setup, particles) = stats(&scene);
        let inside = samples_inside(&setup, &particles);
        // Beyond the picture's edge, bundles are complete.
        let limit = 64 * 16 * stats.pairs;
        let full = stats.evaluations.full;
        assert!((inside..=limit).contains(&full), "{}: {inside} <= {full} <= {limit}", scene.name);
        assert_eq!(stats.evaluations.done, full, "{}", scene.name);
        assert_eq!(stats.predicted_error, 0.0, "{}", scene.name);
    }
}

#[test]
fn a_counting_renderer_knows_which_evaluations_were_inside() {
    // Whole bundles, so that no lane works beyond the picture's edge.
    let mut scene = scenes::plain(140, 32, 24);
    scene.view.transfer.points = vec![grey(0.0, 0.5, 1e-4)];
    let gpu = Gpu::new(&GpuOptions::default()).expect("an adapter");
    let mut counting = Renderer::counting(gpu).expect("a renderer");
    let counted = render(&mut counting, &prepare(&scene)).stats.evaluations;
    let (plain, setup, particles) = stats(&scene);
    let inside = samples_inside(&setup, &particles);
    // A sample on the edge of a support may fall to either side.
    assert!(counted.inside.abs_diff(inside) <= inside / 10_000 + 1, "{} of {inside}", counted.inside);
    assert_eq!((counted.done, plain.evaluations.inside), (plain.evaluations.done, 0));
}

/// So many particles of this radius in a single cell, and the weights that its analysis computes for bricks so wide.
fn weights_of_analysis(count: usize, support_radius: f64, width: BrickWidth) -> u64 {
    let mut scene = scenes::plain(141, 8, 8);
    let camera = scene.view.camera.as_mut().expect("plain scenes have a camera");
    let middle = (camera.target - camera.eye).length();
    (camera.near, camera.far) = (Some(0.99 * middle), Some(1.01 * middle));
    scene.view.transfer.points = vec![grey(0.0, 0.5, 0.1), grey(1.0, 0.5, 0.2)];
    (scene.view.sampling.tolerance, scene.view.sampling.brick_width) = (Some(0.01), width);
    scene.particles.truncate(count);
    for particle in &mut scene.particles {
        (particle.position, particle.support_radius) = (0.01 * particle.position, support_radius);
    }
    let stats = render(&mut shared(), &prepare_anyway(&scene)).stats;
    assert_eq!((stats.cells, stats.pairs), (1, count as u64));
    stats.evaluations.bounds
}

#[test]
fn the_analysis_computes_a_weight_in_each_brick_of_the_columns_that_a_particle_meets() {
    for count in [1, 2, 17, 40] {
        assert_eq!(weights_of_analysis(count, 2.5, BrickWidth::Two), 64 * count as u64);
        assert_eq!(weights_of_analysis(count, 2.5, BrickWidth::Four), 16 * count as u64);
    }
    let weights = [1.5, 1.1, 0.8].map(|radius| weights_of_analysis(1, radius, BrickWidth::Two));
    assert!(weights.is_sorted_by(|a, b| a > b), "{weights:?}");
    assert!(weights.iter().all(|weights| *weights > 0 && weights % 4 == 0), "{weights:?}");
}

#[test]
fn where_supports_are_large_four_columns_share_their_weights() {
    for count in [1, 2, 17, 40] {
        assert_eq!(weights_of_analysis(count, 10.0, BrickWidth::Two), 16 * count as u64);
    }
}
