//! Parts of the method left out, for measurements: the tolerance is kept without them, and less is saved.

use glam::DVec3;
use reference::Particle;
use reference::device::shared;
use reference::guarantee::{calm, case, hard_cases, try_out, try_without};
use reference::random::Random;
use reference::scenes::{Scene, plain_view};
use renderer::{ControlPoint, Without};

const PARTS: [Without; 5] =
    [Without::Expansion, Without::Coverage, Without::Slopes, Without::GreedFromFront, Without::GreedFromBack];

#[test]
fn the_tolerance_is_kept_without_any_part() {
    let mut renderer = shared();
    let scenes: Vec<Scene> = (100..130).map(case).chain(hard_cases()).chain([calm(20, 97, 72)]).collect();
    let trials = scenes.iter().flat_map(|scene| PARTS.map(|part| (part, scene)));
    let violations: Vec<String> = trials
        .filter_map(|(part, scene)| {
            let violation = try_without(&mut renderer, scene, part).violation()?;
            Some(format!("without {part:?}: {violation}"))
        })
        .collect();
    assert!(violations.is_empty(), "{} cases:\n{}", violations.len(), violations.join("\n"));
}

/// A jittered lattice with the quantity |x|, seen from the front right: `demo:radial` with a ramp.
fn lattice() -> Scene {
    const SIDE: i32 = 18;
    let spacing = 2.0 / f64::from(SIDE);
    let mut random = Random::new(60);
    let place = |i: i32| (f64::from(i) + 0.5) * spacing - 1.0;
    let mut particles = Vec::new();
    for (x, y, z) in (0..SIDE).flat_map(|x| (0..SIDE).flat_map(move |y| (0..SIDE).map(move |z| (x, y, z)))) {
        let position = DVec3::new(place(x), place(y), place(z)) + 0.15 * spacing * random.in_cube();
        let quantity = position.length().min(1.0);
        particles.push(Particle {
            position,
            support_radius: 2.0 * spacing,
            volume: 1.0,
            quantity,
            opacity: 0.0,
        });
    }
    let mut view = plain_view(240, 180);
    let camera = view.camera.as_mut().expect("a plain view has a camera");
    (camera.eye, camera.fov_y_degrees) = (DVec3::new(2.2, 1.6, 2.8), 45.0);
    (camera.near, camera.far) = (Some(2.2), Some(5.8));
    view.transfer.reference_length = Some(0.1);
    view.transfer.points = vec![
        ControlPoint { u: 0.0, rgb: [0.1, 0.2, 0.9], opacity: 0.02 },
        ControlPoint { u: 1.0, rgb: [0.9, 0.3, 0.1], opacity: 0.3 },
    ];
    view.sampling.tolerance = Some(0.004);
    view.sampling.relaxation = 0.0;
    Scene { name: "lattice".to_owned(), particles, view }
}

#[test]
fn nothing_less_is_sampled_without_any_part() {
    let (mut renderer, scene) = (shared(), lattice());
    // Of the casting alone: it is what the parts are to spare.
    let cast = |trial: reference::guarantee::Trial| {
        assert_eq!(trial.violation(), None);
        let evaluations = trial.adaptive.stats.evaluations;
        let full = trial.full.stats.evaluations.done;
        (evaluations.done - evaluations.bounds) as f64 / full as f64
    };
    let complete = cast(try_out(&mut renderer, &scene));
    assert!(complete < 0.6, "{complete} of full sampling");
    for part in PARTS {
        let share = cast(try_without(&mut renderer, &scene, part));
        println!("without {part:?}: {share:.3} beside {complete:.3}");
        assert!(share > 1.02 * complete, "without {part:?}: {share}, and {complete} with it");
    }
}

#[test]
fn the_complete_method_is_there_again_afterwards() {
    let (mut renderer, scene) = (shared(), calm(61, 57, 43));
    let before = try_out(&mut renderer, &scene);
    for part in PARTS {
        let without = try_without(&mut renderer, &scene, part);
        assert_ne!(without.adaptive.pixels, before.adaptive.pixels, "{part:?}");
        assert_eq!(try_out(&mut renderer, &scene).adaptive.pixels, before.adaptive.pixels, "{part:?}");
    }
}

/// Sums in another order: single precision alone sets the pictures apart, but at steps of the transfer function.
#[test]
fn particles_looked_up_by_place_make_the_same_picture() {
    let mut renderer = shared();
    let unlike = |scene: Scene| {
        let trial = try_without(&mut renderer, &scene, Without::CellsAlongRays);
        let stats = &trial.adaptive.stats;
        assert_eq!((stats.evaluations.bounds, stats.cells), (0, 0));
        let (share, max) = (trial.comparison.share_above(1e-4), trial.comparison.max);
        (share > 2e-3).then(|| format!("{}: {share} of the pixels differ, by {max} at most", scene.name))
    };
    let unlike: Vec<String> = (100..120).map(case).chain([lattice()]).filter_map(unlike).collect();
    assert!(unlike.is_empty(), "{}", unlike.join("\n"));
    // The grid of cells is what it was.
    assert_eq!(try_out(&mut renderer, &calm(61, 57, 43)).violation(), None);
}
