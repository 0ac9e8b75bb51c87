//! Scenes: particles and a view that leaves nothing open, by hand or at random from a seed.

use std::f64::consts::TAU;

use glam::DVec3;
use renderer::{CameraView, ControlPoint, Kernel, View};

use crate::particle::Particle;
use crate::quantity::Range;
use crate::random::Random;

/// What a picture is made from.
#[derive(Clone, Debug)]
pub struct Scene {
    /// For messages.
    pub name: String,
    pub particles: Vec<Particle>,
    pub view: View,
}

/// A control point of one grey.
pub fn grey(u: f32, value: f32, opacity: f32) -> ControlPoint {
    ControlPoint { u, rgb: [value; 3], opacity }
}

/// A view from (0, 0, 4) on the origin, from depth 1 to 7, of quantities from 0 to 1, at full sampling.
pub fn plain_view(width: u32, height: u32) -> View {
    let camera = CameraView {
        eye: DVec3::new(0.0, 0.0, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_y_degrees: 40.0,
        near: Some(1.0),
        far: Some(7.0),
    };
    let mut view = View { camera: Some(camera), ..View::default() };
    (view.image.width, view.image.height) = (width, height);
    view.quantity.range = Some([0.0, 1.0]);
    view.transfer.reference_length = Some(0.5);
    view.sampling.tolerance = None;
    view
}

/// A jittered lattice of 9³ particles over [−1, 1]³ with a smooth field from 0 to 1, half seen
/// through in [`plain_view`] with the default transfer function.
pub fn plain(seed: u64, width: u32, height: u32) -> Scene {
    let mut random = Random::new(seed);
    let field = |x: DVec3| 0.5 + 0.5 * (2.0 * x.x + 1.5 * x.y - x.z).sin();
    let particles = lattice(&mut random, [9; 3], 0.3, 2.0)
        .into_iter()
        .map(|(position, support_radius)| {
            let volume = random.between(0.5, 2.0);
            Particle { position, support_radius, volume, quantity: field(position), opacity: 0.0 }
        })
        .collect();
    Scene { name: format!("plain {seed} {width}x{height}"), particles, view: plain_view(width, height) }
}

/// How the particles of a random scene lie in [−1, 1]³.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    JitteredLattice,
    Clusters,
    /// Two layers, much thinner than wide.
    Sheet,
    /// All in one plane.
    Layer,
    /// Radii over 1:100.
    MixedRadii,
    /// Radii far below a pixel.
    Dust,
    /// A few particles that each fill the screen.
    Giants,
}

impl Shape {
    pub const ALL: [Shape; 7] = [
        Shape::JitteredLattice,
        Shape::Clusters,
        Shape::Sheet,
        Shape::Layer,
        Shape::MixedRadii,
        Shape::Dust,
        Shape::Giants,
    ];

    /// Positions and support radii.
    fn place(self, random: &mut Random) -> Vec<(DVec3, f64)> {
        let uniform = |random: &mut Random, count: usize, [low, high]: [f64; 2]| {
            (0..count).map(|_| (random.in_cube(), random.log_between(low, high))).collect()
        };
        match self {
            Shape::JitteredLattice => {
                let side = 4 + random.below(10);
                let (jitter, reach) = (random.between(0.0, 0.5), random.between(1.2, 2.5));
                lattice(random, [side; 3], jitter, reach)
            }
            Shape::Clusters => (0..3 + random.below(5)).flat_map(|_| cluster(random)).collect(),
            Shape::Sheet => {
                let side = 10 + random.below(20);
                let flatten = random.between(0.01, 0.05);
                let points = lattice(random, [side, side, 2], 0.15, 1.6);
                points.into_iter().map(|(p, h)| (p * DVec3::new(1.0, 1.0, flatten), h)).collect()
            }
            Shape::Layer => {
                let side = 8 + random.below(20);
                lattice(random, [side, side, 1], 0.0, 1.7)
            }
            Shape::MixedRadii => uniform(random, 600, [0.008, 0.8]),
            Shape::Dust => uniform(random, 2000, [1e-5, 5e-3]),
            Shape::Giants => uniform(random, 12, [1.0, 6.0]),
        }
    }
}

/// A lattice over [−1, 1]³ (through the middle where an axis has one point), jittered by a share of
/// its spacing, with radii of `reach` spacings.
fn lattice(random: &mut Random, counts: [usize; 3], jitter: f64, reach: f64) -> Vec<(DVec3, f64)> {
    let spacing = 2.0 / counts.into_iter().max().unwrap_or(1) as f64;
    let middle = counts.map(|count| 0.5 * (count as f64 - 1.0));
    let mut points = Vec::new();
    for x in 0..counts[0] {
        for y in 0..counts[1] {
            for z in 0..counts[2] {
                let index = DVec3::new(x as f64, y as f64, z as f64) - DVec3::from_array(middle);
                points.push((spacing * (index + jitter * random.in_cube()), reach * spacing));
            }
        }
    }
    points
}

/// A hundred to three hundred particles, denser in the middle.
fn cluster(random: &mut Random) -> Vec<(DVec3, f64)> {
    let (centre, size) = (0.8 * random.in_cube(), random.log_between(0.05, 0.5));
    let h = size * random.between(0.2, 0.8);
    (0..100 + random.below(200))
        .map(|_| (centre + size * random.unit() * random.direction(), h * random.between(0.8, 1.2)))
        .collect()
}

/// The random scene of `seed`: its shape, field, transfer function, camera, unit and place.
pub fn random(seed: u64, shape: Shape, size: [u32; 2], kernel: Kernel) -> Scene {
    let mut random = Random::new(seed);
    let places = shape.place(&mut random);
    let field = Field::new(&mut random);
    let mut particles: Vec<Particle> = places
        .into_iter()
        .map(|(position, support_radius)| Particle {
            position,
            support_radius,
            volume: random.between(0.5, 2.0),
            quantity: field.at(position) + field.noise * random.between(-1.0, 1.0),
            opacity: 0.0,
        })
        .collect();
    let mut view = plain_view(size[0], size[1]);
    view.camera = Some(camera(&mut random));
    view.particles.kernel = kernel;
    view.sampling.rate = random.pick(&[0.5, 1.0, 1.0, 1.7]);
    view.transfer.points = transfer(&mut random);
    view.transfer.reference_length = Some(random.log_between(0.03, 2.0));
    let range = Range::of(particles.iter().map(|p| p.quantity)).expect("every shape has particles");
    let cut = random.pick(&[0.0, 0.0, 0.2]) * (range.max - range.min);
    view.quantity.range = Some([range.min + cut, range.max - cut]);

    let unit = random.log_between(1e-3, 1e3);
    let origin = 20.0 * unit * random.in_cube();
    transform(&mut particles, &mut view, unit, origin);
    let name = format!("{shape:?} {seed} {}x{} {}", size[0], size[1], kernel.name());
    Scene { name, particles, view }
}

/// Multiplies every length of a run and its view by `unit`, then shifts both by `origin`.
pub fn transform(particles: &mut [Particle], view: &mut View, unit: f64, origin: DVec3) {
    for particle in particles {
        particle.position = unit * particle.position + origin;
        particle.support_radius *= unit;
    }
    let camera = view.camera.as_mut().expect("views of scenes have a camera");
    camera.eye = unit * camera.eye + origin;
    camera.target = unit * camera.target + origin;
    camera.near = camera.near.map(|near| near * unit);
    camera.far = camera.far.map(|far| far * unit);
    view.transfer.reference_length = view.transfer.reference_length.map(|length| length * unit);
}

/// A smooth field with noise: a plane wave in the unit of some physical field.
struct Field {
    wave: DVec3,
    phase: f64,
    offset: f64,
    amplitude: f64,
    noise: f64,
}

impl Field {
    fn new(random: &mut Random) -> Field {
        let amplitude = random.log_between(1e-3, 1e5);
        Field {
            wave: random.between(0.5, 4.0) * random.direction(),
            phase: random.between(0.0, TAU),
            offset: amplitude * random.between(-3.0, 3.0),
            amplitude,
            noise: amplitude * random.pick(&[0.0, 0.05, 0.5]),
        }
    }

    fn at(&self, x: DVec3) -> f64 {
        self.offset + self.amplitude * (self.wave.dot(x) + self.phase).sin()
    }
}

/// Outside looking at the middle, or inside looking anywhere.
fn camera(random: &mut Random) -> CameraView {
    let outside = random.unit() < 0.7;
    let distance = random.between(2.5, 6.0);
    let (eye, target) = match outside {
        true => (distance * random.direction(), 0.4 * random.in_cube()),
        false => (0.7 * random.in_cube(), 10.0 * random.direction()),
    };
    let [near, far] = match outside {
        // Sometimes the planes cut the run.
        true => [distance - random.between(0.3, 1.9), distance + random.between(0.3, 1.9)],
        false => [random.log_between(0.02, 0.3), random.between(1.0, 4.0)],
    };
    CameraView {
        eye,
        target,
        up: random.direction(),
        fov_y_degrees: random.between(12.0, 110.0),
        near: Some(near),
        far: Some(far),
    }
}

/// Ramps, steps, spikes, fully clear and fully opaque stretches.
fn transfer(random: &mut Random) -> Vec<ControlPoint> {
    let clear_or_opaque = random.unit() < 0.3;
    let point = |random: &mut Random, u: f64| ControlPoint {
        u: u as f32,
        rgb: std::array::from_fn(|_| random.unit() as f32),
        opacity: match clear_or_opaque {
            true => random.pick(&[0.0, 0.0, 0.5, 1.0]),
            false => random.unit().powi(2) as f32,
        },
    };
    match random.below(3) {
        // A ramp over a few points, not always from 0 to 1.
        0 => ascending(random, 2, 8).into_iter().map(|u| point(random, u)).collect(),
        // Steps: each u twice.
        1 => ascending(random, 1, 5).into_iter().flat_map(|u| [u, u]).map(|u| point(random, u)).collect(),
        // Narrow spikes on a thin ground.
        _ => {
            let base = point(random, 0.0);
            let spikes = ascending(random, 1, 3);
            let mut points = vec![ControlPoint { opacity: 0.01, ..base }];
            for centre in spikes {
                let width = random.log_between(0.01, 0.1);
                let u = |offset: f64| (centre + offset * width).clamp(0.0, 1.0) as f32;
                let peak = point(random, centre);
                points.extend([-1.0, 1.0].map(|side| ControlPoint { u: u(side), opacity: 0.01, ..base }));
                points.push(ControlPoint { u: u(0.0), ..peak });
            }
            points.sort_by(|a, b| a.u.total_cmp(&b.u));
            points
        }
    }
}

/// Between `least` and `most` numbers in [0, 1], ascending.
fn ascending(random: &mut Random, least: usize, most: usize) -> Vec<f64> {
    let count = least + random.below(most - least + 1);
    let mut numbers: Vec<f64> = (0..count).map(|_| random.unit()).collect();
    numbers.sort_by(f64::total_cmp);
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture;
    use crate::setup::Setup;

    #[test]
    fn every_random_scene_is_valid_and_repeats() {
        for (seed, shape) in (0..20).flat_map(|seed| Shape::ALL.map(|shape| (seed, shape))) {
            let scene = random(seed, shape, [7, 5], Kernel::Cubic);
            scene.view.validate().unwrap_or_else(|error| panic!("{}: {error}", scene.name));
            assert!(scene.particles.iter().all(Particle::is_sound), "{}", scene.name);
            assert!((1..=4000).contains(&scene.particles.len()), "{}", scene.name);
            let again = random(seed, shape, [7, 5], Kernel::Cubic);
            assert_eq!((again.particles, again.view), (scene.particles, scene.view));
        }
    }

    #[test]
    fn most_random_scenes_show_something() {
        let scenes =
            (0..4).flat_map(|seed| Shape::ALL.map(|shape| random(seed, shape, [16, 12], Kernel::Poly6)));
        let visible = scenes.filter(|scene| {
            let image = picture::render_with_floor(&Setup::new(&scene.view), &scene.particles);
            image.pixels.iter().filter(|pixel| pixel[3] > 0.05).count() > 10
        });
        let visible = visible.count();
        assert!(visible > 20, "{visible} of 28 scenes show something");
    }

    #[test]
    fn transforming_moves_every_length() {
        let mut scene = random(3, Shape::Clusters, [16, 12], Kernel::Poly6);
        let before = picture::render(&Setup::new(&scene.view), &scene.particles);
        transform(&mut scene.particles, &mut scene.view, 1e6, DVec3::new(3e7, -1e6, 2e5));
        let after = picture::render(&Setup::new(&scene.view), &scene.particles);
        let comparison = crate::compare::compare(&before, &after);
        assert!(comparison.max < 1e-6, "{comparison}");
    }
}
