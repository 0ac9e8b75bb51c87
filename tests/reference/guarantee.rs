//! The guarantee of adaptive sampling: random cases for it, and whether it was kept.

use renderer::{BrickWidth, CameraView, ControlPoint, Kernel, OpacityView, Picture, Renderer, Without};

use crate::compare::{Comparison, compare};
use crate::device::{prepare, render};
use crate::particle::Particle;
use crate::picture::Image;
use crate::random::Random;
use crate::scenes::{self, Scene, Shape, grey};
use crate::setup::Setup;

/// Whether two adaptive pictures of the same scene are alike. The order of sums is not the same in
/// every grid, and a rounding error may decide whether a brick is sampled: such a pixel is as near to
/// full sampling as before, but may change by the tolerance. There are few of them.
pub fn alike_but_for_decisions(comparison: &Comparison, tolerance: f64) -> bool {
    comparison.share_above(1e-4) <= 2e-3 && comparison.max < (2.0 * tolerance).max(1e-4)
}

/// What single precision and the early end of rays may add to the predicted error (`ROUNDING` of the
/// renderer's `sampling.rs`).
pub const ROUNDING: f64 = 3e-5;

/// Samples of a case's picture, at most: the rate of sampling is lowered to keep them.
const MOST_SAMPLES: f64 = 6e6;

/// The case of `seed`: a random scene with a tolerance, of any shape, kernel and size.
pub fn case(seed: u64) -> Scene {
    let mut random = Random::new(!seed);
    let (shape, kernel) = (random.pick(&Shape::ALL), random.pick(&Kernel::ALL));
    let size = [40 + random.below(61) as u32, 40 + random.below(61) as u32];
    let mut scene = scenes::random(seed, shape, size, kernel);
    if random.unit() < 0.5 {
        smooth(&mut scene, &mut random);
    }
    if random.unit() < 0.2 {
        roughen(&mut scene, &mut random);
    }
    if let Some(points) = transfer(&mut random) {
        scene.view.transfer.points = points;
    }
    let tolerance = tolerance(&mut random);
    scene.view.sampling.tolerance = Some(tolerance);
    scene.view.sampling.relaxation = 0.0;
    limit_samples(&mut scene);
    let rays = set_width(&mut scene, seed);
    scene.name = format!("seed {seed}, {}, bricks of {rays}, tolerance {tolerance:.3e}", scene.name);
    scene
}

/// `scene` with another field for the opacity, which is drawn from `seed`.
pub fn with_opacity(seed: u64, mut scene: Scene) -> Scene {
    let mut random = Random::new(seed ^ 0x5eed);
    let origin = scene.particles[0].position;
    let extent =
        scene.particles.iter().map(|p| (p.position - origin).length()).fold(f64::MIN_POSITIVE, f64::max);
    let wave = random.between(0.2, 6.0) / extent * random.direction();
    let (noise, unit) = (random.pick(&[0.0, 0.0, 0.1, 1.0]), random.log_between(1e-6, 1e6));
    let constant = random.unit() < 0.1;
    for particle in &mut scene.particles {
        let slow = if constant { 0.3 } else { wave.dot(particle.position - origin).sin() };
        particle.opacity = unit * (slow + noise * random.between(-1.0, 1.0));
    }
    let cut = random.pick(&[0.0, 0.3, 0.9]);
    let range = Some([unit * (cut - 1.0), unit]);
    scene.view.quantity.opacity = Some(OpacityView { range, ..OpacityView::default() });
    scene.name += &format!(", opacity by another field, {seed}");
    scene
}

/// A lattice with a slow field and large particles, seen from so near that most of it needs no samples.
pub fn calm(seed: u64, width: u32, height: u32) -> Scene {
    let mut scene = scenes::plain(seed, width, height);
    for particle in &mut scene.particles {
        particle.quantity = 0.5 + 0.4 * (0.4 * particle.position.x + 0.3 * particle.position.y).sin();
        particle.support_radius *= 1.8;
    }
    camera_of(&mut scene).fov_y_degrees = 12.0;
    scene.view.sampling.tolerance = Some(0.01);
    set_width(&mut scene, seed);
    scene.name = format!("calm {seed} {width}x{height}");
    scene
}

/// Of its bricks, in rays: one for even seeds, the other for odd ones.
fn set_width(scene: &mut Scene, seed: u64) -> u32 {
    let width = BrickWidth::ALL[(seed % 2) as usize];
    scene.view.sampling.brick_width = width;
    width.rays()
}

/// Gives the scene a field without noise, larger particles and a longer lens: many bricks then need no
/// samples.
fn smooth(scene: &mut Scene, random: &mut Random) {
    let origin = scene.particles[0].position;
    let extent = scene.particles.iter().map(|p| (p.position - origin).length()).fold(0.0, f64::max);
    let wave = random.between(0.2, 3.0) / extent * random.direction();
    let grown = random.between(1.0, 2.5);
    for particle in &mut scene.particles {
        particle.quantity = 0.5 + 0.5 * wave.dot(particle.position - origin).sin();
        particle.support_radius *= grown;
    }
    scene.view.quantity.range = Some([0.0, 1.0]);
    camera_of(scene).fov_y_degrees /= random.between(1.0, 8.0);
}

fn camera_of(scene: &mut Scene) -> &mut CameraView {
    scene.view.camera.as_mut().expect("views of scenes have a camera")
}

/// Gives the scene one of the oddities that single precision suffers from.
fn roughen(scene: &mut Scene, random: &mut Random) {
    match random.below(4) {
        // Volumes over eight decades.
        0 => scene.particles.iter_mut().for_each(|particle| particle.volume = random.log_between(1e-4, 1e4)),
        // Quantities far beyond the range.
        1 => {
            let far = random.log_between(1e1, 1e9);
            for particle in scene.particles.iter_mut().step_by(7) {
                particle.quantity *= far * random.between(-1.0, 1.0);
            }
        }
        // Almost no opacity, or almost nothing else.
        2 => {
            let factor = random.pick(&[1e-4, 1e-2, 1e2, 1e4]);
            scene.view.transfer.reference_length = scene.view.transfer.reference_length.map(|l| l * factor);
        }
        // Many particles in one place; not so many that a ray through all cells meets 65535 in all, where
        // Mesa's software adapter ends its loops.
        _ => {
            let heap = scene.particles[0];
            scene
                .particles
                .extend((0..200).map(|_| Particle { quantity: random.unit() * heap.quantity, ..heap }));
        }
    }
}

fn tolerance(random: &mut Random) -> f64 {
    match random.below(20) {
        0 => 0.0,
        1 => 1.0,
        _ => random.log_between(1e-4, 0.1),
    }
}

/// A transfer function that is hard to bound, or none: that of the scene is to stay.
fn transfer(random: &mut Random) -> Option<Vec<ControlPoint>> {
    let opacity = |random: &mut Random| match random.below(4) {
        0 => 0.0,
        1 => 1.0,
        _ => random.unit().powi(2) as f32,
    };
    let point = |random: &mut Random, u: f64| ControlPoint {
        u: u as f32,
        rgb: std::array::from_fn(|_| random.unit() as f32),
        opacity: opacity(random),
    };
    match random.below(6) {
        0 | 1 => None,
        // Two colours of one opacity: what is seen changes slowly.
        2 => {
            let opacity = random.log_between(1e-3, 0.9) as f32;
            Some([0.0, 1.0].map(|u| ControlPoint { opacity, ..point(random, u) }).to_vec())
        }
        // Spikes far thinner than a 256th, on nothing.
        3 => Some(sorted((0..1 + random.below(4)).flat_map(|_| spike(random)).collect())),
        // Many nodes.
        4 => {
            let places: Vec<f64> = (0..20 + random.below(480)).map(|_| random.unit()).collect();
            Some(sorted(places.into_iter().map(|u| point(random, u)).collect()))
        }
        // Steps between clear and opaque.
        _ => {
            let steps: Vec<f64> = (0..1 + random.below(6)).map(|_| random.unit()).collect();
            Some(sorted(steps.into_iter().flat_map(|u| [(); 2].map(|()| point(random, u))).collect()))
        }
    }
}

/// A peak between two points of no opacity.
fn spike(random: &mut Random) -> [ControlPoint; 3] {
    let (centre, width) = (random.unit(), random.log_between(1e-5, 1.0 / 256.0));
    let rgb = std::array::from_fn(|_| random.unit() as f32);
    [(-1.0, 0.0), (0.0, random.between(0.2, 1.0)), (1.0, 0.0)].map(|(side, opacity)| ControlPoint {
        u: (centre + side * width).clamp(0.0, 1.0) as f32,
        rgb,
        opacity: opacity as f32,
    })
}

fn sorted(mut points: Vec<ControlPoint>) -> Vec<ControlPoint> {
    points.sort_by(|a, b| a.u.total_cmp(&b.u));
    points
}

/// Cases by hand, for errors that random ones meet too rarely: quantities exactly at or next to a jump
/// of the transfer function.
pub fn hard_cases() -> Vec<Scene> {
    let at_a_step = [0.375, 0.370_117_2, 0.1, 1e-5].map(|u| with_step(u, &|_| f64::from(u)));
    let below_a_step = [0.375, 0.370_117_2, 0.1, 1e-5].map(|u| with_step(u, &|_| f64::from(u.next_down())));
    let around_a_step = [1e-3, 1e-5].map(|width| with_step(0.25, &|q| 0.25 + width * (q - 0.5)));
    let mut cases = [at_a_step.to_vec(), below_a_step.to_vec(), around_a_step.to_vec()].concat();
    for mut scene in cases.clone() {
        scene.view.sampling.brick_width = BrickWidth::Two;
        scene.name += ", bricks of 2";
        cases.push(scene);
    }
    cases
}

/// The plain scene with a changed quantity, and a transfer function that goes from clear to half
/// opaque at `u`.
fn with_step(u: f32, quantity: &dyn Fn(f64) -> f64) -> Scene {
    let mut scene = scenes::plain(14, 57, 43);
    scene.particles.iter_mut().for_each(|particle| particle.quantity = quantity(particle.quantity));
    scene.view.transfer.points =
        vec![grey(0.0, 0.2, 0.0), grey(u, 0.2, 0.0), grey(u, 0.9, 0.5), grey(1.0, 0.9, 0.5)];
    scene.view.sampling.tolerance = Some(0.01);
    scene.name = format!("a step at {u}, a quantity of {} and more", quantity(0.0));
    scene
}

fn limit_samples(scene: &mut Scene) {
    let slices = Setup::new(&scene.view).slices;
    let samples = f64::from(slices.count) * f64::from(scene.view.image.width * scene.view.image.height);
    scene.view.sampling.rate *= (MOST_SAMPLES / samples).min(1.0);
}

/// One view at full sampling and as its tolerance allows, on one device.
pub struct Trial {
    name: String,
    pub tolerance: f64,
    pub full: Picture,
    pub adaptive: Picture,
    pub comparison: Comparison,
}

/// `scene` as the renderer takes it, to be sampled adaptively even where that is not worth its while.
pub fn prepare_anyway(scene: &Scene) -> renderer::Scene {
    let mut prepared = prepare(scene);
    prepared.sampling.always_adaptive = true;
    prepared
}

/// Renders `scene`, which has a tolerance, both ways; adaptively even where that is not worth its while.
/// The grid of particles stays the same, and with it the order of all sums: what differs is the sampling.
pub fn try_out(renderer: &mut Renderer, scene: &Scene) -> Trial {
    try_without(renderer, scene, Without::Nothing)
}

/// The same with a part of the method left out.
pub fn try_without(renderer: &mut Renderer, scene: &Scene, part: Without) -> Trial {
    let tolerance = scene.view.sampling.tolerance.expect("a trial needs a tolerance");
    let mut prepared = prepare_anyway(scene);
    prepared.sampling.without = part;
    let mut unadapted = prepared.clone();
    unadapted.sampling.tolerance = None;
    let full = render(renderer, &unadapted);
    let adaptive = render(renderer, &prepared);
    let comparison = compare(&Image::from(&full), &Image::from(&adaptive));
    Trial { name: scene.name.clone(), tolerance, full, adaptive, comparison }
}

impl Trial {
    /// Share of full sampling's evaluations that the adaptive picture took.
    pub fn share(&self) -> f64 {
        let [done, full] = [&self.adaptive, &self.full].map(|p| p.stats.evaluations.done.max(1) as f64);
        done / full
    }

    /// What was promised and not kept: an error of the tolerance or more, or of more than was
    /// predicted, or numbers that are none of a picture. A tolerance of 0 allows no error at all.
    pub fn violation(&self) -> Option<String> {
        let Trial { name, tolerance, comparison, .. } = self;
        let (error, predicted) = (comparison.max, self.adaptive.stats.predicted_error);
        let within = error < *tolerance || error == 0.0;
        let foreseen = error <= predicted + ROUNDING && predicted <= *tolerance;
        let sound = |picture: &Picture| picture.pixels.iter().flatten().all(|c| (0.0..=1.0).contains(c));
        let broken = [
            (within, "above the tolerance"),
            (foreseen, "not as predicted"),
            (sound(&self.full), "full sampling is no picture"),
            (sound(&self.adaptive), "no picture"),
        ];
        let broken: Vec<&str> = broken.iter().filter(|(kept, _)| !kept).map(|(_, what)| *what).collect();
        let [x, y] = comparison.worst;
        let index = (y * self.full.width + x) as usize;
        let (expected, found) = (self.full.pixels[index], self.adaptive.pixels[index]);
        (!broken.is_empty()).then(|| {
            let broken = broken.join(", ");
            format!(
                "{name}: {broken}: error {error:.6e}, predicted {predicted:.6e}, \
                 pixel ({x}, {y}) is {found:?} instead of {expected:?}"
            )
        })
    }
}
