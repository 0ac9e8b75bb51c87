//! What one ray shows on the host is what the picture shows: its opacity is the pixel's, and the place
//! that is seen lies where the twin finds most of it.

use std::ops::ControlFlow;

use glam::DVec3;
use reference::Particle;
use reference::device::{prepare, shared};
use reference::random::Random;
use reference::scenes::{Scene, grey, plain_view};
use renderer::{Kernel, OpacityView};

/// Balls in a cloud around the origin.
fn cloud(seed: u64, support_radius: f64) -> Scene {
    let mut random = Random::new(seed);
    let particle = |_| Particle {
        position: random.in_cube(),
        support_radius: support_radius * random.between(0.7, 1.3),
        volume: random.between(0.5, 2.0),
        quantity: random.unit(),
        opacity: random.unit(),
    };
    let particles = (0..400).map(particle).collect();
    let mut scene = Scene { name: format!("cloud {seed}"), particles, view: plain_view(24, 20) };
    scene.view.sampling.tolerance = None;
    scene
}

#[test]
fn a_ray_has_the_opacity_of_its_pixel() {
    for (seed, kernel, radius) in [
        (1, Kernel::Poly6, 0.3),
        (2, Kernel::Cubic, 0.25),
        (3, Kernel::WendlandC2, 0.4),
        (4, Kernel::Poly6, 0.001),
    ] {
        let mut scene = cloud(seed, radius);
        scene.view.particles.kernel = kernel;
        // By another field than the colour, every other time.
        let opacity = OpacityView { range: Some([0.2, 0.9]), ..OpacityView::default() };
        scene.view.quantity.opacity = (seed % 2 == 0).then_some(opacity);
        let scene = prepare(&scene);
        let picture = shared().render(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
        let mut seen = 0;
        for (number, pixel) in picture.pixels.iter().enumerate() {
            let place = [number % 24, number / 24].map(|side| side as f64 + 0.5);
            let glance = scene.glance(place);
            let error = (glance.opacity - f64::from(pixel[3])).abs();
            assert!(error < 2e-3, "{seed} {place:?}: {} is not {}", glance.opacity, pixel[3]);
            assert_eq!(glance.sight.is_some(), glance.opacity > 0.0);
            seen += usize::from(glance.opacity > 0.05);
        }
        assert!(seen > 50, "{seed}: {seen} pixels show something");
    }
}

/// Two balls behind one another on the axis of the camera, with the given quantities.
fn two(front: f64, back: f64) -> (renderer::Scene, [DVec3; 2]) {
    let mut view = plain_view(200, 200);
    let camera = view.camera.unwrap();
    let forward = (camera.target - camera.eye).normalize();
    let [near, far] = [camera.near.unwrap(), camera.far.unwrap()];
    let places = [0.3, 0.8].map(|share| camera.eye + (near + share * (far - near)) * forward);
    let particle = |(position, quantity)| Particle {
        position,
        support_radius: 0.1,
        volume: 1.0,
        quantity,
        opacity: 0.0,
    };
    let particles = places.into_iter().zip([front, back]).map(particle).collect();
    // Nearly clear at 0, nearly opaque at 1, nothing at ½.
    view.transfer.points = vec![grey(0.0, 1.0, 0.05), grey(0.5, 1.0, 0.0), grey(1.0, 1.0, 0.9)];
    view.transfer.reference_length = Some(0.1);
    view.quantity.range = Some([0.0, 1.0]);
    (prepare(&Scene { name: "two".into(), particles, view }), places)
}

#[test]
fn the_place_that_is_seen_is_where_most_of_the_opacity_comes_from() {
    let sight = |front, back| {
        let (scene, places) = two(front, back);
        let glance = scene.glance([100.0, 100.0]);
        assert_eq!(glance.met.iter().map(|met| met.index).collect::<Vec<_>>(), [0, 1]);
        assert!(glance.met.iter().all(|met| met.distance < 1e-9));
        (glance.sight, places)
    };
    for (front, back, seen) in [(1.0, 1.0, 0), (0.0, 1.0, 1), (0.5, 0.0, 1), (1.0, 0.5, 0)] {
        let (found, places) = sight(front, back);
        let found = found.unwrap();
        assert!(found.point.distance(places[seen]) < 0.1, "{front} {back}: {found:?}");
        assert_eq!(found.around.iter().map(|(index, _)| *index).collect::<Vec<_>>(), [seen]);
    }
    assert_eq!(sight(0.5, 0.5).0, None, "nothing is to be seen");
}
