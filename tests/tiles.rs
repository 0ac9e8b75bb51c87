//! A device with little memory renders in tiles, and renders the same picture.

use std::ops::ControlFlow;

use reference::Particle;
use reference::compare::compare;
use reference::device::{mismatch, open, picture, prepare, render};
use reference::guarantee::{calm, prepare_anyway};
use reference::picture::Image;
use reference::random::Random;
use reference::scenes::{self, Scene, Shape, grey};
use renderer::{
    Band, BandLayers, Bound, GpuOptions, Kernel, OpacityView, Picture, RenderError, Renderer, TooLarge,
    TransferFunction,
};

/// Bytes that a tile may take: from a few tiles to a single bundle a tile.
const MEMORY: [u64; 3] = [1 << 20, 256 << 10, 192 << 10];

fn little(memory: u64) -> Renderer {
    open(&GpuOptions { memory: Some(memory), ..GpuOptions::default() })
}

fn scenes() -> Vec<Scene> {
    let mut deep = scenes::plain(121, 17, 9);
    let camera = deep.view.camera.as_mut().expect("plain scenes have a camera");
    camera.near = Some(0.01);
    deep.view.sampling.rate = 8.0;
    deep.name = "many layers".to_owned();
    let mut dense = scenes::plain(122, 64, 48);
    dense.particles.iter_mut().for_each(|particle| particle.support_radius *= 3.0);
    dense.name = "many references".to_owned();
    let mut scenes = vec![scenes::plain(120, 64, 48), deep, dense];
    let shapes = [Shape::JitteredLattice, Shape::Sheet, Shape::MixedRadii, Shape::Dust];
    scenes.extend(shapes.into_iter().zip(123..).map(|(shape, seed)| {
        let mut scene = scenes::random(seed, shape, [33, 21], Kernel::ALL[seed as usize % 3]);
        // No spikes and steps, of which the order of sums could make something visible.
        scene.view.transfer.points = scenes::plain_view(1, 1).transfer.points;
        scene
    }));
    scenes
}

#[test]
fn little_memory_makes_the_same_pictures() {
    let scenes = scenes();
    let whole: Vec<Image<f32>> = scenes.iter().map(picture).collect();
    for memory in MEMORY {
        let mut renderer = little(memory);
        for (scene, whole) in scenes.iter().zip(&whole) {
            let tiled = Image::from(&render(&mut renderer, &prepare(scene)));
            let comparison = compare(whole, &tiled);
            assert!(comparison.max <= 1e-4, "{} with {memory} bytes: {comparison}", scene.name);
        }
    }
}

#[test]
fn tiled_pictures_match_the_twin() {
    let mut renderer = little(192 << 10);
    for scene in scenes() {
        let image = Image::from(&render(&mut renderer, &prepare(&scene)));
        let mismatch = mismatch(&scene, &image);
        assert!(mismatch.is_none(), "{}", mismatch.unwrap_or_default());
    }
}

/// The bounds of all cells do not fit, and are made for some bundles after the other.
#[test]
fn little_memory_adapts_as_much_does() {
    let scene = prepare_anyway(&calm(61, 97, 72));
    let [mut much, mut little] = [open(&GpuOptions::default()), little(8 << 20)];
    for tolerance in [0.01, 0.003] {
        let mut scene = scene.clone();
        scene.sampling.tolerance = Some(tolerance);
        let mut found = [&mut much, &mut little].map(|renderer| {
            let cells = renderer.render_with_cells(&scene, &mut |_| ControlFlow::Continue(()));
            let (picture, map) = cells.unwrap_or_else(|error| panic!("{error}"));
            let bundle = renderer.inspect_bundle(&scene, [6, 4], &mut |_| ControlFlow::Continue(()));
            (picture, map, bundle.unwrap_or_else(|error| panic!("{error}")))
        });
        let [(picture, map, bundle), (tiled, tiled_map, tiled_bundle)] = &mut found;
        let adapted = picture.stats.cells - picture.stats.cells_by_class.full;
        assert!(adapted > 1000, "more cells than fit are adapted: {adapted}");
        assert!(tiled.stats.gpu_bytes < picture.stats.gpu_bytes, "{} bytes", tiled.stats.gpu_bytes);
        assert_eq!(tiled.pixels, picture.pixels);
        // Where there is room, bounds stay from one picture to the next.
        let cast = |picture: &Picture| picture.stats.evaluations.done - picture.stats.evaluations.bounds;
        assert_eq!(cast(tiled), cast(picture));
        assert_eq!(tiled_map, map);
        assert_eq!(tiled_bundle.charged, bundle.charged);
        assert_eq!(tiled_bundle.cells.len(), bundle.cells.len());
    }
}

/// Whole bands and a last one that is lower, with as much memory as tiles and bands like, and with little.
#[test]
fn bands_are_rows_of_the_picture() {
    let go_on = |_: f32| ControlFlow::Continue(());
    let mut scene = prepare_anyway(&calm(62, 97, 75));
    scene.sampling.tolerance = Some(0.003);
    let (whole, map) = open(&GpuOptions::default()).render_with_cells(&scene, &mut { go_on }).unwrap();
    for mut renderer in [open(&GpuOptions::default()), little(8 << 20)] {
        let mut rows = Vec::new();
        let mut take = |band: Band| {
            assert_eq!(band.first_row as usize * 97, rows.len());
            let charged = band.charged.expect("they are asked for");
            rows.extend(band.pixels.into_iter().zip(charged));
            ControlFlow::Continue(())
        };
        let layers = BandLayers { charges: true, ..BandLayers::default() };
        let stats = renderer.render_bands(&scene, 30, layers, &mut { go_on }, &mut take).unwrap();
        assert_eq!(rows.len(), 97 * 75);
        for (place, (pixel, charge)) in rows.iter().enumerate() {
            let at = [place as u32 % 97, place as u32 / 97];
            let far = (0..4).map(|c| (pixel[c] - whole.pixels[place][c]).abs()).fold(0.0, f32::max);
            assert!(far <= 1e-4, "pixel {at:?} is {far} from that of the whole picture");
            assert_eq!(*charge, map.charged(at), "pixel {at:?}");
        }
        assert!(rows.iter().any(|(_, charge)| *charge > 0.0));
        assert_eq!(stats.bundles, whole.stats.bundles);
        let sampled = |stats: &renderer::Stats| stats.evaluations.done - stats.evaluations.bounds;
        assert_eq!(sampled(&stats), sampled(&whole.stats));
        // The next picture is not misled by what is left of the bands.
        assert_eq!(render(&mut renderer, &scene).pixels.len(), rows.len());
    }
}

#[test]
fn who_takes_the_bands_may_end_them() {
    let scene = prepare(&scenes::plain(133, 40, 40));
    let mut renderer = open(&GpuOptions::default());
    let mut taken = 0;
    let mut take = |_: Band| {
        taken += 1;
        ControlFlow::Break(())
    };
    let result = renderer.render_bands(
        &scene,
        8,
        BandLayers::default(),
        &mut |_| ControlFlow::Continue(()),
        &mut take,
    );
    assert!(matches!(result, Err(RenderError::Cancelled)), "{result:?}");
    assert_eq!(taken, 1);
}

#[test]
fn large_and_small_scenes_in_turn() {
    let mut renderer = little(192 << 10);
    let mut small = scenes::plain(130, 33, 21);
    small.particles.truncate(100);
    let scenes = [scenes::plain(131, 33, 21), small];
    let prepared = scenes.each_ref().map(prepare);
    for (scene, prepared) in scenes.iter().zip(&prepared).cycle().take(6) {
        let image = Image::from(&render(&mut renderer, prepared));
        let mismatch = mismatch(scene, &image);
        assert!(mismatch.is_none(), "{}", mismatch.unwrap_or_default());
        // Another transfer function on whatever the device still holds.
        let (mut other, mut held) = (scene.clone(), prepared.clone());
        other.view.transfer.points = vec![grey(0.0, 0.1, 0.3), grey(0.4, 0.9, 0.02), grey(1.0, 0.2, 0.2)];
        held.transfer = TransferFunction::new(&other.view.transfer.points).expect("points are in order");
        let image = Image::from(&render(&mut renderer, &held));
        let mismatch = reference::device::mismatch(&other, &image);
        assert!(mismatch.is_none(), "{}", mismatch.unwrap_or_default());
    }
}

/// The scene in all the ways that need other arrays than those of the picture before.
fn kinds(name: &str, scene: &renderer::Scene) -> Vec<(String, renderer::Scene)> {
    let with = |kind: &str, change: &dyn Fn(&mut renderer::Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        (format!("{name}, {kind}"), scene)
    };
    vec![
        with("as it is", &|_| ()),
        with("the paper's bound", &|scene| scene.sampling.bound = Bound::Paper),
        with("from another side", &|scene| scene.camera.near *= 1.01),
        with("in full", &|scene| scene.sampling.tolerance = None),
    ]
}

/// Pictures of all kinds one after the other, by one device that is left no time to forget.
#[test]
fn all_that_is_held_stays_within_the_memory() {
    let few = calm(137, 97, 72);
    let mut many = few.clone();
    let mut random = Random::new(137);
    many.particles.extend((0..12_000).map(|_| Particle {
        position: random.in_cube(),
        support_radius: 0.02,
        ..few.particles[0]
    }));
    // As many as have half of the memory.
    many.particles.truncate(9300);
    let mut two_fields = few.clone();
    two_fields.view.quantity.opacity =
        Some(OpacityView { range: Some([0.0, 1.0]), ..OpacityView::default() });
    let mut scenes = Vec::new();
    for (name, scene) in [("few", few), ("many", many), ("two fields", two_fields)] {
        scenes.extend(kinds(name, &prepare_anyway(&scene)));
    }
    let memory = 1 << 20;
    let mut renderer = little(memory);
    let mut most = 0;
    let mut holds = |name: &str, held: u64| {
        assert!(held <= memory, "{held} of {memory} bytes for {name}");
        most = most.max(held);
    };
    // Forwards and backwards, so that each kind follows others that need more and less.
    for (name, scene) in scenes.iter().chain(scenes.iter().rev()) {
        holds(name, render(&mut renderer, scene).stats.gpu_bytes);
    }
    let layers = BandLayers { depths: true, charges: true };
    let go_on = |_: f32| ControlFlow::Continue(());
    let (name, scene) = &scenes[0];
    let bands = renderer.render_bands(scene, 40, layers, &mut { go_on }, &mut |_| ControlFlow::Continue(()));
    holds(name, bands.unwrap_or_else(|error| panic!("{error}")).gpu_bytes);
    assert!(4 * most > 3 * memory, "pictures make use of the memory: {most} of {memory} bytes");
}

#[test]
fn crowded_cells_take_several_tiles() {
    let mut random = Random::new(134);
    let mut crowded = scenes::plain(134, 24, 17);
    crowded.particles = (0..20_000)
        .map(|_| Particle { position: random.in_cube(), quantity: random.unit(), ..crowded.particles[0] })
        .collect();
    let whole = picture(&crowded);
    // Room for the particles of the largest cell, but not for all.
    let tiled = Image::from(&render(&mut little(4 << 20), &prepare(&crowded)));
    let comparison = compare(&whole, &tiled);
    assert!(comparison.max <= 1e-4, "{comparison}");
}

/// A cell with more particles than a tile may hold.
fn crowd() -> Scene {
    let mut crowd = scenes::plain(132, 8, 8);
    crowd.particles.iter_mut().for_each(|particle| particle.position *= 0.01);
    crowd
}

#[test]
fn too_little_memory_is_an_error_and_the_next_picture_is_right() {
    let mut renderer = little(32 << 10);
    let result = renderer.render(&prepare(&crowd()), &mut |_| ControlFlow::Continue(()));
    assert!(matches!(result, Err(RenderError::TooLarge(_))), "{result:?}");
    let mut scene = scenes::plain(133, 33, 21);
    scene.particles.truncate(100);
    let mismatch = mismatch(&scene, &Image::from(&render(&mut renderer, &prepare(&scene))));
    assert!(mismatch.is_none(), "{}", mismatch.unwrap_or_default());
}

#[test]
fn an_error_of_memory_says_how_much_would_do() {
    let scene = prepare(&crowd());
    let result = little(32 << 10).render(&scene, &mut |_| ControlFlow::Continue(()));
    let Err(RenderError::TooLarge(TooLarge { needed, limit, .. })) = result else { panic!("{result:?}") };
    assert!(needed > limit, "{needed} are said to be more than {limit}");
}
