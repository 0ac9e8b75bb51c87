//! Scenes at the edge of what makes sense: their pictures are finite, in [0, 1], and those of the twin.

use glam::DVec3;
use reference::Particle;
use reference::compare::compare;
use reference::device::{assert_alike, picture, prepare, render, shared};
use reference::extremes;
use reference::picture::Image;
use reference::random::Random;
use reference::scenes::{self, Scene, grey, plain_view};

const SIZE: [u32; 2] = [33, 21];

/// A scene of `particles` in [`plain_view`].
fn scene(name: &str, particles: Vec<Particle>) -> Scene {
    Scene { name: name.to_owned(), particles, view: plain_view(SIZE[0], SIZE[1]) }
}

fn particle(position: DVec3, support_radius: f64, quantity: f64) -> Particle {
    Particle { position, support_radius, volume: 1.0, quantity, opacity: 0.0 }
}

fn assert_empty(scene: &Scene) {
    assert!(picture(scene).pixels.iter().all(|pixel| *pixel == [0.0; 4]), "{} is not empty", scene.name);
}

#[test]
fn no_particles() {
    let nothing = scene("nothing", Vec::new());
    assert_empty(&nothing);
    // With everything left open there is nothing to fit a camera to.
    let mut open = nothing;
    open.view.camera = None;
    open.view.quantity.range = None;
    open.view.transfer.reference_length = None;
    assert_empty(&open);
}

#[test]
fn one_particle() {
    for h in [1e-6, 0.02, 0.3, 0.9] {
        let alone = scene(&format!("alone, h = {h}"), vec![particle(DVec3::new(0.01, 0.02, 0.03), h, 0.4)]);
        assert_alike([alone]);
    }
}

#[test]
fn one_particle_with_everything_left_open() {
    let mut alone = scene("alone", vec![particle(DVec3::new(5.0, 6.0, 7.0), 0.5, 3.25)]);
    alone.view.camera = None;
    alone.view.quantity.range = None;
    alone.view.transfer.reference_length = None;
    let image = picture(&alone);
    let middle = image.pixels[10 * 33 + 16];
    assert!(middle[3] > 0.0, "the only particle is in the middle of its picture, which is {middle:?}");
}

#[test]
fn all_at_one_point() {
    let mut random = Random::new(31);
    let heap = |h: &dyn Fn(&mut Random) -> f64, random: &mut Random| -> Vec<Particle> {
        (0..1000).map(|_| particle(DVec3::new(0.25, 0.5, -0.75), h(random), random.unit())).collect()
    };
    let same = heap(&|_| 0.4, &mut random);
    let nested = heap(&|random| random.between(0.1, 0.8), &mut random);
    assert_alike([scene("1000 at one point", same), scene("1000 nested", nested)]);
}

#[test]
fn all_at_the_eye() {
    let eye = DVec3::new(0.0, 0.0, 4.0);
    let around = (0..50).map(|i| particle(eye, 0.05 * f64::from(i + 1), 0.02 * f64::from(i))).collect();
    let mut clipped = scene("around the eye, beyond near", around);
    assert_alike([clipped.clone()]);
    clipped.name = "around the eye, before near".to_owned();
    clipped.particles.iter_mut().for_each(|particle| particle.support_radius *= 0.3);
    assert_empty(&clipped);
}

#[test]
fn behind_the_camera() {
    let mut behind = scenes::plain(32, 33, 21);
    behind.particles.iter_mut().for_each(|particle| particle.position.z += 6.0);
    assert_empty(&behind);
    // Centres behind the eye, supports before it.
    behind.particles.iter_mut().for_each(|particle| particle.support_radius = 3.0);
    behind.particles.truncate(60);
    assert_alike([behind]);
}

#[test]
fn a_particle_that_covers_the_screen() {
    let cover = particle(DVec3::new(0.3, -0.2, 0.1), 2.9, 0.9);
    let mut small = scenes::plain(33, 33, 21);
    small.particles.truncate(200);
    small.particles.push(cover);
    small.name = "one giant and 200 of the usual size".to_owned();
    let huge = particle(DVec3::ZERO, 1e6, 0.2);
    assert_alike([scene("giant", vec![cover]), scene("a million times the scene", vec![huge, cover]), small]);
}

#[test]
fn radii_over_six_decades() {
    let mut random = Random::new(34);
    let mut particles: Vec<Particle> =
        (0..400).map(|_| particle(random.in_cube(), random.log_between(1e-6, 1.0), random.unit())).collect();
    // Volumes as of a fluid, in which all weights at a centre are alike.
    let equal = scene("equal volumes", particles.clone());
    particles.iter_mut().for_each(|particle| particle.volume = particle.support_radius.powi(3));
    assert_alike([equal, scene("volumes that go with the radii", particles)]);
}

/// The plain scene behind `count` clear particles, all of whose depths are between 1.2 and 2.1.
fn veiled(count: usize, rate: f64) -> [Scene; 2] {
    let mut random = Random::new(36);
    let mut bare = extremes::with_camera("bare", SIZE, |camera| camera.fov_y_degrees = 10.0);
    (bare.view.image.width, bare.view.image.height) = (8, 8);
    bare.view.sampling.rate = rate;
    bare.view.transfer.points = vec![grey(0.0, 0.0, 0.0), grey(0.1, 0.0, 0.0), grey(1.0, 0.8, 0.6)];
    let mut veiled = bare.clone();
    veiled.name = format!("behind {count} clear particles, at rate {rate}");
    veiled.particles.extend((0..count).map(|_| {
        let across = 0.1 * random.in_cube();
        particle(DVec3::new(across.x, across.y, random.between(1.9, 2.8)), 0.1, 0.0)
    }));
    [bare, veiled]
}

/// A software adapter makes 65,535 rounds of loops for a ray and then stops without a word.
#[test]
fn more_particles_along_a_ray_than_an_adapter_has_rounds() {
    // In one cell, and in many.
    for [bare, mut veiled] in [veiled(70_000, 0.3), veiled(8_000, 32.0)] {
        let bare = picture(&bare);
        assert!(bare.pixels.iter().any(|pixel| pixel[3] > 0.3), "something lies behind the veil");
        for tolerance in [None, Some(1e-3)] {
            veiled.view.sampling.tolerance = tolerance;
            let comparison = compare(&bare, &picture(&veiled));
            let limit = tolerance.unwrap_or(1e-5);
            assert!(comparison.max <= limit, "{}, tolerance {tolerance:?}: {comparison}", veiled.name);
        }
    }
}

/// Where all are at one place, the quantity is their mean: none may be left out.
#[test]
fn a_hundred_thousand_at_one_point() {
    let place = DVec3::new(0.25, 0.5, -0.75);
    let heap = (0..100_000).map(|i| particle(place, 0.4, 1e-5 * f64::from(i))).collect();
    let mut heap = scene("100,000 at one point", heap);
    let mean = picture(&scene("their mean", vec![particle(place, 0.4, 0.499_995)]));
    for tolerance in [None, Some(1e-3)] {
        heap.view.sampling.tolerance = tolerance;
        let comparison = compare(&mean, &picture(&heap));
        assert!(comparison.max <= 2e-5, "tolerance {tolerance:?}: {comparison}");
    }
}

#[test]
fn two_hundred_thousand_in_a_bundle() {
    let mut random = Random::new(43);
    let field = |x: DVec3| 0.5 + 0.5 * (2.0 * x.x + 1.5 * x.y - x.z).sin();
    let particles = (0..200_000).map(|_| random.in_cube()).map(|x| particle(x, 0.05, field(x))).collect();
    let mut crowd = Scene { name: "200,000 in 8x8 pixels".to_owned(), particles, view: plain_view(8, 8) };
    assert_alike([crowd.clone()]);
    let full = picture(&crowd);
    crowd.view.sampling.tolerance = Some(1e-2);
    let comparison = compare(&full, &picture(&crowd));
    assert!(comparison.max < 1e-2, "{comparison}");
}

#[test]
fn unsound_particles_are_left_out_and_counted() {
    let good = scenes::plain(35, 33, 21);
    let template = particle(DVec3::new(0.1, 0.1, 1.0), 0.5, 0.5);
    let bad = [
        Particle { position: DVec3::new(f64::NAN, 0.0, 0.0), ..template },
        Particle { position: DVec3::new(0.0, f64::INFINITY, 0.0), ..template },
        Particle { quantity: f64::NAN, ..template },
        Particle { quantity: f64::NEG_INFINITY, ..template },
        Particle { support_radius: f64::NAN, ..template },
        Particle { support_radius: f64::INFINITY, ..template },
        Particle { support_radius: 0.0, ..template },
        Particle { support_radius: -0.5, ..template },
    ];
    let mut mixed = good.clone();
    mixed.name = "with unsound particles".to_owned();
    for (i, particle) in bad.into_iter().enumerate() {
        mixed.particles.insert(70 * i, particle);
    }
    let picture_of_mixed = render(&mut shared(), &prepare(&mixed));
    assert_eq!(picture_of_mixed.stats.rejected.non_finite, 4);
    assert_eq!(picture_of_mixed.stats.rejected.bad_radius, 4);
    let comparison = compare(&picture(&good), &Image::from(&picture_of_mixed));
    assert!(comparison.max <= 1e-4, "they change the picture: {comparison}");
    assert_alike([mixed]);
    assert_empty(&scene("only unsound particles", bad.to_vec()));
}

#[test]
fn what_weighs_nothing_changes_nothing() {
    let mut good = scenes::plain(37, 33, 21);
    for (i, particle) in good.particles.iter_mut().enumerate() {
        particle.volume = [8.0, 1.0, 2.0][i % 3];
    }
    let template = Particle { volume: 0.0, ..particle(DVec3::new(0.1, 0.1, 1.0), 0.5, 0.9) };
    let mut mixed = good.clone();
    mixed.name = "with particles of no volume".to_owned();
    for i in 0..5 {
        mixed.particles.insert(60 * i, template);
    }
    let picture_of_mixed = render(&mut shared(), &prepare(&mixed));
    assert_eq!(picture_of_mixed.stats.rejected.total(), 0);
    assert_eq!(picture(&good).pixels, Image::from(&picture_of_mixed).pixels);
    assert_alike([mixed]);
    assert_empty(&scene("nothing but particles of no volume", vec![template; 3]));
}

#[test]
fn quantities_at_the_edge_of_their_numbers() {
    assert_alike(extremes::quantities_at_the_edge_of_their_numbers(SIZE));
}

#[test]
fn outliers_of_the_quantity_do_not_drown_their_neighbours() {
    assert_alike([extremes::with_outliers(1e12, SIZE)]);
}

#[test]
fn a_range_of_no_width_is_a_threshold() {
    let name = "range of no width in the middle of the quantity";
    assert_alike([extremes::with_quantity(name, SIZE, [0.5, 0.5], |q| q)]);
}

#[test]
fn transfer_functions_at_their_ends() {
    assert_empty(&extremes::clear(SIZE));
    assert_alike(extremes::transfer_functions_at_their_ends(SIZE));
}

#[test]
fn reference_lengths_far_from_the_scene() {
    assert_alike([1e-6, 1e6].map(|length| extremes::with_reference_length(length, SIZE)));
}

#[test]
fn depths_over_six_decades() {
    assert_alike(extremes::depths_over_six_decades(SIZE));
}

#[test]
fn fields_of_view_at_their_ends() {
    assert_alike(extremes::fields_of_view(SIZE));
}

#[test]
fn long_lenses() {
    assert_alike([30.0, 100.0, 400.0, 1e3, 1e4, 1e5].map(|far| extremes::through_a_long_lens(far, SIZE)));
}

#[test]
fn sizes_of_the_image() {
    assert_alike(extremes::sizes_of_the_image());
    // Large enough to show wrong strides; few slices keep the twin cheap.
    let mut large = scenes::plain(40, 333, 217);
    large.view.sampling.rate = 0.1;
    assert_alike([large]);
}

#[test]
fn rates_of_sampling() {
    assert_alike([0.01, 0.3, 2.0, 8.0].map(|rate| extremes::at_rate(rate, [20, 13])));
}

#[test]
fn a_slanted_or_long_up_vector() {
    assert_alike([
        extremes::with_camera("slanted up", SIZE, |camera| camera.up = DVec3::new(0.9, 0.1, 5.0)),
        extremes::with_camera("long up", SIZE, |camera| camera.up = DVec3::new(0.0, -1e9, 0.0)),
        extremes::with_camera("nearby target", SIZE, |camera| {
            camera.target = camera.eye + 1e-9 * DVec3::NEG_Z
        }),
    ]);
}
