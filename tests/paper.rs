//! The paper's own bound (HPG 2016, Sec. 4 and 5): strict, it keeps the tolerance too; its coarser levels
//! are those of the twin.

use reference::Particle;
use reference::compare::compare;
use reference::device::{open, shared};
use reference::guarantee::{Trial, calm, case, hard_cases, try_out};
use reference::picture::{self, Image};
use reference::random::Random;
use reference::scenes::{self, Scene, Shape, grey};
use reference::setup::Setup;
use renderer::{Bound, CellClasses, GpuOptions, Kernel, Renderer};

/// `scene`, sampled by the paper's bound.
fn by_the_paper(mut scene: Scene, relaxation: f64) -> Scene {
    let sampling = &mut scene.view.sampling;
    (sampling.bound, sampling.relaxation) = (Bound::Paper, relaxation);
    scene
}

/// Scenes for the strict bound: random ones, and some in which it allows something.
fn strict_cases() -> impl Iterator<Item = Scene> {
    (0..40).map(case).chain(hard_cases()).chain((40..80).map(faint)).map(|scene| by_the_paper(scene, 0.0))
}

/// A calm scene with hardly any contrast, or with hardly any opacity; now and then with holes in it.
fn faint(seed: u64) -> Scene {
    let mut random = Random::new(seed);
    let mut scene = calm(seed, 57, 43);
    let (contrast, size) = (random.pick(&[0.0, 0.003, 0.03, 0.3]), random.pick(&[1.0, 1.0, 0.6, 0.3]));
    for particle in &mut scene.particles {
        particle.quantity = 0.5 + contrast * (particle.quantity - 0.5);
        particle.support_radius *= size;
    }
    let thinner = random.log_between(0.3, 100.0);
    scene.view.transfer.reference_length = scene.view.transfer.reference_length.map(|l| thinner * l);
    let sampling = &mut scene.view.sampling;
    sampling.tolerance = Some(random.log_between(3e-3, 0.1));
    (sampling.z_adaptive, sampling.super_pixels) = random.pick(&[(true, true), (true, false), (false, true)]);
    scene.name = format!("faint {seed}, contrast {contrast}, radii by {size}, thinner by {thinner}");
    scene
}

#[test]
fn strict_it_keeps_the_tolerance() {
    let mut renderer = shared();
    let trials: Vec<Trial> = strict_cases().map(|scene| try_out(&mut renderer, &scene)).collect();
    let violations: Vec<String> = trials.iter().filter_map(Trial::violation).collect();
    assert!(violations.is_empty(), "{} cases:\n{}", violations.len(), violations.join("\n"));
    let spent = |share: f64| {
        trials
            .iter()
            .filter(|t| t.adaptive.stats.predicted_error > share * t.tolerance && t.share() < 0.7)
            .count()
    };
    assert!(
        spent(0.1) >= 20 && spent(0.9) >= 3,
        "{} and {} pictures use the tolerance",
        spent(0.1),
        spent(0.9)
    );
    let cells = trials.iter().map(counts).fold([0; 5], sum);
    assert!(cells.iter().all(|&count| count > 0), "cells at levels 1 to 4, and as super-pixels: {cells:?}");
}

/// Cells at levels 1 to 4, and those shown by one colour.
fn counts(trial: &Trial) -> [u64; 5] {
    let CellClasses { z_adaptive: [one, two, three, four], super_pixel, .. } =
        trial.adaptive.stats.cells_by_class;
    [one, two, three, four, super_pixel]
}

fn sum(a: [u64; 5], b: [u64; 5]) -> [u64; 5] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// What is wrong on purpose, and the edits of the shaders' text that make it so: from, to.
const MUTANTS: [(&str, &[(&str, &str)]); 6] = [
    ("every slab is taken to be covered", &[("covered &= held;", "")]),
    ("a particle is met in the slab of its centre only", &[("ball.w * (1.0 + RADIUS_SLACK)", "0.0")]),
    (
        "the nodes between the ends of a range are overlooked",
        &[("if between > 0u {", "if between > 1000000u {")],
    ),
    ("no light passes a cell", &[("open <= OCCLUDED * chunk.budget", "open <= 1.0")]),
    ("the front is free", &[("behind(front, behind(interval, back))", "behind(interval, back)")]),
    (
        "a coarse sample is as uncertain as its first slab",
        &[("for (var i = 1u; i < slabs", "for (var i = slabs; i < slabs")],
    ),
];

#[test]
fn every_mutant_is_noticed() {
    let mut unnoticed = Vec::new();
    for (what, edits) in MUTANTS {
        let mut renderer = edited(edits);
        match strict_cases().find_map(|scene| try_out(&mut renderer, &scene).violation()) {
            Some(violation) => println!("{what}: {violation}"),
            None => unnoticed.push(what),
        }
    }
    assert!(unnoticed.is_empty(), "unnoticed: {}", unnoticed.join("; "));
}

fn edited(edits: &[(&str, &str)]) -> Renderer {
    let shader_edits = edits.iter().map(|(from, to)| (from.to_string(), to.to_string())).collect();
    open(&GpuOptions { shader_edits, ..GpuOptions::default() })
}

#[test]
fn coarse_samples_are_those_of_the_twin() {
    // Of other shapes the particles are too small for any analysis.
    let shapes = [Shape::JitteredLattice, Shape::MixedRadii, Shape::Giants];
    let mut cells = [0; 5];
    for first in [0, 3] {
        // In place of a choice, the level of the cell's layer.
        let level = format!("Choice((cell % tile.layers + {first}u) % 5u, nothing());");
        let mut renderer = edited(&[("choose(place, back, select(budget, 0.0, is_crowd(cell)));", &level)]);
        let random = (60..69).map(|seed| {
            let i = seed as usize;
            scenes::random(seed, shapes[i % 3], [33, 21], Kernel::ALL[i / 3 % 3])
        });
        for scene in random.chain([scenes::plain(70, 33, 21)]) {
            let mut scene = by_the_paper(scene, 1.0);
            // So tight that a ray goes on until hardly any light is left.
            scene.view.sampling.tolerance = Some(1e-3);
            let trial = try_out(&mut renderer, &scene);
            cells = sum(cells, counts(&trial));
            let setup = Setup::new(&scene.view);
            let particles = picture::raised(&setup, &scene.particles);
            let twin = picture::render_at_levels(&setup, &particles, &|layer| (layer + first) % 5);
            let comparison = compare(&twin, &Image::from(&trial.adaptive));
            assert!(comparison.is_alike(), "{}: {comparison}", scene.name);
        }
    }
    assert!(cells[..4].iter().all(|&count| count > 20), "cells at levels 1 to 4: {cells:?}");
}

/// The inside of a thin fluid in which the quantity changes from one end of the view to the other, and
/// by waves of some length along the rays.
fn inside(waves: f64) -> Scene {
    let mut scene = calm(90, 57, 43);
    for particle in &mut scene.particles {
        let place = particle.position;
        particle.quantity = 0.5 + 0.1 * place.x + 0.4 * (waves * place.z).sin();
    }
    let camera = scene.view.camera.as_mut().expect("calm scenes have a camera");
    (camera.near, camera.far) = (Some(3.4), Some(4.6));
    scene.view.transfer.points = vec![grey(0.0, 0.2, 0.1), grey(1.0, 0.9, 0.9)];
    scene.view.transfer.reference_length = Some(30.0);
    let sampling = &mut scene.view.sampling;
    (sampling.tolerance, sampling.super_pixels) = (Some(0.02), false);
    by_the_paper(scene, 1.0)
}

#[test]
fn relaxed_it_samples_coarsely_where_rays_see_no_change() {
    let mut renderer = shared();
    let mut try_waves = |waves: f64| try_out(&mut renderer, &inside(waves));
    let (still, moved) = (try_waves(0.0), try_waves(4.0));
    let cells = still.adaptive.stats.cells;
    assert_eq!(counts(&still), [0, 0, 0, cells, 0]);
    assert!(still.share() < 0.07 && still.comparison.max < 1e-5, "{}, {}", still.share(), still.comparison);
    let [.., coarsest, _] = counts(&moved);
    assert!(coarsest < cells && moved.share() > 0.2, "{coarsest} of {cells} cells, {}", moved.share());
    assert!(moved.comparison.max > 1e-4 && moved.comparison.max < 0.02, "{}", moved.comparison);
}

#[test]
fn crowded_cells_are_sampled_as_they_are() {
    let mut scene = inside(0.0);
    let heap = scene.particles[scene.particles.len() / 2];
    // More than a workgroup walks over, and of a quantity of their own.
    scene.particles.extend([Particle { quantity: 1.0, support_radius: 0.1, ..heap }; 2100]);
    let trial = try_out(&mut shared(), &scene);
    let CellClasses { full, z_adaptive, .. } = trial.adaptive.stats.cells_by_class;
    assert!(full > 0 && z_adaptive[3] > 0, "{full} cells in full beside {z_adaptive:?}");
    assert_eq!(trial.violation(), None);
}

#[test]
fn relaxed_it_saves_more() {
    let mut renderer = shared();
    let mut shares = |relaxation: f64| {
        let trials: Vec<Trial> =
            (40..60).map(|seed| try_out(&mut renderer, &by_the_paper(faint(seed), relaxation))).collect();
        let cells = trials.iter().map(counts).fold([0; 5], sum);
        let predicted = trials.iter().all(|t| t.adaptive.stats.predicted_error <= t.tolerance);
        assert!(predicted, "a prediction above the tolerance at a relaxation of {relaxation}");
        (trials.iter().map(Trial::share).sum::<f64>() / 20.0, cells)
    };
    let ((strict, _), (half, _), (relaxed, cells)) = (shares(0.0), shares(0.5), shares(1.0));
    println!("{strict} {half} {relaxed} {cells:?}");
    assert!(relaxed < half && half < strict && relaxed < 0.5 * strict, "{strict}, {half}, {relaxed}");
    assert!(cells.iter().all(|&count| count > 0), "cells at levels 1 to 4, and as super-pixels: {cells:?}");
}
