//! An opacity that is read at ratios of its field: pictures are those of the f64 twin, adaptive ones keep their
//! tolerance, and both would be noticed if they were not so.

use reference::compare::compare;
use reference::device::picture;
use reference::guarantee::{case, hard_cases, with_opacity};
use reference::picture::{Image, render_with_floor};
use reference::random::Random;
use reference::scenes::{Scene, grey};
use reference::setup::Setup;
use renderer::Scale;

use super::{assert_kept, by_range, on_a_log_scale, plain, random_scenes, swapped};

/// `scene`, whose opacity has a range, with one over some decades in its place, of which those at both ends
/// are out of range.
pub fn log_opacity(mut scene: Scene) -> Scene {
    let opacity = scene.view.quantity.opacity.as_mut().expect("a field for the opacity");
    let [low, high] = opacity.range.expect("the opacity has a range");
    let (decades, unit) = (3.0, high.abs());
    for particle in &mut scene.particles {
        let share = (particle.opacity - low) / (high - low);
        particle.opacity = unit * 10.0_f64.powf(decades * share);
    }
    let ends = [0.1, 0.9].map(|share| unit * 10.0_f64.powf(decades * share));
    (opacity.range, opacity.scale) = (Some(ends), Scale::Log);
    scene.name += ", opacity at ratios";
    scene
}

/// Cases of the guarantee, one in three with colours on a logarithmic scale, too.
pub fn cases(seeds: std::ops::Range<u64>) -> impl Iterator<Item = Scene> {
    seeds.map(|seed| {
        let scene = log_opacity(with_opacity(seed, case(seed)));
        if seed % 3 == 0 { on_a_log_scale(scene) } else { scene }
    })
}

/// Quantities at the steps of the transfer function, each of the two fields in its turn.
pub fn hard() -> impl Iterator<Item = Scene> {
    hard_cases().into_iter().zip(0..).flat_map(|(scene, seed)| {
        let other = log_opacity(with_opacity(seed, scene));
        [swapped(&other), other]
    })
}

/// Without steps: where the twin is exact and the device's function is one to a 4096th, a step may be on the
/// other side of a sample.
fn smooth(mut scene: Scene) -> Scene {
    scene.view.transfer.points =
        vec![grey(0.0, 0.1, 0.002), grey(0.3, 0.9, 0.1), grey(0.6, 0.2, 0.02), grey(1.0, 0.8, 0.7)];
    scene
}

/// Whether `image` is the twin's but for what the device's function may be off: a 4096th in each channel of a
/// sample.
fn is_alike(scene: &Scene, image: &Image<f32>) -> bool {
    let twin = render_with_floor(&Setup::new(&scene.view), &scene.particles);
    let comparison = compare(&twin, image);
    println!("{}: {comparison}", scene.name);
    comparison.share_above(1e-3) <= 1e-3 && comparison.mean <= 1.0 / 4096.0
}

fn assert_alike(scenes: impl IntoIterator<Item = Scene>) {
    for scene in scenes {
        assert!(is_alike(&scene, &picture(&scene)), "{}", scene.name);
    }
}

#[test]
fn pictures_match_the_twin() {
    let scenes = || random_scenes(400..414).chain([plain(21), plain(22)]).map(log_opacity).map(smooth);
    assert_alike(scenes());
    assert_alike(scenes().map(|scene| swapped(&scene)));
}

#[test]
fn a_linear_scale_in_its_place_is_noticed() {
    let scene = smooth(log_opacity(plain(23)));
    let image = picture(&scene);
    assert!(is_alike(&scene, &image));
    let mut linear = scene.clone();
    linear.view.quantity.opacity.as_mut().expect("a field for the opacity").scale = Scale::Linear;
    let mut wider = scene.clone();
    let opacity = wider.view.quantity.opacity.as_mut().expect("a field for the opacity");
    opacity.range = opacity.range.map(|[low, high]| [0.9 * low, high]);
    for wrong in [linear, wider] {
        assert!(!is_alike(&wrong, &image), "{:?}", wrong.view.quantity.opacity);
    }
}

#[test]
fn what_is_not_positive_is_as_opaque_as_the_low_end() {
    let mut random = Random::new(24);
    let mut scene = smooth(log_opacity(plain(24)));
    let low = scene.view.quantity.opacity.as_ref().and_then(|opacity| opacity.range).expect("a range")[0];
    scene.particles.iter_mut().for_each(|particle| {
        if random.unit() < 0.4 {
            particle.opacity = random.pick(&[0.0, -1.0, -100.0]) * low;
        }
    });
    assert_alike([scene.clone()]);
    scene.view.sampling.tolerance = Some(0.01);
    assert_kept([scene.clone()]);
    // Where all is below the range, by how much makes no difference.
    scene.particles.iter_mut().for_each(|particle| particle.opacity = particle.opacity.min(0.5 * low));
    let below = picture(&scene);
    scene.particles.iter_mut().for_each(|particle| particle.opacity = low);
    let comparison = compare(&below, &picture(&scene));
    assert!(comparison.max < 1e-5, "{comparison}");
}

#[test]
fn another_unit_changes_nothing() {
    let scene = smooth(log_opacity(plain(25)));
    let before = picture(&scene);
    for factor in [1e-25, 1e25] {
        let mut scaled = scene.clone();
        scaled.particles.iter_mut().for_each(|particle| particle.opacity *= factor);
        let opacity = scaled.view.quantity.opacity.as_mut().expect("a field for the opacity");
        opacity.range = opacity.range.map(|range| range.map(|q| q * factor));
        let comparison = compare(&before, &picture(&scaled));
        assert!(comparison.max <= 1e-4, "{factor}: {comparison}");
    }
}

#[test]
fn the_tolerance_is_kept_by_random_cases() {
    let trials = assert_kept(cases(500..570));
    let count = trials.iter().filter(|trial| trial.share() < 0.7).count();
    assert!(count >= 8, "{count} of {} take fewer evaluations", trials.len());
}

#[test]
fn the_tolerance_is_kept_at_jumps_of_the_transfer_function() {
    assert_kept(hard());
}

#[test]
fn a_threshold_has_no_scale() {
    let mut scene = log_opacity(plain(26));
    let [low, high] =
        scene.view.quantity.opacity.as_ref().and_then(|opacity| opacity.range).expect("a range");
    let middle = (low * high).sqrt();
    let opacity = scene.view.quantity.opacity.as_mut().expect("a field for the opacity");
    opacity.range = Some([middle; 2]);
    let log = picture(&scene);
    scene.view.quantity.opacity = Some(by_range([middle; 2]));
    assert!(log.pixels == picture(&scene).pixels);
}
