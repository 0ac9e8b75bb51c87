//! Depths tile by tile, in bands beside the colours, and cut short.

use std::ops::ControlFlow;

use reference::device::{open, prepare, render};
use reference::guarantee::{calm, prepare_anyway, with_opacity};
use reference::scenes::{self, Scene};
use renderer::{Band, BandLayers, GpuOptions, RenderError};

use super::{crowded, depths, depths_by, errors, go_on, largest};

/// Many layers along the rays.
fn deep() -> Scene {
    let mut scene = scenes::plain(121, 17, 9);
    scene.view.camera.as_mut().expect("plain scenes have a camera").near = Some(0.01);
    scene.view.sampling.rate = 8.0;
    scene.name += ", many layers";
    scene
}

fn little(memory: u64) -> GpuOptions {
    GpuOptions { memory: Some(memory), ..GpuOptions::default() }
}

#[test]
fn tiles_make_the_same_depths() {
    // As little as holds what is in one place.
    let plenty = [2 << 20, 1 << 20, 192 << 10];
    let cases = [
        (scenes::plain(120, 64, 48), &plenty[..]),
        (deep(), &plenty),
        (crowded(), &plenty[..1]),
        (with_opacity(5, scenes::plain(5, 33, 21)), &plenty),
    ];
    for (scene, memories) in cases {
        let whole = depths(&scene);
        for &memory in memories {
            let found = depths_by(&mut open(&little(memory)), &scene);
            assert_same(&format!("{} with {memory} bytes", scene.name), &whole, &found);
        }
    }
}

/// A bundle whose layers are cast one part after the other, colours and depths in turn.
#[test]
fn rays_in_parts_have_depths_and_colours_of_the_whole() {
    let (scene, memory) = (deep(), little(64 << 10));
    let prepared = prepare(&scene);
    let whole = render(&mut open(&GpuOptions::default()), &prepared).pixels;
    let mut renderer = open(&memory);
    let mut bands = Vec::new();
    let mut take = |band: Band| {
        bands.push(band);
        ControlFlow::Continue(())
    };
    let layers = BandLayers { charges: false, depths: true };
    renderer.render_bands(&prepared, 8, layers, &mut go_on, &mut take).expect("it is rendered");
    let found: Vec<f32> = bands.iter().flat_map(|band| band.depths.clone().expect("asked for")).collect();
    assert_same("bands of parts", &depths(&scene), &found);
    let colours = bands.iter().flat_map(|band| &band.pixels).flatten();
    let far = whole.iter().flatten().zip(colours).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(far <= 1e-4, "colours are {far} apart");

    // Rays that forget what they met in the parts before.
    let edit = ("if tile.first_layer > 0u {".to_owned(), "if tile.first_layer > 1000000u {".to_owned());
    let mut forgetful = open(&GpuOptions { shader_edits: vec![edit], ..memory });
    let wrong = depths_by(&mut forgetful, &scene);
    let apart = found.iter().zip(wrong).filter(|(a, b)| (*a / b - 1.0).abs() > 1e-3).count();
    assert!(apart > 10, "{apart} pixels tell");
}

/// No farther apart than the order of sums may set them.
fn assert_same(what: &str, expected: &[f32], found: &[f32]) {
    assert_eq!(expected.len(), found.len(), "{what}");
    for (place, (a, b)) in expected.iter().zip(found).enumerate() {
        assert!(a == b || (a / b - 1.0).abs() <= 1e-6, "{what}: pixel {place} is {b}, not {a}");
    }
}

#[test]
fn bands_have_the_depths_of_the_whole_and_their_own_colours() {
    let mut scene = prepare_anyway(&calm(62, 97, 75));
    scene.sampling.tolerance = Some(0.003);
    let whole = open(&GpuOptions::default()).render_depths(&scene, &mut go_on).expect("it is rendered");
    for memory in [None, Some(8 << 20)] {
        let mut renderer = open(&GpuOptions { memory, ..GpuOptions::default() });
        let mut bands = |layers: BandLayers| {
            let mut rows = Vec::new();
            let mut take = |band: Band| {
                rows.push(band);
                ControlFlow::Continue(())
            };
            let stats = renderer.render_bands(&scene, 30, layers, &mut go_on, &mut take).expect("rendered");
            (rows, stats)
        };
        let (plain, cost) = bands(BandLayers::default());
        let (layered, cost_with) = bands(BandLayers { charges: true, depths: true });
        assert!(plain.iter().all(|band| band.depths.is_none() && band.charged.is_none()));
        let pixels = |bands: &[Band]| bands.iter().flat_map(|band| band.pixels.clone()).collect::<Vec<_>>();
        assert!(pixels(&plain) == pixels(&layered), "the colours are others");
        assert_eq!(cost.evaluations, cost_with.evaluations);
        let found: Vec<f32> =
            layered.iter().flat_map(|band| band.depths.clone().expect("asked for")).collect();
        assert_same(&format!("bands with {memory:?} bytes"), &whole, &found);
        let mut charged = layered.iter().flat_map(|band| band.charged.as_deref().expect("asked for"));
        assert!(charged.any(|charge| *charge > 0.0), "it is an adaptive picture");
    }
}

#[test]
fn progress_goes_to_the_end_and_depths_are_cancelled() {
    let scene = prepare(&scenes::plain(11, 128, 96));
    let mut renderer = open(&GpuOptions::default());
    let layers = BandLayers { charges: false, depths: true };
    let mut last = 0.0;
    let mut follow = |share: f32| {
        assert!((0.0..=1.0).contains(&share) && share >= last, "{share} after {last}");
        last = share;
        ControlFlow::Continue(())
    };
    let mut take = |_: Band| ControlFlow::Continue(());
    renderer.render_bands(&scene, 48, layers, &mut follow, &mut take).expect("it is rendered");
    assert!(last >= 0.75, "the depths of the last band count: {last}");
    let mut stop =
        |share: f32| if share >= 0.25 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let result = renderer.render_bands(&scene, 48, layers, &mut stop, &mut take);
    assert!(matches!(result, Err(RenderError::Cancelled)), "{result:?}");
    let result = renderer.render_depths(&scene, &mut |_| ControlFlow::Break(()));
    assert!(matches!(result, Err(RenderError::Cancelled)), "{result:?}");
    let plain = scenes::plain(11, 128, 96);
    assert!(largest(&errors(&plain, &depths_by(&mut renderer, &plain))) <= 1e-6);
}
