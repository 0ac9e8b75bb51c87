//! What the renderer keeps from one picture for the next is never stale: after every kind of change,
//! alone and after others, the picture is that of the twin.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec3;
use reference::Particle;
use reference::compare::compare;
use reference::device::{mismatch, open, particle_set, quantity, render, shared};
use reference::guarantee::{alike_but_for_decisions, calm, try_out};
use reference::picture::Image;
use reference::random::Random;
use reference::scenes::{self, Scene, grey};
use renderer::{Bound, GpuOptions, Kernel, ParticleSet, Quantity, RenderError, View};

/// A scene whose particles and quantity the renderer may recognise.
struct Held {
    particles: Vec<Particle>,
    view: View,
    set: Arc<ParticleSet>,
    quantity: Arc<Quantity>,
}

impl Held {
    fn new(Scene { particles, view, .. }: Scene) -> Held {
        let set = particle_set(&particles);
        let quantity = quantity(&set, &particles, &view);
        Held { particles, view, set, quantity }
    }

    fn scene(&self) -> renderer::Scene {
        let scene = renderer::Scene::new(self.set.clone(), self.quantity.clone(), &self.view);
        scene.unwrap_or_else(|error| panic!("{error}"))
    }

    fn assert_alike(&self, renderer: &mut renderer::Renderer, what: &str) {
        let image = Image::from(&render(renderer, &self.scene()));
        let (particles, view) = (self.particles.clone(), self.view.clone());
        let mismatch = mismatch(&Scene { name: what.to_owned(), particles, view }, &image);
        assert!(mismatch.is_none(), "{}", mismatch.unwrap_or_default());
    }
}

/// Adaptive pictures: what was found out about an earlier picture is not there for a fresh renderer.
impl Held {
    /// Fails where the picture is not that of `fresh`, which has to begin at the beginning, or is not
    /// within the tolerance of its full sampling.
    fn assert_like_fresh(
        &self,
        renderer: &mut renderer::Renderer,
        fresh: &mut renderer::Renderer,
        what: &str,
    ) {
        let image = Image::from(&render(renderer, &self.scene()));
        let (particles, mut view) = (self.particles.clone(), self.view.clone());
        let tolerance = *view.sampling.tolerance.get_or_insert(0.0);
        let trial = try_out(fresh, &Scene { name: what.to_owned(), particles, view });
        assert_eq!(trial.violation(), None);
        let error = compare(&Image::from(&trial.full), &image);
        assert!(error.max < tolerance.max(1e-4), "{what}: {error}");
        let change = compare(&Image::from(&trial.adaptive), &image);
        assert!(alike_but_for_decisions(&change, tolerance), "{what}: {change}");
    }
}

/// What is changed, and how.
type Change = (&'static str, fn(&mut Held));

const CHANGES: [Change; 11] = [
    ("the same again", |_| ()),
    ("another transfer function", |held| {
        held.view.transfer.points = vec![grey(0.0, 0.1, 0.3), grey(0.4, 0.9, 0.02), grey(1.0, 0.2, 0.2)];
    }),
    ("the first transfer function", |held| {
        held.view.transfer.points = View::default().transfer.points;
    }),
    ("another reference length", |held| {
        held.view.transfer.reference_length = held.view.transfer.reference_length.map(|length| 0.6 * length);
    }),
    ("the next kernel", |held| {
        let next = (Kernel::ALL.iter().position(|&k| k == held.view.particles.kernel).unwrap_or(0) + 1) % 3;
        held.view.particles.kernel = Kernel::ALL[next];
    }),
    ("another quantity", |held| {
        held.particles.iter_mut().for_each(|particle| particle.quantity = (1.7 * particle.quantity).fract());
        held.quantity = quantity(&held.set, &held.particles, &held.view);
    }),
    ("another range", |held| {
        held.view.quantity.range = held.view.quantity.range.map(|[low, high]| [0.9 * high, low + 1.1 * high]);
        held.quantity = quantity(&held.set, &held.particles, &held.view);
    }),
    ("another camera", |held| {
        let camera = held.view.camera.as_mut().expect("the view has a camera");
        camera.eye += DVec3::new(0.4, -0.3, 0.1);
    }),
    ("another size", |held| {
        let image = &mut held.view.image;
        (image.width, image.height) = (image.height + 3, image.width - 2);
    }),
    ("another rate", |held| {
        held.view.sampling.rate = if held.view.sampling.rate > 0.8 { 0.7 } else { 1.3 };
    }),
    ("other particles", |held| {
        held.particles.truncate(held.particles.len() - 20);
        held.particles.iter_mut().for_each(|particle| particle.position *= 0.97);
        held.set = particle_set(&held.particles);
        held.quantity = quantity(&held.set, &held.particles, &held.view);
    }),
];

/// Changes of what may be saved.
const SAMPLING_CHANGES: [Change; 6] = [
    ("a tolerance of 0.001", |held| held.view.sampling.tolerance = Some(0.001)),
    ("a tolerance of 0.01", |held| held.view.sampling.tolerance = Some(0.01)),
    ("a tolerance of 0.1", |held| held.view.sampling.tolerance = Some(0.1)),
    ("full sampling", |held| held.view.sampling.tolerance = None),
    ("super-pixels on or off", |held| held.view.sampling.super_pixels ^= true),
    ("the other bound", |held| {
        held.view.sampling.bound = match held.view.sampling.bound {
            Bound::Difference => Bound::Paper,
            Bound::Paper => Bound::Difference,
        };
    }),
];

#[test]
fn adaptive_pictures_after_each_change_alone() {
    let (mut renderer, mut fresh) = (shared(), open(&GpuOptions::default()));
    for (what, change) in CHANGES.into_iter().chain(SAMPLING_CHANGES) {
        let mut held = Held::new(calm(120, 42, 35));
        held.assert_like_fresh(&mut renderer, &mut fresh, "the first picture");
        change(&mut held);
        held.assert_like_fresh(&mut renderer, &mut fresh, what);
    }
}

#[test]
fn adaptive_pictures_after_many_changes_in_any_order() {
    let (mut renderer, mut fresh) = (shared(), open(&GpuOptions::default()));
    let mut random = Random::new(121);
    let mut held = Held::new(calm(122, 42, 35));
    let mut history = String::new();
    let changes = [&CHANGES[..], &SAMPLING_CHANGES].concat();
    for _ in 0..60 {
        for _ in 0..1 + random.below(3) {
            let (what, change) = random.pick(&changes);
            change(&mut held);
            history = format!("{history}, {what}");
        }
        held.assert_like_fresh(&mut renderer, &mut fresh, &history);
    }
}

#[test]
fn after_each_change_alone() {
    for (what, change) in CHANGES {
        let mut renderer = shared();
        let mut held = Held::new(scenes::plain(100, 26, 19));
        held.assert_alike(&mut renderer, "the first picture");
        change(&mut held);
        held.assert_alike(&mut renderer, what);
    }
}

#[test]
fn after_many_changes_in_any_order() {
    let mut renderer = shared();
    let mut random = Random::new(101);
    let mut held = Held::new(scenes::plain(102, 26, 19));
    let mut history = String::new();
    for _ in 0..40 {
        // Now and then several changes before the next picture.
        for _ in 0..1 + random.below(3) {
            let (what, change) = random.pick(&CHANGES);
            change(&mut held);
            history = format!("{history}, {what}");
        }
        held.assert_alike(&mut renderer, &history);
    }
}

#[test]
fn two_scenes_in_turn() {
    let mut renderer = shared();
    let [first, second] = [Held::new(scenes::plain(103, 20, 20)), Held::new(scenes::plain(104, 33, 9))];
    for _ in 0..2 {
        first.assert_alike(&mut renderer, "the first scene");
        second.assert_alike(&mut renderer, "the second scene");
    }
}

#[test]
fn growing_and_shrinking_scenes() {
    let mut renderer = shared();
    for (step, count) in [10, 700, 0, 300, 729, 1].into_iter().enumerate() {
        let mut scene = scenes::plain(105 + step as u64, 20, 20);
        scene.particles.truncate(count);
        Held::new(scene).assert_alike(&mut renderer, &format!("{count} particles"));
    }
}

#[test]
fn after_a_cancelled_picture() {
    let mut renderer = shared();
    let mut held = Held::new(scenes::plain(110, 40, 30));
    for after in 0..4 {
        held.assert_alike(&mut renderer, "before");
        CHANGES[7].1(&mut held);
        let mut asked = 0;
        let result = renderer.render(&held.scene(), &mut |_| {
            asked += 1;
            if asked > after { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        match result {
            Err(RenderError::Cancelled) => assert!(asked > after, "cancelled without asking"),
            Err(error) => panic!("{error}"),
            Ok(_) => assert!(asked <= after, "went on though it was told to stop"),
        }
        held.assert_alike(&mut renderer, &format!("after a picture cancelled at step {after}"));
    }
}
