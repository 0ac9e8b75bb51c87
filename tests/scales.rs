//! A logarithmic scale, colours outside the range and colour maps make the pictures that control points by
//! hand on a plain linear scale make.

use reference::compare::compare;
use reference::device::picture;
use reference::scenes::{self, Scene, Shape};
use renderer::{ControlPoint, Kernel, MapView, OutsideView, Scale, View};

const SIZE: [u32; 2] = [33, 21];

/// A scene whose quantities go from 10⁻³ to 10, in ratios.
fn scene(seed: u64) -> Scene {
    let mut scene = scenes::random(seed, Shape::ALL[0], SIZE, Kernel::default());
    let [low, high] = scene.view.quantity.range.expect("scenes have ranges");
    for particle in &mut scene.particles {
        let u = ((particle.quantity - low) / (high - low)).clamp(0.0, 1.0);
        particle.quantity = 1e-3 * 1e4_f64.powf(u);
    }
    // Without steps of its own: those of the list by hand are close to it only where it is smooth.
    scene.view.transfer = scenes::plain_view(1, 1).transfer;
    scene.view.sampling.tolerance = None;
    scene
}

fn with(scene: &Scene, change: impl FnOnce(&mut View)) -> Scene {
    let mut view = scene.view.clone();
    change(&mut view);
    Scene { view, name: scene.name.clone(), particles: scene.particles.clone() }
}

/// `view` with its function written down at many values of the range `wide`, on a linear scale, and on both
/// sides of `steps`.
fn by_hand(view: &mut View, wide: [f64; 2], steps: &[f64], at: impl Fn(f64) -> [f32; 4]) {
    let places = 4000;
    let point = |q: f64, value: f64| {
        let [r, g, b, opacity] = at(value);
        ControlPoint { u: ((q - wide[0]) / (wide[1] - wide[0])) as f32, rgb: [r, g, b], opacity }
    };
    // Close together where the values are small.
    let share = |i: u32| (f64::from(i) / f64::from(places - 1)).powi(4);
    let dense = (0..places).map(|i| wide[0] + share(i) * (wide[1] - wide[0])).map(|q| point(q, q));
    let sides = steps.iter().flat_map(|&q| [point(q, q * (1.0 - 1e-9)), point(q, q * (1.0 + 1e-9))]);
    view.transfer.points = dense.chain(sides).collect();
    view.transfer.points.sort_by(|a, b| a.u.total_cmp(&b.u));
    view.transfer.map = None;
    (view.quantity.range, view.quantity.scale) = (Some(wide), Scale::Linear);
    (view.quantity.below, view.quantity.above) = (None, None);
}

fn assert_same(a: &Scene, b: &Scene, differs_from: &Scene) {
    let (first, second) = (picture(a), picture(b));
    let comparison = compare(&first, &second);
    // A transfer function on a logarithmic scale is kept to 1/4096.
    assert!(comparison.share_above(1e-3) < 1e-3, "{}: {comparison}", a.name);
    let other = compare(&first, &picture(differs_from));
    assert!(other.share_above(5e-3) > 0.1, "{}: what is tested makes no difference", a.name);
}

#[test]
fn control_points_on_a_logarithmic_scale_are_at_equal_ratios() {
    for seed in 1..4 {
        let linear = with(&scene(seed), |view| view.quantity.range = Some([1e-3, 10.0]));
        let log = with(&linear, |view| view.quantity.scale = Scale::Log);
        let function = log.view.transfer.function().expect("a valid function");
        let hand = with(&linear, |view| {
            by_hand(view, [0.0, 10.0], &[], |q| {
                function.sample(((q.max(1e-9) / 1e-3).ln() / 1e4_f64.ln()) as f32)
            });
        });
        assert_same(&log, &hand, &linear);
    }
}

#[test]
fn colours_outside_are_those_beyond_the_ends() {
    for (seed, scale) in [(5, Scale::Linear), (6, Scale::Linear), (7, Scale::Log)] {
        let range = [0.05, 1.5];
        let plain = with(&scene(seed), |view| {
            (view.quantity.range, view.quantity.scale) = (Some(range), scale);
        });
        let below = OutsideView { rgb: [0.9, 0.0, 0.4], opacity: 0.02 };
        let above = OutsideView { rgb: [0.0, 0.9, 0.2], opacity: 0.7 };
        let outside = with(&plain, |view| {
            (view.quantity.below, view.quantity.above) = (Some(below), Some(above));
        });
        let function = outside.view.transfer.function().expect("a valid function");
        let hand = with(&plain, |view| {
            by_hand(view, [0.0, 10.0], &range, |q| match q {
                q if q < range[0] => [below.rgb[0], below.rgb[1], below.rgb[2], below.opacity],
                q if q > range[1] => [above.rgb[0], above.rgb[1], above.rgb[2], above.opacity],
                q => function.sample(scale.u(range, q) as f32),
            });
        });
        assert_same(&outside, &hand, &plain);
    }
}

#[test]
fn a_map_colours_what_the_points_make_dense() {
    let plain = with(&scene(9), |view| view.quantity.range = Some([1e-3, 10.0]));
    let mapped = with(&plain, |view| {
        view.transfer.map = Some(MapView { reversed: true, ..MapView::named("viridis") });
    });
    let function = mapped.view.transfer.function().expect("a valid function");
    let hand = with(&plain, |view| {
        by_hand(view, [1e-3, 10.0], &[], |q| function.sample(((q - 1e-3) / 9.999) as f32))
    });
    assert_same(&mapped, &hand, &plain);
}
