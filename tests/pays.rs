//! What may be left out is found out only where that pays; where it does not, the picture is that of full
//! sampling, and all that tells about it says so.

use std::ops::ControlFlow;

use reference::device::{open, prepare, render, shared};
use reference::guarantee::{calm, prepare_anyway};
use reference::random::Random;
use reference::scenes::Scene;
use renderer::{CellClass, GpuOptions, Renderer};

/// Enough bundles for some of them to be tried first.
const SIZE: [u32; 2] = [200, 176];

/// Most of it needs no samples.
fn smooth() -> Scene {
    calm(20, SIZE[0], SIZE[1])
}

/// All of it has to be sampled.
fn noisy() -> Scene {
    let mut random = Random::new(7);
    let mut scene = smooth();
    scene.particles.iter_mut().for_each(|particle| particle.quantity = random.unit());
    scene.view.quantity.range = Some([0.0, 1.0]);
    scene.view.camera.as_mut().expect("it has a camera").fov_y_degrees = 30.0;
    scene.view.sampling.tolerance = Some(0.001);
    scene.name = "noisy".to_owned();
    scene
}

fn in_full(scene: &Scene) -> renderer::Scene {
    let mut prepared = prepare(scene);
    prepared.sampling.tolerance = None;
    prepared
}

#[test]
fn a_smooth_run_is_adapted() {
    let (mut renderer, scene) = (shared(), smooth());
    let picture = render(&mut renderer, &prepare(&scene));
    let classes = picture.stats.cells_by_class;
    assert!(classes.super_pixel > classes.full + classes.mixed, "{classes:?}");
    assert_eq!(picture.pixels, render(&mut renderer, &prepare_anyway(&scene)).pixels);
}

#[test]
fn a_noisy_run_is_sampled_in_full_but_for_a_trial() {
    let (mut renderer, scene) = (shared(), noisy());
    let full = render(&mut renderer, &in_full(&scene));
    let picture = render(&mut renderer, &prepare(&scene));
    assert_eq!(picture.pixels, full.pixels);
    let (stats, cells) = (picture.stats, full.stats.cells_by_class);
    assert_eq!((stats.cells_by_class, stats.predicted_error), (cells, 0.0));
    let (evaluations, full) = (stats.evaluations, full.stats.evaluations.done);
    assert_eq!((evaluations.full, evaluations.done), (full, full + evaluations.bounds));
    assert!(evaluations.bounds > 0 && evaluations.bounds < full / 50, "{evaluations:?}");
}

#[test]
fn it_is_adapted_all_the_same_where_that_is_asked_for() {
    let (mut renderer, mut scene) = (shared(), noisy());
    scene.view.sampling.always_adaptive = true;
    let classes = render(&mut renderer, &prepare(&scene)).stats.cells_by_class;
    assert!(classes.mixed + classes.super_pixel > 0 && classes.full > 0, "{classes:?}");
}

/// Renders `scene`, and tells the classes of its cells and whether a bundle of it has a budget.
fn inspected(renderer: &mut Renderer, scene: &renderer::Scene) -> (Vec<CellClass>, bool) {
    let (picture, map) = renderer.render_with_cells(scene, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(map.classes(), picture.stats.cells_by_class);
    let mut classes: Vec<CellClass> =
        map.bundles.iter().flat_map(|bundle| &bundle.cells).map(|cell| cell.class).collect();
    classes.sort_unstable();
    classes.dedup();
    let detail = renderer.inspect_bundle(scene, [12, 11], &mut |_| ControlFlow::Continue(())).unwrap();
    assert!(!detail.cells.is_empty());
    (classes, detail.budget.is_some())
}

#[test]
fn cells_tell_how_they_were_sampled() {
    let mut renderer = shared();
    assert_eq!(inspected(&mut renderer, &prepare(&noisy())), (vec![CellClass::Full], false));
    let (classes, has_budget) = inspected(&mut renderer, &prepare(&smooth()));
    assert!(classes.contains(&CellClass::SuperPixel) && has_budget, "{classes:?}");
}

/// A bundle is cast anew where its tile has given way to another one: as it was in the picture.
#[test]
fn a_bundle_of_several_tiles_tells_how_it_was_sampled() {
    let memory = Some(64 << 20);
    let mut renderer = open(&GpuOptions { memory, ..GpuOptions::default() });
    // Noise in one half, so that it pays in some of the tiles only.
    let (mut scene, noise) = (smooth(), noisy());
    scene.view.camera = noise.view.camera;
    scene.view.sampling.tolerance = Some(3e-4);
    for (particle, noisy) in scene.particles.iter_mut().zip(&noise.particles) {
        particle.quantity = if particle.position.y < 0.0 { noisy.quantity } else { 0.5 };
    }
    (scene.view.image.width, scene.view.image.height) = (400, 352);
    let scene = prepare(&scene);
    let (_, map) = renderer.render_with_cells(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
    let mut in_full = 0;
    for bundle in [[12, 11], [30, 9], [25, 22], [20, 30], [38, 35]] {
        let known = map.bundle(bundle);
        let detail = renderer.inspect_bundle(&scene, bundle, &mut |_| ControlFlow::Continue(())).unwrap();
        let cells: Vec<_> = detail.cells.iter().map(|detail| detail.cell).collect();
        assert_eq!((cells, detail.charged), (known.cells.clone(), known.charged), "{bundle:?}");
        let is_full = known.cells.iter().all(|cell| cell.class == CellClass::Full);
        in_full += u32::from(is_full && detail.budget.is_none());
    }
    assert!((1..5).contains(&in_full), "{in_full} bundles of tiles in which it does not pay");
}

#[test]
fn a_picture_does_not_depend_on_those_before() {
    // Of the same particles: in so narrow a tolerance all is sampled.
    let mut narrow = smooth();
    narrow.view.sampling.tolerance = Some(3.4e-5);
    let mut held = prepare(&smooth());
    let narrow_sampling = prepare(&narrow).sampling;
    let expected = render(&mut open(&GpuOptions::default()), &held).pixels;
    let mut renderer = open(&GpuOptions::default());
    let wide_sampling = std::mem::replace(&mut held.sampling, narrow_sampling);
    let full = render(&mut renderer, &held);
    assert_eq!(full.stats.cells_by_class.full, full.stats.cells, "it does not pay");
    held.sampling = wide_sampling;
    assert_eq!(render(&mut renderer, &held).pixels, expected);
    held.sampling = narrow_sampling;
    assert_eq!(render(&mut renderer, &held).pixels, full.pixels);
}
