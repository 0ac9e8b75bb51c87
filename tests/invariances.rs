//! What may not change a picture (contract, section 6): place and unit of the run, the order of its
//! particles, and rendering it again. No channel may change by more than 10⁻⁴.

use glam::DVec3;
use reference::compare::compare;
use reference::device::{assert_alike, open, picture, prepare, render};
use reference::picture::Image;
use reference::random::Random;
use reference::scenes::{self, Scene, Shape, grey};
use renderer::{ControlPoint, GpuOptions, Kernel, OpacityView, Scale};

/// Largest change of any channel.
const LIMIT: f64 = 1e-4;

/// Scenes without steps or spikes in the transfer function, of which a rounding error could make
/// something visible; all of one unit and near the origin.
fn smooth_scenes() -> Vec<Scene> {
    let wide = |seed| scenes::plain(seed, 33, 21);
    let mut inside = wide(12);
    let camera = inside.view.camera.as_mut().expect("plain scenes have a camera");
    (camera.eye, camera.target) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(-1.0, 0.5, -0.2));
    (camera.near, camera.far, camera.fov_y_degrees) = (Some(0.05), Some(2.5), 75.0);
    inside.name += " from inside";

    let mut mixed = scenes::random(13, Shape::MixedRadii, [24, 17], Kernel::WendlandC2);
    mixed.view.transfer.points = wide(0).view.transfer.points;
    mixed.name += " smooth";

    let mut cubic = wide(11);
    cubic.view.particles.kernel = Kernel::Cubic;
    vec![wide(10), cubic, inside, mixed]
}

/// A scene whose quantity is constant and lies exactly at a step of the transfer function: a
/// rounding error of Q would turn samples from red to blue.
fn constant_at_a_step(u: f32) -> Scene {
    let mut scene = scenes::plain(14, 33, 21);
    scene.name = format!("constant at a step at {u}");
    scene.particles.iter_mut().for_each(|particle| particle.quantity = f64::from(u));
    let point = |u, rgb, opacity| ControlPoint { u, rgb, opacity };
    scene.view.transfer.points = vec![
        point(0.0, [0.0, 0.0, 1.0], 0.05),
        point(u, [0.0, 0.0, 1.0], 0.05),
        point(u, [1.0, 0.0, 0.0], 0.6),
        point(1.0, [1.0, 0.0, 0.0], 0.6),
    ];
    scene
}

fn all_scenes() -> Vec<Scene> {
    let mut scenes = smooth_scenes();
    // On and off the multiples of a power of two at which a table of the function may have its entries.
    scenes.extend([0.375, 0.370_117_2, 0.1].map(constant_at_a_step));
    scenes
}

fn assert_unchanged(what: &str, before: &Image<f32>, after: &Image<f32>) {
    let comparison = compare(before, after);
    assert!(comparison.max <= LIMIT, "{what}: {comparison}");
}

/// The scene in another unit, then elsewhere.
fn transformed(scene: &Scene, unit: f64, origin: DVec3) -> Scene {
    let mut moved = scene.clone();
    scenes::transform(&mut moved.particles, &mut moved.view, unit, origin);
    moved
}

#[test]
fn the_scenes_match_the_twin() {
    assert_alike(all_scenes());
}

#[test]
fn rendering_twice() {
    for scene in all_scenes() {
        assert_unchanged(&scene.name, &picture(&scene), &picture(&scene));
    }
}

#[test]
fn rendering_again_after_another_scene() {
    let [first, second] = [scenes::plain(15, 33, 21), scenes::plain(16, 20, 40)];
    let before = picture(&first);
    picture(&second);
    assert_unchanged(&first.name, &before, &picture(&first));
}

#[test]
fn the_order_of_the_particles() {
    let mut random = Random::new(17);
    for scene in all_scenes() {
        let before = picture(&scene);
        let mut shuffled = scene.clone();
        random.shuffle(&mut shuffled.particles);
        assert_unchanged(&scene.name, &before, &picture(&shuffled));
        shuffled.particles.reverse();
        assert_unchanged(&scene.name, &before, &picture(&shuffled));
    }
}

/// On a logarithmic scale, small values of both fields on one side and large ones on the other.
fn over_decades(decades: i32) -> Scene {
    let mut scene = scenes::plain(20, 33, 21);
    let least = 10.0_f64.powi(-decades);
    for particle in &mut scene.particles {
        let small = particle.position.x < 0.0;
        particle.quantity = if small { least * (3.0 + particle.position.y) } else { 1.0 };
        particle.opacity = if small { least * (3.0 - particle.position.y) } else { 1.0 };
    }
    scene.name += &format!(" over {decades} decades");
    (scene.view.quantity.range, scene.view.quantity.scale) = (Some([least, 1.0]), Scale::Log);
    scene.view.sampling.tolerance = None;
    scene
}

/// The left becomes the right.
fn mirrored(scene: &Scene) -> Scene {
    let mut mirrored = scene.clone();
    mirrored.particles.iter_mut().for_each(|particle| particle.position.x *= -1.0);
    mirrored
}

fn mirror_image(image: &Image<f32>) -> Image<f32> {
    let mut mirrored = image.clone();
    mirrored.pixels.chunks_mut(image.width as usize).for_each(<[_]>::reverse);
    mirrored
}

#[test]
fn the_order_of_the_particles_on_a_logarithmic_scale() {
    let mut random = Random::new(21);
    for scene in [6, 7, 8].map(over_decades) {
        let mut two_fields = scene.clone();
        two_fields.view.quantity.opacity = Some(OpacityView {
            range: scene.view.quantity.range,
            scale: Scale::Log,
            ..OpacityView::default()
        });
        for scene in [scene, two_fields] {
            let before = picture(&scene);
            let mut shuffled = scene.clone();
            random.shuffle(&mut shuffled.particles);
            assert_unchanged(&scene.name, &before, &picture(&shuffled));
            assert_unchanged(&scene.name, &before, &mirror_image(&picture(&mirrored(&scene))));
        }
    }
}

#[test]
fn sums_relative_to_large_values_are_noticed() {
    let from = "(frame.logarithmic & 1u) != 0u".to_owned();
    let shader_edits = vec![(from, "false".to_owned())];
    let mut renderer = open(&GpuOptions { shader_edits, ..GpuOptions::default() });
    let scene = over_decades(7);
    let [before, after] =
        [scene.clone(), mirrored(&scene)].map(|scene| Image::from(&render(&mut renderer, &prepare(&scene))));
    let comparison = compare(&before, &mirror_image(&after));
    assert!(comparison.max > LIMIT, "{comparison}");
}

#[test]
fn a_shift_of_run_and_camera() {
    for scene in all_scenes() {
        let before = picture(&scene);
        let h = scene.particles[0].support_radius;
        for direction in [DVec3::X, DVec3::new(-0.6, 0.0, 0.8), DVec3::new(1.0, 1.0, -1.0)] {
            let moved = transformed(&scene, 1.0, 1e7 * h * direction);
            assert_unchanged(&format!("{} along {direction}", scene.name), &before, &picture(&moved));
        }
    }
}

#[test]
fn the_unit_of_length() {
    for scene in all_scenes() {
        let before = picture(&scene);
        for unit in [1e-12, 1e-3, 1e12] {
            let scaled = transformed(&scene, unit, DVec3::ZERO);
            assert_unchanged(&format!("{} in units of {unit:e}", scene.name), &before, &picture(&scaled));
        }
    }
}

#[test]
fn the_unit_of_volume_and_of_the_quantity() {
    for scene in all_scenes() {
        let before = picture(&scene);
        for unit in [1e-30, 1e30] {
            let mut scaled = scene.clone();
            for particle in &mut scaled.particles {
                particle.volume *= unit;
                particle.quantity *= unit;
            }
            scaled.view.quantity.range = scaled.view.quantity.range.map(|range| range.map(|q| q * unit));
            assert_unchanged(&format!("{} in units of {unit:e}", scene.name), &before, &picture(&scaled));
        }
    }
}

#[test]
fn particles_far_outside_the_picture() {
    let scene = scenes::plain(18, 33, 21);
    let before = picture(&scene);
    for distance in [10.0, 1e4, 1e7] {
        let mut crowded = scene.clone();
        let directions = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z];
        for (i, direction) in directions.into_iter().enumerate() {
            let mut stray = scene.particles[i];
            // Uneven, so that the middle of all particles is far away as well.
            stray.position = distance * (1.0 + 0.3 * i as f64) * direction;
            crowded.particles.insert(100 * i, stray);
        }
        assert_unchanged(&format!("strays {distance} away"), &before, &picture(&crowded));
    }
}

#[test]
fn what_an_opaque_front_hides() {
    let mut scene = scenes::plain(19, 33, 21);
    scene.view.transfer.points = vec![grey(0.0, 0.2, 1.0), grey(1.0, 0.9, 1.0)];
    let before = picture(&scene);
    scene.particles.retain(|particle| particle.position.z > -0.3);
    assert_unchanged("without what the front hides", &before, &picture(&scene));
}

#[test]
fn a_visible_change_is_noticed() {
    let scene = scenes::plain(10, 33, 21);
    let before = reference::picture::render(&reference::setup::Setup::new(&scene.view), &scene.particles);
    for moved in [
        // The run moves, its camera stays.
        {
            let mut moved = scene.clone();
            moved.particles.iter_mut().for_each(|particle| particle.position.x += 1e-3);
            moved
        },
        // All lengths but one.
        {
            let mut moved = transformed(&scene, 1e3, DVec3::ZERO);
            moved.view.transfer.reference_length = scene.view.transfer.reference_length.map(|l| l * 1001.0);
            moved
        },
    ] {
        let after = reference::picture::render(&reference::setup::Setup::new(&moved.view), &moved.particles);
        let comparison = compare(&before, &after);
        assert!(comparison.max > LIMIT, "{comparison}");
    }
}
