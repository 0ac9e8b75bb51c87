//! What is read back about the cells of a picture: their classes, what is charged to their rays, and
//! all that is known of one bundle.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use reference::device::{open, prepare, render, shared};
use reference::guarantee::{ROUNDING, calm, case, prepare_anyway};
use reference::scenes::{self, Scene, grey};
use renderer::{
    Bound, BundleDetail, CellClass, CellMap, GpuOptions, KnownValues, Picture, RenderError, Renderer,
    column_of,
};

fn go_on(_: f32) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn map_of(renderer: &mut Renderer, scene: &renderer::Scene) -> (Picture, CellMap) {
    renderer.render_with_cells(scene, &mut go_on).unwrap_or_else(|error| panic!("{error}"))
}

fn detail(renderer: &mut Renderer, scene: &renderer::Scene, bundle: [u32; 2]) -> BundleDetail {
    renderer.inspect_bundle(scene, bundle, &mut go_on).unwrap_or_else(|error| panic!("{error}"))
}

/// Scenes with cells of every class, and at full sampling.
fn some_scenes() -> Vec<Scene> {
    let mut full = calm(20, 57, 43);
    full.view.sampling.tolerance = None;
    let mut opaque = calm(28, 57, 43);
    opaque.view.transfer.points = vec![grey(0.0, 0.3, 0.9), grey(1.0, 0.8, 0.9)];
    opaque.view.transfer.reference_length = opaque.view.transfer.reference_length.map(|l| 0.05 * l);
    let scenes = [calm(20, 97, 72), calm(21, 33, 21), full, opaque, coarse(), by_intervals(1.0)];
    (0..12).map(case).chain(scenes).collect()
}

/// Nothing may be shown unsampled, but bricks may be sampled once for their four slices.
fn coarse() -> Scene {
    let mut scene = calm(29, 57, 43);
    scene.view.sampling.super_pixels = false;
    scene.name = "without super-pixels".to_owned();
    scene
}

/// By the paper's bound.
fn by_intervals(relaxation: f64) -> Scene {
    let mut scene = calm(30, 57, 43);
    (scene.view.sampling.bound, scene.view.sampling.relaxation) = (Bound::Paper, relaxation);
    scene.view.sampling.tolerance = Some(0.05);
    scene.view.sampling.super_pixels = false;
    scene.name = format!("by intervals, relaxed {relaxation}");
    scene
}

#[test]
fn classes_are_counted_as_in_the_statistics() {
    let mut seen = [0_u64; CellClass::ALL.len()];
    for scene in some_scenes() {
        let (picture, map) = map_of(&mut shared(), &prepare_anyway(&scene));
        assert_eq!(map.classes(), picture.stats.cells_by_class, "{}", scene.name);
        assert_eq!(map.bundles.len() as u64, picture.stats.bundles, "{}", scene.name);
        let cells = || map.bundles.iter().flat_map(|bundle| &bundle.cells);
        assert_eq!(cells().count() as u64, picture.stats.cells, "{}", scene.name);
        cells().for_each(|cell| seen[cell.class.index()] += 1);
    }
    for class in [CellClass::Full, CellClass::Mixed, CellClass::SuperPixel, CellClass::Transparent] {
        assert!(seen[class.index()] > 0, "{class:?} is never met: {seen:?}");
    }
    assert!(seen[CellClass::Occluded.index()] > 0, "{seen:?}");
    assert!(seen[CellClass::ZAdaptive(2).index()] > 0 && seen[2..6].iter().sum::<u64>() > 100, "{seen:?}");
}

#[test]
fn the_largest_charge_is_the_predicted_error() {
    for scene in some_scenes() {
        let (picture, map) = map_of(&mut shared(), &prepare_anyway(&scene));
        let charges = map.bundles.iter().flat_map(|bundle| bundle.charged);
        let largest = f64::from(charges.fold(0.0, f32::max));
        assert_eq!(largest, picture.stats.predicted_error, "{}", scene.name);
    }
}

#[test]
fn cells_hold_the_particles_of_the_grid() {
    for scene in some_scenes() {
        let prepared = prepare_anyway(&scene);
        let (_, map) = map_of(&mut shared(), &prepared);
        let grid = shared().inspect_grid(&prepared).unwrap();
        let expected: BTreeMap<_, _> =
            grid.iter().map(|cell| ((cell.bundle, cell.layer), cell.particles.len())).collect();
        let mut found = BTreeMap::new();
        for (index, bundle) in (0..).zip(&map.bundles) {
            assert!(bundle.cells.is_sorted_by_key(|cell| cell.layer), "{}", scene.name);
            let place = [index % map.count[0], index / map.count[0]];
            found.extend(bundle.cells.iter().map(|cell| ((place, cell.layer), cell.particles as usize)));
        }
        assert_eq!(found, expected, "{}", scene.name);
    }
}

/// No pixel is farther from full sampling than what is charged to its own column.
fn assert_charged_for(scene: &Scene) {
    let mut renderer = shared();
    let prepared = prepare_anyway(scene);
    let mut unadapted = prepared.clone();
    unadapted.sampling.tolerance = None;
    let full = render(&mut renderer, &unadapted);
    let (picture, map) = map_of(&mut renderer, &prepared);
    for (index, (full, adaptive)) in (0..).zip(full.pixels.iter().zip(&picture.pixels)) {
        let pixel = [index % picture.width, index / picture.width];
        let error = full.iter().zip(adaptive).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
        let charged = f64::from(map.charged(pixel));
        assert!(
            error <= charged + ROUNDING,
            "{}: pixel {pixel:?} is off by {error}, not {charged}",
            scene.name
        );
    }
}

#[test]
fn no_pixel_is_farther_off_than_its_column_is_charged() {
    let scenes = [calm(20, 97, 72), coarse(), by_intervals(0.0)];
    (0..40).map(case).chain(scenes).for_each(|scene| assert_charged_for(&scene));
}

#[test]
fn little_memory_makes_the_same_map() {
    for scene in [calm(20, 97, 72), calm(24, 40, 30), case(3), case(8)] {
        let prepared = prepare_anyway(&scene);
        let (_, whole) = map_of(&mut shared(), &prepared);
        let mut little = open(&GpuOptions { memory: Some(1 << 20), ..GpuOptions::default() });
        let (picture, tiled) = map_of(&mut little, &prepared);
        assert_eq!(tiled.classes(), picture.stats.cells_by_class, "{}", scene.name);
        assert!(tiled == whole, "{}", scene.name);
        // Asked again, the picture is known and its cells are not.
        assert!(map_of(&mut little, &prepared).1 == whole, "{}", scene.name);
        for bundle in [[0, 0], whole.count.map(|count| count / 2), whole.count.map(|count| count - 1)] {
            let expected = detail(&mut shared(), &prepared, bundle);
            assert_eq!(detail(&mut little, &prepared, bundle), expected, "{}", scene.name);
        }
    }
}

#[test]
fn a_bundle_in_several_tiles_behind_each_other_is_put_together() {
    let mut deep = scenes::plain(121, 17, 9);
    deep.view.camera.as_mut().expect("plain scenes have a camera").near = Some(0.01);
    deep.view.sampling.rate = 8.0;
    deep.view.sampling.tolerance = Some(0.01);
    let prepared = prepare_anyway(&deep);
    let mut little = open(&GpuOptions { memory: Some(192 << 10), ..GpuOptions::default() });
    let (picture, map) = map_of(&mut little, &prepared);
    assert_eq!(map.classes(), picture.stats.cells_by_class);
    let largest = map.bundles.iter().flat_map(|bundle| bundle.charged).fold(0.0, f32::max);
    assert_eq!(f64::from(largest), picture.stats.predicted_error);
    let cells: Vec<_> = detail(&mut little, &prepared, [1, 0]).cells.into_iter().map(|c| c.cell).collect();
    assert_eq!(cells, map.bundle([1, 0]).cells);
}

#[test]
fn looking_at_cells_costs_the_next_picture_nothing() {
    let mut renderer = shared();
    let prepared = prepare(&calm(25, 57, 43));
    let first = render(&mut renderer, &prepared);
    let (second, map) = map_of(&mut renderer, &prepared);
    detail(&mut renderer, &prepared, [2, 1]);
    let third = render(&mut renderer, &prepared);
    assert!(first.pixels == second.pixels && first.pixels == third.pixels, "it is the same picture");
    assert_eq!([second.stats.milliseconds.total, third.stats.milliseconds.total], [0.0, 0.0]);
    // And a picture that shares its grid still does.
    let mut other = prepared.clone();
    other.sampling.tolerance = Some(0.001);
    let (changed, changed_map) = map_of(&mut renderer, &other);
    assert_eq!((changed.stats.milliseconds.grid, changed.stats.evaluations.bounds), (0.0, 0));
    assert_ne!(map, changed_map);
    // A grid that was looked at meanwhile is another one.
    renderer.inspect_grid(&prepare(&calm(26, 57, 43))).unwrap();
    assert!(map_of(&mut renderer, &other).1 == changed_map);
}

#[test]
fn a_cancelled_map_leaves_no_trace() {
    let mut renderer = shared();
    let prepared = prepare(&calm(27, 57, 43));
    let cancelled = renderer.render_with_cells(&prepared, &mut |_| ControlFlow::Break(()));
    assert!(matches!(cancelled, Err(RenderError::Cancelled)), "{:?}", cancelled.err());
    let (picture, map) = map_of(&mut renderer, &prepared);
    assert_eq!(map.classes(), picture.stats.cells_by_class);
}

/// What the cells of a bundle charge to a column, one by one, and the rest behind its end.
fn assert_charges_add_up(name: &str, detail: &BundleDetail, budget: f32) {
    for column in 0..16 {
        let cells: f32 = detail.cells.iter().map(|cell| cell.charged(column)).sum();
        let (all, slack) = (detail.charged[column], 1e-4 * budget);
        assert!(cells <= all + slack && all <= budget + slack, "{name}: column {column}: {cells} of {all}");
    }
}

#[test]
fn a_bundle_in_detail_is_what_the_map_says_of_it() {
    for scene in some_scenes() {
        let prepared = prepare_anyway(&scene);
        let (_, map) = map_of(&mut shared(), &prepared);
        for place in [[0, 0], map.count.map(|count| count / 2), map.count.map(|count| count - 1)] {
            let detail = detail(&mut shared(), &prepared, place);
            let bundle = map.bundle(place);
            let cells: Vec<_> = detail.cells.iter().map(|cell| cell.cell).collect();
            assert_eq!((&cells, detail.end_layer), (&bundle.cells, bundle.end_layer), "{}", scene.name);
            assert_eq!((detail.charged, detail.layers), (bundle.charged, map.layers), "{}", scene.name);
            if let Some(budget) = detail.budget.filter(|_| detail.bound == Bound::Difference) {
                assert_charges_add_up(&scene.name, &detail, budget);
            }
        }
    }
}

#[test]
fn bricks_are_bounded_inside_their_cell() {
    let mut covered_bricks = 0;
    for scene in some_scenes() {
        let prepared = prepare_anyway(&scene);
        let detail = detail(&mut shared(), &prepared, [2, 2]);
        for cell in &detail.cells {
            assert!(cell.depths[0] < cell.depths[1], "{}", scene.name);
            let Some(bricks) = &cell.bricks else { continue };
            let KnownValues::Between { low: least, high: greatest, .. } = cell.values else {
                panic!("{}: bricks are known and their cell is not", scene.name)
            };
            for brick in bricks.iter().flatten() {
                let KnownValues::Between { low, high, covered } = brick.opacity.values else { continue };
                let slack = 1e-5;
                assert!(least - slack <= low && low <= high && high <= greatest + slack, "{}", scene.name);
                covered_bricks += u32::from(covered);
            }
        }
    }
    assert!(covered_bricks > 100, "{covered_bricks}");
}

#[test]
fn the_papers_bound_is_known_slab_by_slab() {
    let prepared = prepare_anyway(&by_intervals(1.0));
    let by_slabs = detail(&mut shared(), &prepared, [2, 2]);
    assert!(by_slabs.cells.iter().all(|cell| cell.bricks.is_none()));
    let mut ours = prepared.clone();
    ours.sampling.bound = Bound::Difference;
    let by_bricks = detail(&mut shared(), &ours, [2, 2]);
    let mut between = 0;
    for (slabs, bricks) in by_slabs.cells.iter().zip(&by_bricks.cells) {
        assert_eq!((slabs.cell.layer, slabs.depths), (bricks.cell.layer, bricks.depths));
        assert!(slabs.slabs.is_some() && bricks.slabs.is_none() && bricks.bricks.is_some());
        let [KnownValues::Between { low: a, high: b, .. }, KnownValues::Between { low: c, high: d, .. }] =
            [slabs.values, bricks.values]
        else {
            continue;
        };
        // Both have the extremes of the same particles.
        assert!((a - c).abs() < 1e-4 && (b - d).abs() < 1e-4, "[{a}, {b}] and [{c}, {d}]");
        between += 1;
    }
    assert!(between > 5, "{between}");
}

#[test]
fn a_full_picture_charges_nothing() {
    let mut scene = calm(20, 57, 43);
    scene.view.sampling.tolerance = None;
    let (_, map) = map_of(&mut shared(), &prepare_anyway(&scene));
    assert!(map.bundles.iter().all(|bundle| bundle.charged == [0.0; 16]));
    assert!(map.bundles.iter().flat_map(|bundle| &bundle.cells).all(|cell| cell.class == CellClass::Full));
    let inside = (0..8).flat_map(|y| (0..8).map(move |x| column_of([x, y])));
    assert_eq!(
        inside.fold([0; 16], |mut counts, column| {
            counts[column] += 1;
            counts
        }),
        [4; 16]
    );
}
