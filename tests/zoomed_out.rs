//! Particles far below a pixel: the sub-pixel floor keeps each of them in the picture, wherever
//! between the samples it lies.

use glam::DVec3;
use reference::Particle;
use reference::device::{assert_alike, picture};
use reference::picture;
use reference::random::Random;
use reference::scenes::{self, Scene, plain_view};
use reference::setup::Setup;

/// Steps that the camera moves to the right, a tenth of a pixel each.
const STEPS: u32 = 10;

/// The scene, seen from `share` of a pixel (at the depth of the target) further right and half that
/// further up.
fn shifted(scene: &Scene, share: f64) -> Scene {
    let setup = Setup::new(&scene.view);
    let mut moved = scene.clone();
    let camera = moved.view.camera.as_mut().expect("scenes have a camera");
    let depth = (camera.target - camera.eye).length();
    let way = share * setup.camera.pixel_size(depth) * (setup.camera.right + 0.5 * setup.camera.up);
    camera.eye += way;
    camera.target += way;
    moved.name += &format!(", {share} pixels to the right");
    moved
}

/// Seen from a hundred times as far, with planes that keep the distance to the run.
fn zoomed_out(mut scene: Scene) -> Scene {
    let camera = scene.view.camera.as_mut().expect("scenes have a camera");
    camera.eye *= 100.0;
    let distance = (camera.eye - camera.target).length();
    (camera.near, camera.far) = (Some(distance - 3.0), Some(distance + 3.0));
    scene.name += ", a hundred times as far";
    scene
}

/// A block of 40 × 30 × 6 particles on a lattice, four of them to a pixel across, each with a
/// hundredth of a pixel as its radius.
fn fine_block() -> Scene {
    let mut scene = Scene { name: "fine block".to_owned(), particles: Vec::new(), view: plain_view(16, 12) };
    let pixel = Setup::new(&scene.view).camera.pixel_size(4.0);
    for (x, y, z) in (0..40).flat_map(|x| (0..30).flat_map(move |y| (0..6).map(move |z| (x, y, z)))) {
        let index = DVec3::new(f64::from(x) - 19.5, f64::from(y) - 14.5, f64::from(z) - 2.5);
        scene.particles.push(Particle {
            position: 0.25 * pixel * index,
            support_radius: 0.01 * pixel,
            volume: 1.0,
            quantity: f64::from(x) / 39.0,
            opacity: 0.0,
        });
    }
    scene
}

#[test]
fn a_run_smaller_than_a_pixel_stays_visible() {
    let far = zoomed_out(scenes::plain(50, 9, 7));
    for step in 0..=STEPS {
        let scene = shifted(&far, f64::from(step) / f64::from(STEPS));
        let image = picture(&scene);
        assert!(image.pixels.iter().any(|pixel| pixel[3] > 0.0), "{} cannot be seen", scene.name);
        assert_alike([scene]);
    }
}

#[test]
fn a_block_of_fine_particles_has_no_holes() {
    let block = fine_block();
    let plain = picture::render(&Setup::new(&block.view), &block.particles);
    let inside = |x: u32, y: u32| (4..12).contains(&x) && (3..9).contains(&y);
    let covered = |alpha: f64, i: usize| !inside(i as u32 % 16, i as u32 / 16) || alpha > 0.0;
    assert!(
        !plain.pixels.iter().enumerate().all(|(i, pixel)| covered(pixel[3], i)),
        "without its floor the block has holes, or this test proves nothing"
    );
    for step in 0..=STEPS {
        let scene = shifted(&block, f64::from(step) / f64::from(STEPS));
        let image = picture(&scene);
        for (i, pixel) in image.pixels.iter().enumerate() {
            assert!(covered(f64::from(pixel[3]), i), "{}: a hole at pixel {i}", scene.name);
        }
    }
    assert_alike([block]);
}

#[test]
fn lone_motes_never_vanish() {
    let mut random = Random::new(51);
    for _ in 0..20 {
        let mote = Particle {
            position: random.in_cube(),
            support_radius: random.log_between(1e-12, 1e-3),
            volume: 1.0,
            quantity: 0.5,
            opacity: 0.0,
        };
        let mut scene = Scene { name: "mote".to_owned(), particles: vec![mote], view: plain_view(16, 12) };
        scene.view.transfer.reference_length = Some(0.01);
        for step in 0..STEPS {
            let scene = shifted(&scene, f64::from(step) / f64::from(STEPS));
            let image = picture(&scene);
            assert!(image.pixels.iter().any(|pixel| pixel[3] > 0.0), "{} of {mote:?} vanishes", scene.name);
        }
    }
}

#[test]
fn motes_of_no_size_at_all_never_vanish() {
    let mote = Particle {
        position: DVec3::new(0.01, 0.02, 0.03),
        support_radius: 1e-16,
        volume: 1.0,
        quantity: 0.4,
        opacity: 0.0,
    };
    let view = plain_view(16, 12);
    assert_alike([Scene { name: "mote of 1e-16".to_owned(), particles: vec![mote], view }]);
}

#[test]
fn dust_matches_the_twin() {
    let dust = (60..66).map(|seed| {
        scenes::random(seed, scenes::Shape::Dust, [33, 21], renderer::Kernel::ALL[seed as usize % 3])
    });
    assert_alike(dust.chain([zoomed_out(scenes::plain(52, 33, 21)), fine_block()]));
}
