//! Colour by one field, opacity by another: pictures are those of the f64 twin, adaptive ones keep their
//! tolerance, and what may not change a picture does not.

#[path = "two_fields/log_opacity.rs"]
mod log_opacity;
#[path = "two_fields/wrong_bounds.rs"]
mod wrong_bounds;

use std::ops::ControlFlow;

use glam::DVec3;
use reference::Particle;
use reference::compare::compare;
use reference::device::{assert_alike, mismatch, open, picture, prepare, render, shared};
use reference::guarantee::{Trial, calm, case, hard_cases, try_out, with_opacity};
use reference::picture::{Image, render_with_floor};
use reference::random::Random;
use reference::scenes::{self, Scene, Shape, grey, plain_view};
use reference::setup::Setup;
use renderer::{BandLayers, Bound, GpuOptions, Kernel, OpacityView, OutsideView, Scale, Without};

fn by_range(range: [f64; 2]) -> OpacityView {
    OpacityView { range: Some(range), ..OpacityView::default() }
}

/// The plain scene with an opacity that rises to the right and an own unit.
fn plain(seed: u64) -> Scene {
    let mut scene = scenes::plain(seed, 33, 21);
    for particle in &mut scene.particles {
        particle.opacity = 1000.0 + 50.0 * particle.position.x;
    }
    scene.view.quantity.opacity = Some(by_range([950.0, 1050.0]));
    scene.name += ", opacity to the right";
    scene
}

/// Scenes of all shapes, each with another kernel than the last.
fn random_scenes(seeds: std::ops::Range<u64>) -> impl Iterator<Item = Scene> {
    seeds.map(|seed| {
        let (shape, kernel) = (Shape::ALL[seed as usize % Shape::ALL.len()], Kernel::ALL[seed as usize % 3]);
        with_opacity(seed, scenes::random(seed, shape, [24, 17], kernel))
    })
}

/// The two fields of each particle change places.
fn swapped(scene: &Scene) -> Scene {
    let mut swapped = scene.clone();
    for particle in &mut swapped.particles {
        (particle.quantity, particle.opacity) = (particle.opacity, particle.quantity);
    }
    let opacity = swapped.view.quantity.opacity.as_mut().expect("a field for the opacity");
    std::mem::swap(&mut opacity.range, &mut swapped.view.quantity.range);
    std::mem::swap(&mut opacity.scale, &mut swapped.view.quantity.scale);
    swapped
}

#[test]
fn pictures_match_the_twin() {
    assert_alike(random_scenes(300..321).chain([plain(10), swapped(&plain(10))]));
}

#[test]
fn swapped_fields_and_one_field_are_noticed() {
    let scene = plain(10);
    let image = picture(&scene);
    assert_eq!(mismatch(&scene, &image), None);
    let mut one = scene.clone();
    one.view.quantity.opacity = None;
    for wrong in [swapped(&scene), one] {
        assert!(mismatch(&wrong, &image).is_some(), "{}", wrong.name);
        let twins = [&scene, &wrong].map(|s| render_with_floor(&Setup::new(&s.view), &s.particles));
        assert!(!compare(&twins[0], &twins[1]).is_alike(), "the twins are alike");
    }
}

#[test]
fn a_field_beside_itself_is_one_field() {
    for mut scene in [scenes::plain(11, 33, 21), scenes::random(12, Shape::Clusters, [24, 17], Kernel::Cubic)]
    {
        let before = picture(&scene);
        scene.particles.iter_mut().for_each(|particle| particle.opacity = particle.quantity);
        scene.view.quantity.opacity =
            Some(OpacityView { range: scene.view.quantity.range, ..OpacityView::default() });
        let after = picture(&scene);
        assert!(before.pixels == after.pixels, "{}: {}", scene.name, compare(&before, &after));
    }
}

/// The tolerance is kept by each of `scenes`; what was tried.
fn assert_kept(scenes: impl IntoIterator<Item = Scene>) -> Vec<Trial> {
    let mut renderer = shared();
    let trials: Vec<Trial> = scenes.into_iter().map(|scene| try_out(&mut renderer, &scene)).collect();
    let violations: Vec<String> = trials.iter().filter_map(Trial::violation).collect();
    assert!(violations.is_empty(), "{} cases:\n{}", violations.len(), violations.join("\n"));
    trials
}

#[test]
fn the_tolerance_is_kept_by_random_cases() {
    let trials = assert_kept((0..100).map(|seed| with_opacity(seed, case(seed))));
    let count = |holds: &dyn Fn(&Trial) -> bool| trials.iter().filter(|trial| holds(trial)).count();
    let shown = count(&|trial| trial.adaptive.stats.cells_by_class.super_pixel > 0);
    let spent = count(&|trial| trial.comparison.max > 0.5 * trial.tolerance && trial.tolerance < 1.0);
    let fewer = count(&|trial| trial.share() < 0.7);
    println!("{shown} with cells without samples, {spent} spend half, {fewer} take fewer evaluations");
    assert!(shown >= 25 && spent >= 15 && fewer >= 15, "{shown}, {spent}, {fewer}");
}

/// `GUARANTEE_CASES` cases (1000 where it is not set), from the seed `GUARANTEE_SEED` (1000) on.
#[test]
#[ignore = "takes many minutes"]
fn the_tolerance_is_kept_by_many_random_cases() {
    let [cases, first] = [("GUARANTEE_CASES", 1000), ("GUARANTEE_SEED", 1000)].map(|(name, default)| {
        std::env::var(name).map_or(default, |value| value.parse().expect("a whole number"))
    });
    for seed in first..first + cases {
        assert_kept([with_opacity(seed, case(seed))]);
    }
}

#[test]
fn the_tolerance_is_kept_at_jumps_of_the_transfer_function() {
    let both = hard_cases().into_iter().zip(0..).flat_map(|(scene, seed)| {
        let other = with_opacity(seed, scene);
        [swapped(&other), other]
    });
    assert_kept(both);
}

#[test]
fn the_tolerance_is_kept_by_levels_alone_and_by_colours_alone() {
    let trials = assert_kept((200..230).map(|seed| {
        let mut scene = with_opacity(seed, case(seed));
        scene.view.sampling.super_pixels = seed % 2 == 0;
        scene.view.sampling.z_adaptive = seed % 2 == 1;
        scene
    }));
    let coarse: u64 = trials.iter().map(|trial| trial.adaptive.stats.cells_by_class.z_adaptive[1]).sum();
    assert!(coarse > 30, "{coarse} cells were sampled at level 2");
}

#[test]
fn a_calm_scene_takes_fewer_evaluations() {
    let mut scene = calm(20, 97, 72);
    for particle in &mut scene.particles {
        particle.opacity = 0.5 + 0.4 * (0.5 * particle.position.z - 0.2 * particle.position.x).sin();
    }
    scene.view.quantity.opacity = Some(by_range([0.0, 1.0]));
    for trial in assert_kept([swapped(&scene), scene]) {
        assert!(trial.share() < 0.5, "{} of full sampling", trial.share());
        assert!(trial.adaptive.stats.predicted_error > 0.0);
    }
}

#[test]
fn by_the_papers_bound_two_fields_are_sampled_in_full() {
    let mut scene = with_opacity(3, calm(21, 57, 43));
    scene.view.sampling.bound = Bound::Paper;
    let [trial] = &assert_kept([scene])[..] else { unreachable!() };
    assert!(trial.adaptive.stats.is_in_full());
    assert_eq!(trial.full.pixels, trial.adaptive.pixels);
}

#[test]
fn rendering_again_and_another_order_change_nothing() {
    let mut random = Random::new(17);
    for scene in [plain(10), swapped(&plain(12))] {
        let before = picture(&scene);
        let same = |what: &str, image: &Image<f32>| {
            let comparison = compare(&before, image);
            assert!(comparison.max <= 1e-4, "{what}: {comparison}");
        };
        same("again", &picture(&scene));
        let mut shuffled = scene.clone();
        random.shuffle(&mut shuffled.particles);
        same("shuffled", &picture(&shuffled));
        let mut moved = scene.clone();
        scenes::transform(&mut moved.particles, &mut moved.view, 1e6, DVec3::new(2e9, -1e9, 3e9));
        same("elsewhere", &picture(&moved));
        let mut scaled = scene.clone();
        scaled.particles.iter_mut().for_each(|particle| particle.opacity *= 1e25);
        let opacity = scaled.view.quantity.opacity.as_mut().expect("a field for the opacity");
        opacity.range = opacity.range.map(|range| range.map(|q| q * 1e25));
        same("the opacity in another unit", &picture(&scaled));
    }
}

/// The plain scene with other values of the field that decides the opacity.
fn with_values(what: &str, range: [f64; 2], value: impl Fn(usize, f64) -> f64) -> Scene {
    let mut scene = plain(13);
    for (index, particle) in scene.particles.iter_mut().enumerate() {
        particle.opacity = value(index, particle.opacity);
    }
    scene.view.quantity.opacity = Some(by_range(range));
    scene.view.sampling.tolerance = Some(0.01);
    scene.name = what.to_owned();
    scene
}

#[test]
fn values_at_their_ends() {
    let scenes = || {
        [
            with_values("a constant", [0.0, 1.0], |_, _| 0.7),
            with_values("a constant and no width", [0.7, 0.7], |_, _| 0.7),
            with_values("all beyond the range", [0.0, 1.0], |_, _| 2.0),
            with_values("huge", [-3e38, 3e38], |_, q| 6e38 * ((q - 950.0) / 100.0 - 0.5)),
            with_values("outliers", [950.0, 1050.0], |index, q| if index % 7 == 0 { 1e30 } else { q }),
            with_values("none is a number", [0.0, 1.0], |_, _| f64::NAN),
        ]
    };
    assert_alike(scenes());
    assert_kept(scenes());
}

#[test]
fn particles_without_a_value_are_left_out_and_counted() {
    let scene = with_values("some without a value", [950.0, 1050.0], |index, q| match index % 5 {
        0 => f64::NAN,
        1 => f64::INFINITY,
        _ => q,
    });
    let picture = render(&mut shared(), &prepare(&scene));
    let left_out = (0..scene.particles.len()).filter(|index| index % 5 < 2).count() as u64;
    assert_eq!(picture.stats.rejected.non_finite, left_out);
    assert_eq!(picture.stats.particles, scene.particles.len() as u64 - left_out);
    assert_alike([scene.clone()]);
    assert_kept([scene]);
}

/// More particles in one place than one workgroup walks over.
fn crowded() -> Scene {
    let mut scene = plain(14);
    let mut random = Random::new(14);
    let heap = Particle { position: DVec3::new(0.1, 0.2, 0.3), ..scene.particles[0] };
    scene.particles.extend((0..5000).map(|_| Particle {
        quantity: random.unit(),
        opacity: random.between(950.0, 1050.0),
        ..heap
    }));
    scene.view.sampling.tolerance = Some(0.01);
    scene.name += ", a crowd";
    scene
}

#[test]
fn crowds_have_sums_of_both() {
    assert_alike([crowded()]);
    assert_kept([crowded()]);
}

#[test]
fn little_memory_makes_the_same_pictures() {
    // As little as holds what is in one place.
    for (scene, memory) in
        [(plain(15), 256 << 10), (crowded(), 2 << 20), (with_opacity(5, calm(16, 64, 48)), 1 << 20)]
    {
        let mut prepared = prepare(&scene);
        prepared.sampling.always_adaptive = true;
        let whole = Image::from(&render(&mut shared(), &prepared));
        let mut little = open(&GpuOptions { memory: Some(memory), ..GpuOptions::default() });
        let comparison = compare(&whole, &Image::from(&render(&mut little, &prepared)));
        assert!(comparison.max <= 1e-4, "{} with {memory} bytes: {comparison}", scene.name);
    }
}

#[test]
fn bands_make_the_same_picture() {
    let scene = with_opacity(6, calm(17, 64, 48));
    let mut prepared = prepare(&scene);
    prepared.sampling.always_adaptive = true;
    let whole = Image::from(&render(&mut shared(), &prepared));
    let mut image = Image { pixels: Vec::new(), ..whole.clone() };
    let mut take = |band: renderer::Band| {
        image.pixels.extend(band.pixels);
        ControlFlow::Continue(())
    };
    let go_on = &mut |_| ControlFlow::Continue(());
    shared()
        .render_bands(&prepared, 16, BandLayers::default(), go_on, &mut take)
        .unwrap_or_else(|error| panic!("{error}"));
    let comparison = compare(&whole, &image);
    assert!(comparison.max <= 1e-4, "{comparison}");
}

#[test]
fn what_is_known_of_one_field_is_not_taken_for_two() {
    let mut renderer = shared();
    let both = prepare(&crowded());
    let mut one = crowded();
    one.view.quantity.opacity = None;
    // The same particles, so that all but the quantity stays on the device.
    let alone = reference::device::quantity(&both.particles, &one.particles, &one.view);
    let alone = renderer::Scene { quantity: alone, ..both.clone() };
    let fresh = |scene: &renderer::Scene| {
        let mut renderer = open(&GpuOptions::default());
        render(&mut renderer, scene).pixels
    };
    let [expected, expected_alone] = [fresh(&both), fresh(&alone)];
    assert!(expected != expected_alone);
    for _ in 0..2 {
        assert!(render(&mut renderer, &both).pixels == expected);
        assert!(render(&mut renderer, &alone).pixels == expected_alone);
    }
    let mut again = both.clone();
    again.sampling.tolerance = None;
    let map = renderer.render_with_cells(&again, &mut |_| ControlFlow::Continue(()));
    assert!(map.is_ok());
}

#[test]
fn in_object_space() {
    let mut scene = plain(16);
    scene.view.sampling.tolerance = None;
    let mut prepared = prepare(&scene);
    prepared.sampling.without = Without::CellsAlongRays;
    let image = Image::from(&render(&mut shared(), &prepared));
    assert_eq!(mismatch(&scene, &image), None);
}

/// The scene with a positive quantity on a logarithmic scale, and colours outside of its range.
fn on_a_log_scale(mut scene: Scene) -> Scene {
    let [low, high] = scene.view.quantity.range.expect("scenes have ranges");
    for particle in &mut scene.particles {
        particle.quantity = 1e-3 * 1e3_f64.powf((particle.quantity - low) / (high - low));
    }
    scene.view.quantity.range = Some([3e-3, 0.7]);
    scene.view.quantity.scale = Scale::Log;
    scene.view.quantity.below = Some(OutsideView { rgb: [0.1, 0.9, 0.2], opacity: 1.0 });
    scene.view.quantity.above = Some(OutsideView { rgb: [0.9, 0.8, 0.1], opacity: 0.0 });
    scene.name += ", colours on a logarithmic scale";
    scene
}

#[test]
fn the_scale_of_the_colour_leaves_the_opacity_alone() {
    for scene in [plain(19), with_opacity(7, scenes::plain(20, 33, 21))] {
        let [linear, log] = [picture(&scene), picture(&on_a_log_scale(scene.clone()))];
        let apart = |channel: usize| {
            let pairs = linear.pixels.iter().zip(&log.pixels);
            pairs.map(|(a, b)| (a[channel] - b[channel]).abs()).fold(0.0, f32::max)
        };
        assert!(apart(3) < 1e-5 && apart(0) > 0.05, "{}: {} and {}", scene.name, apart(3), apart(0));
    }
    assert_kept((300..330).map(|seed| on_a_log_scale(with_opacity(seed, case(seed)))));
}

#[test]
fn an_opaque_field_over_a_clear_one() {
    // Where only the opacity's field is seen at all, the colour is still that of the other one.
    let mut scene = plain(18);
    scene.view.transfer.points =
        vec![grey(0.0, 1.0, 0.0), grey(0.5, 0.25, 0.0), grey(0.5, 0.25, 1.0), grey(1.0, 0.0, 1.0)];
    assert_alike([scene.clone()]);
    scene.view.transfer.points = plain_view(1, 1).transfer.points;
    assert_alike([scene]);
}
