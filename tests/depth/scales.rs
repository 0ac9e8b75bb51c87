//! Depths of runs of any size, in any place, from near and from far away.

use glam::DVec3;
use reference::Particle;
use reference::depth::{mean, of_pixels};
use reference::device::open;
use reference::picture::raised;
use reference::scenes::{self, Scene, grey, transform};
use reference::setup::Setup;
use renderer::GpuOptions;

use super::{depths, depths_by};

#[test]
fn unit_and_place_of_a_run_are_those_of_its_depths() {
    let scene = scenes::plain(12, 33, 21);
    let h = scene.particles[0].support_radius;
    let before = depths(&scene);
    let far_away = 1e7 * h * DVec3::new(1.0, -0.5, 0.25);
    for (unit, origin) in [(1e-12, DVec3::ZERO), (1e12, DVec3::ZERO), (1.0, far_away)] {
        let mut moved = scene.clone();
        transform(&mut moved.particles, &mut moved.view, unit, origin);
        for (place, (a, b)) in before.iter().zip(depths(&moved)).enumerate() {
            let (a, b) = (f64::from(*a), f64::from(b) / unit);
            let same = a == b || (b / a - 1.0).abs() <= 1e-5;
            assert!(same, "in units of {unit} at {origin}: pixel {place} is {b}, not {a}");
        }
    }
}

/// A cloud right in front of the eye, which hides all but a few millionths of what lies a thousand times
/// farther away.
fn near_and_far() -> Scene {
    let mut scene = scenes::plain(4, 16, 8);
    let camera = scene.view.camera.as_mut().expect("plain scenes have a camera");
    (camera.eye, camera.target, camera.fov_y_degrees) = (DVec3::ZERO, DVec3::NEG_Z, 20.0);
    (camera.near, camera.far) = (Some(0.005), Some(40.0));
    scene.view.transfer.points = vec![grey(0.0, 1.0, 0.9)];
    scene.view.transfer.reference_length = Some(0.014);
    let ball = |depth: f64, support_radius: f64| Particle {
        position: depth * DVec3::NEG_Z,
        support_radius,
        ..scene.particles[0]
    };
    scene.particles = vec![ball(0.05, 0.04), ball(32.0, 8.0)];
    scene
}

#[test]
fn what_shines_through_from_afar_counts() {
    let scene = near_and_far();
    let setup = Setup::new(&scene.view);
    let twin = of_pixels(&setup, &scene.particles, mean);
    // As many times what rounding may do: a millionth of the depth, and the last digits of what light passes
    // the cloud, times far.
    let off = |found: &[f32]| {
        let share = |(expected, &depth): (&f64, &f32)| {
            (f64::from(depth) - expected).abs() / (1e-6 * expected + 3e-7 * setup.camera.far)
        };
        twin.iter().zip(found).map(share).fold(0.0, f64::max)
    };
    let mut early = open(&GpuOptions {
        shader_edits: vec![(
            "ray.transparency * frame.far > REST * so_far".to_owned(),
            "ray.transparency > OPAQUE".to_owned(),
        )],
        ..GpuOptions::default()
    });
    let (right, early) = (off(&depths(&scene)), off(&depths_by(&mut early, &scene)));
    println!("{right:.2} of the rounding, {early:.1} where rays end as those of colours do");
    assert!(right <= 1.0 && early > 2.0, "{right:.2} and {early:.2}");
}

#[test]
fn a_long_lens_keeps_the_depth_inside_the_run() {
    let mut scene = scenes::plain(10, 33, 21);
    let camera = scene.view.camera.as_mut().expect("plain scenes have a camera");
    camera.eye = DVec3::new(0.0, 0.0, 4e4);
    (camera.near, camera.far, camera.fov_y_degrees) = (Some(4e4 - 3.0), Some(4e4 + 3.0), 0.004);
    let setup = Setup::new(&scene.view);
    let twin = of_pixels(&setup, &raised(&setup, &scene.particles), mean);
    // Half of the last digit of the depth itself, and a little of that of the run.
    let most = 0.5 * f64::from(4e4_f32.next_up() - 4e4_f32) + 1e-5;
    let mut seen = 0;
    for (depth, expected) in depths(&scene).into_iter().zip(twin).filter(|(_, z)| z.is_finite()) {
        assert!((f64::from(depth) - expected).abs() <= most, "{depth}, not {expected}");
        seen += 1;
    }
    assert!(seen > 300, "{seen} pixels");
}
