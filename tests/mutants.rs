//! The comparison between renderer and twin would notice: each twin that is wrong on purpose has a
//! picture that is not like the right one.

use glam::DVec3;
use reference::Particle;
use reference::compare::compare;
use reference::kernels::Kernel;
use reference::picture::{render, render_with_floor};
use reference::quantity::Range;
use reference::scenes::{self, Scene, Shape};
use reference::setup::Setup;
use reference::slices::Slices;
use reference::transfer::Transfer;

/// Fails where the picture that `mutate` makes is like the right one.
fn assert_noticed(what: &str, mutate: impl Fn(&mut Setup, &mut Vec<Particle>)) {
    let Scene { view, mut particles, .. } = scenes::plain(7, 33, 21);
    let mut setup = Setup::new(&view);
    let right = render(&setup, &particles);
    mutate(&mut setup, &mut particles);
    let comparison = compare(&right, &render(&setup, &particles));
    assert!(!comparison.is_alike(), "{what} goes unnoticed: {comparison}");
}

#[test]
fn the_scene_of_the_mutants_is_a_telling_one() {
    let Scene { view, particles, .. } = scenes::plain(7, 33, 21);
    let image = render(&Setup::new(&view), &particles);
    let share = |holds: &dyn Fn(&[f64; 4]) -> bool| {
        image.pixels.iter().filter(|pixel| holds(pixel)).count() as f64 / image.pixels.len() as f64
    };
    assert!(share(&|pixel| pixel[3] > 0.1) > 0.3 && share(&|pixel| pixel[3] < 0.9) > 0.3);
    assert!(compare(&image, &render(&Setup::new(&view), &particles)).is_alike());
}

#[test]
fn wrong_weights_are_noticed() {
    assert_noticed("the cubic kernel", |setup, _| setup.kernel = Kernel::Cubic);
    assert_noticed("Wendland's kernel", |setup, _| setup.kernel = Kernel::WendlandC2);
    assert_noticed("ignoring volumes", |_, particles| particles.iter_mut().for_each(|p| p.volume = 1.0));
    assert_noticed("a support 1 % too small", |_, particles| {
        particles.iter_mut().for_each(|p| p.support_radius *= 0.99);
    });
}

#[test]
fn wrong_samples_are_noticed() {
    assert_noticed("samples at the slab's front", |setup, _| setup.place_in_slab = 0.0);
    assert_noticed("samples at the slab's back", |setup, _| setup.place_in_slab = 1.0);
    assert_noticed("one layer more", |setup, _| setup.slices.count += 16);
    assert_noticed("slices that begin 1 % behind near", |setup, _| {
        let near = setup.camera.near;
        setup.slices = Slices { near: near * 1.01, ..setup.slices };
    });
}

#[test]
fn wrong_rays_are_noticed() {
    assert_noticed("a tenth of a pixel to the right", |setup, _| {
        let camera = &mut setup.camera;
        let pixel = 2.0 * camera.tan_half_fov / f64::from(camera.height);
        camera.forward += 0.1 * pixel * camera.right;
    });
    assert_noticed("an image upside down", |setup, _| setup.camera.up = -setup.camera.up);
    assert_noticed("an image mirrored", |setup, _| setup.camera.right = -setup.camera.right);
    assert_noticed("a field of view 1 % too wide", |setup, _| setup.camera.tan_half_fov *= 1.01);
    assert_noticed("an eye a hundredth of a radius off", |setup, particles| {
        setup.camera.eye += 0.01 * particles[0].support_radius * DVec3::ONE;
    });
}

#[test]
fn wrong_optics_are_noticed() {
    assert_noticed("a reference length 1 % off", |setup, _| setup.reference_length *= 1.01);
    assert_noticed("a range 1 % too wide", |setup, _| {
        let Range { min, max, .. } = setup.range;
        setup.range.max = max + 0.01 * (max - min);
    });
    assert_noticed("points in place of the line between them", |setup, _| {
        let points = scenes::plain(7, 33, 21).view.transfer.points;
        let steps: Vec<_> = points
            .windows(2)
            .flat_map(|pair| [pair[0], renderer::ControlPoint { u: pair[1].u, ..pair[0] }])
            .chain(points.last().copied())
            .collect();
        setup.transfer = Transfer::new(&steps);
    });
}

#[test]
fn a_missing_or_wrong_particle_is_noticed() {
    assert_noticed("one particle left out", |_, particles| {
        particles.remove(particles.len() / 2);
    });
    assert_noticed("one quantity changed", |setup, particles| {
        let middle = particles.len() / 2;
        let Range { min, max, .. } = setup.range;
        particles[middle].quantity += 0.25 * (max - min);
    });
    assert_noticed("particles in another order than quantities", |_, particles| {
        let first = particles[0].quantity;
        for i in 1..particles.len() {
            particles[i - 1].quantity = particles[i].quantity;
        }
        particles.last_mut().expect("the lattice has particles").quantity = first;
    });
}

#[test]
fn a_missing_floor_is_noticed() {
    let Scene { view, particles, name } = scenes::random(8, Shape::Dust, [33, 21], renderer::Kernel::Poly6);
    let setup = Setup::new(&view);
    let comparison = compare(&render_with_floor(&setup, &particles), &render(&setup, &particles));
    assert!(!comparison.is_alike(), "{name} without its floor goes unnoticed: {comparison}");
}
