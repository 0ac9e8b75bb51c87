//! The guarantee (contract, section 1): with a relaxation of 0, no channel of any pixel of an adaptive
//! picture is as far as the tolerance from full sampling of the same view on the same device. Nor is
//! it farther than the picture's own prediction.

use glam::DVec3;
use reference::device::shared;
use reference::guarantee::{ROUNDING, Trial, calm, case, hard_cases, try_out};
use reference::scenes::Scene;
use renderer::{CellClasses, Kernel};

/// Fails with a line for each scene that breaks its promise, which is printed at once.
fn assert_kept(scenes: impl IntoIterator<Item = Scene>) {
    let mut renderer = shared();
    let violations: Vec<String> = scenes
        .into_iter()
        .filter_map(|scene| {
            let violation = try_out(&mut renderer, &scene).violation();
            violation.inspect(|violation| eprintln!("{violation}"))
        })
        .collect();
    assert!(violations.is_empty(), "{} cases:\n{}", violations.len(), violations.join("\n"));
}

#[test]
fn a_hundred_random_cases() {
    assert_kept((0..100).map(case));
}

/// `GUARANTEE_CASES` cases (2000 where it is not set), from the seed `GUARANTEE_SEED` (1000) on.
#[test]
#[ignore = "takes many minutes"]
fn some_thousand_random_cases() {
    let [cases, first] = [("GUARANTEE_CASES", 2000), ("GUARANTEE_SEED", 1000)].map(|(name, default)| {
        std::env::var(name).map_or(default, |value| value.parse().expect("a whole number"))
    });
    assert_kept((first..first + cases).map(case));
}

#[test]
fn the_hundred_cases_are_telling_ones() {
    let mut renderer = shared();
    let trials: Vec<_> = (0..100).map(|seed| try_out(&mut renderer, &case(seed))).collect();
    let count = |holds: &dyn Fn(&Trial) -> bool| trials.iter().filter(|trial| holds(trial)).count();
    let shown = count(&|trial| trial.adaptive.stats.cells_by_class.super_pixel > 0);
    let spent = count(&|trial| trial.comparison.max > 0.5 * trial.tolerance && trial.tolerance < 1.0);
    let fewer = count(&|trial| trial.share() < 0.7);
    assert!(shown >= 30, "{shown} pictures have cells without samples");
    assert!(spent >= 20, "{spent} pictures use up half of their tolerance");
    assert!(fewer >= 25, "{fewer} pictures take fewer evaluations");
}

#[test]
fn quantities_at_a_jump_of_the_transfer_function() {
    assert_kept(hard_cases());
}

/// Kernels, cameras inside and outside, and tolerances for a scene in which much can be saved.
fn calm_scenes() -> Vec<Scene> {
    let mut scenes: Vec<Scene> = Kernel::ALL
        .into_iter()
        .map(|kernel| {
            let mut scene = calm(20, 97, 72);
            scene.view.particles.kernel = kernel;
            scene
        })
        .collect();
    let mut inside = calm(21, 97, 72);
    let camera = inside.view.camera.as_mut().expect("calm scenes have a camera");
    (camera.eye, camera.target) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(-1.0, 0.5, -0.2));
    (camera.near, camera.far) = (Some(0.2), Some(2.5));
    scenes.push(inside);
    scenes
}

#[test]
fn a_calm_scene_takes_fewer_evaluations() {
    for scene in calm_scenes() {
        let trial = try_out(&mut shared(), &scene);
        assert_eq!(trial.violation(), None);
        let CellClasses { full, mixed, super_pixel, .. } = trial.adaptive.stats.cells_by_class;
        assert!(super_pixel > full + mixed, "{}: {super_pixel} beside {full} + {mixed}", scene.name);
        assert!(trial.share() < 0.5, "{}: {} of full sampling", scene.name, trial.share());
        let predicted = trial.adaptive.stats.predicted_error;
        assert!(predicted > 0.0 && predicted <= 0.01, "{}: predicted {predicted}", scene.name);
    }
}

#[test]
fn a_higher_tolerance_takes_no_more_evaluations() {
    let done = |tolerance: f64| {
        let mut scene = calm(22, 97, 72);
        scene.view.sampling.tolerance = Some(tolerance);
        try_out(&mut shared(), &scene).share()
    };
    let shares = [1e-4, 1e-3, 1e-2, 1e-1].map(done);
    assert!(shares.is_sorted_by(|a, b| *b <= a * 1.02), "{shares:?}");
}

#[test]
fn without_super_pixels_and_levels_every_sample_is_taken() {
    let mut scene = calm(23, 57, 43);
    (scene.view.sampling.super_pixels, scene.view.sampling.z_adaptive) = (false, false);
    let trial = try_out(&mut shared(), &scene);
    let classes = trial.adaptive.stats.cells_by_class;
    // Bricks with nothing in them need no samples.
    assert_eq!((classes.super_pixel, classes.z_adaptive), (0, [0; 4]));
    assert!(trial.comparison.max < 3e-5, "{}", trial.comparison);
    assert_eq!(trial.violation(), None);
}

#[test]
fn with_levels_only() {
    let mut renderer = shared();
    let cases = (200..240).map(case).chain(calm_scenes());
    let only_levels = cases.map(|mut scene| {
        scene.view.sampling.super_pixels = false;
        scene
    });
    let mut coarse = 0;
    for scene in only_levels {
        let trial = try_out(&mut renderer, &scene);
        assert_eq!(trial.violation(), None);
        let classes = trial.adaptive.stats.cells_by_class;
        assert_eq!(classes.super_pixel, 0, "{}", scene.name);
        coarse += classes.z_adaptive[1];
    }
    assert!(coarse > 100, "{coarse} cells were sampled at level 2");
}

#[test]
fn relaxation_samples_more_coarsely() {
    let mut scene = calm(24, 57, 43);
    scene.view.sampling.super_pixels = false;
    let mut renderer = shared();
    let done = [0.0, 0.5, 1.0].map(|relaxation| {
        scene.view.sampling.relaxation = relaxation;
        try_out(&mut renderer, &scene).adaptive.stats.evaluations.done
    });
    assert!(done[0] > done[1] && done[1] > done[2], "{done:?} evaluations");
}

#[test]
fn tolerances_within_rounding_are_full_sampling_and_others_are_not() {
    let trial = |tolerance: f64| {
        let mut scene = calm(24, 97, 72);
        scene.view.sampling.tolerance = Some(tolerance);
        try_out(&mut shared(), &scene)
    };
    for tolerance in [1e-7, 2.9e-5, ROUNDING] {
        let Trial { full, adaptive, .. } = trial(tolerance);
        assert_eq!(full.pixels, adaptive.pixels, "{tolerance}");
        assert_eq!(full.stats.evaluations, adaptive.stats.evaluations, "{tolerance}");
    }
    let Trial { adaptive, .. } = trial(3.1e-5);
    assert!(adaptive.stats.evaluations.bounds > 0 && adaptive.stats.predicted_error < 3.1e-5);
}

#[test]
fn a_tolerance_of_zero_is_full_sampling() {
    let cases = (0..20).map(case).chain(calm_scenes());
    for mut scene in cases {
        scene.view.sampling.tolerance = Some(0.0);
        let trial = try_out(&mut shared(), &scene);
        assert_eq!(trial.full.pixels, trial.adaptive.pixels, "{}", scene.name);
        assert_eq!(trial.adaptive.stats.predicted_error, 0.0, "{}", scene.name);
    }
}
