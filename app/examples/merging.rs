//! What merging neighbouring cells (HPG 2016, Sec. 6.2) would save, beside what leaving out bricks saves:
//! references to particles that the casting reads, once for each cell that takes samples.
//!
//! ```text
//! cargo run --release -p sphcast --example merging -- FILE VIEW.json 512x512 0.004
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::ops::{ControlFlow, Range};
use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, bail};
use renderer::{
    Bound, BrickWidth, BundleCells, CellClass, CellMap, Gpu, GpuOptions, GridCell, Renderer, Scene, View,
};
use sphcast::frames::Sequence;
use sphcast::{scene, view_file};

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, view, size, tolerance] = arguments.as_slice() else {
        bail!("expected FILE VIEW.json WxH TOLERANCE");
    };
    let mut view = view_file::read(Path::new(view))?;
    let (width, height) = size.split_once('x').context("expected a size like 512x512")?;
    (view.image.width, view.image.height) = (width.parse()?, height.parse()?);
    view.sampling.tolerance = Some(tolerance.parse()?);
    view.sampling.always_adaptive = true;
    view.sampling.brick_width = BrickWidth::Two;
    let frame =
        Sequence::open(&[file.into()])?.sources()[0].load(&Default::default()).context(file.clone())?;
    let particles = Arc::new(scene::particles(&frame, view.particles.support_radius)?);
    let quantity = Arc::new(scene::quantity(&frame, &particles, &view.quantity)?);
    let scene = |view: &View| Scene::new(particles.clone(), quantity.clone(), view);

    let mut renderer = Renderer::new(Gpu::new(&GpuOptions::default())?)?;
    let cells = Cells::new(renderer.inspect_grid(&scene(&view)?)?);
    println!("full sampling: {} references in {} cells", cells.all(), cells.0.len());
    for (name, bound, relaxation) in [
        ("ours", Bound::Difference, 0.0),
        ("the paper's bound", Bound::Paper, 0.0),
        ("the paper's bound, relaxed", Bound::Paper, 1.0),
    ] {
        (view.sampling.bound, view.sampling.relaxation) = (bound, relaxation);
        let (_, map) = renderer.render_with_cells(&scene(&view)?, &mut |_| ControlFlow::Continue(()))?;
        let share = |count: usize| 100.0 * count as f64 / cells.all() as f64;
        let [read, merged] = cells.read(&map);
        println!("{name}: {:.1} % of them are read, {:.1} % with cells merged", share(read), share(merged));
    }
    Ok(())
}

/// Particles of every filled cell, by bundle and layer.
struct Cells(BTreeMap<([u32; 2], u32), Vec<u32>>);

impl Cells {
    fn new(cells: Vec<GridCell>) -> Cells {
        Cells(cells.into_iter().map(|cell| ((cell.bundle, cell.layer), cell.particles)).collect())
    }

    fn all(&self) -> usize {
        self.0.values().map(Vec::len).sum()
    }

    /// References read for a picture as it is, and if cells along a ray that are sampled at level l were merged
    /// by up to 2^l, without duplicates, so that each still takes 16 samples a ray.
    fn read(&self, map: &CellMap) -> [usize; 2] {
        let mut read = [0; 2];
        for (number, bundle) in (0..).zip(&map.bundles) {
            let place = [number % map.count[0], number / map.count[0]];
            let levels: BTreeMap<u32, u8> = levels(bundle).collect();
            read[0] += levels.keys().map(|layer| self.0[&(place, *layer)].len()).sum::<usize>();
            let most = 1 << MOST_LEVEL;
            let runs = (0..map.layers.div_ceil(most)).map(|run| run * most..(run + 1) * most);
            read[1] += runs.map(|run| self.merged(place, &levels, run, MOST_LEVEL)).sum::<usize>();
        }
        read
    }

    /// References of a run of 2^`level` layers, merged where all its cells are sampled at that level or above.
    fn merged(&self, bundle: [u32; 2], levels: &BTreeMap<u32, u8>, run: Range<u32>, level: u8) -> usize {
        let mut sampled = levels.range(run.clone());
        if level == 0 || sampled.all(|(_, own)| *own >= level) {
            let layers = levels.range(run).map(|(layer, _)| *layer);
            return layers.flat_map(|layer| &self.0[&(bundle, layer)]).collect::<BTreeSet<_>>().len();
        }
        let middle = run.start.midpoint(run.end);
        self.merged(bundle, levels, run.start..middle, level - 1)
            + self.merged(bundle, levels, middle..run.end, level - 1)
    }
}

const MOST_LEVEL: u8 = 4;

/// Layers of the cells that take samples, with their levels.
fn levels(bundle: &BundleCells) -> impl Iterator<Item = (u32, u8)> {
    bundle.cells.iter().filter_map(|cell| match cell.class {
        CellClass::ZAdaptive(level) => Some((cell.layer, level)),
        CellClass::Full | CellClass::Mixed if cell.sampled.count() > 0 => Some((cell.layer, 0)),
        _ => None,
    })
}
