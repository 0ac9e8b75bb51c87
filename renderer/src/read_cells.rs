//! Reads back, on demand, what became of the cells of a picture.
//!
//! A picture of one tile has left everything on the device, and looking at it disturbs nothing. For
//! one of several tiles they are cast once more, and read one by one.

use std::ops::Range;

use crate::camera::{CELL_SLICES, Slices};
use crate::cell_map::{
    Brick, BrickMask, BundleCells, BundleDetail, COLUMNS, CellBricks, CellClass, CellDetail, CellMap,
    FieldInBrick, KnownValues, MapCell,
};
use crate::error::RenderError;
use crate::picture::Picture;
use crate::plan::{self, Tile};
use crate::renderer::{CastTile, Progress, Renderer};
use crate::sampling::{Bound, BrickWidth};
use crate::scene::Scene;
use crate::stages::adapt::CellBounds;
use crate::stages::adapt::entries::{
    BundleEntry, COVERED, CellEntry, ColumnValues, FIRST_SLOT, Offers, WHOLE_KNOWN,
};
use crate::stages::cast::CROWD;
use crate::stages::shared::Fields;
use crate::stats::Milliseconds;
use crate::tiles::Job;

/// Bytes that are read back at once, about; and no more than this part of the memory.
const READ_AT_ONCE: u64 = 32 << 20;
const READ_PART: u64 = 64;

impl Renderer {
    /// Like [`Renderer::render`], and tells what became of every cell.
    pub fn render_with_cells(
        &mut self,
        scene: &Scene,
        progress: &mut Progress,
    ) -> Result<(Picture, CellMap), RenderError> {
        let slices = Slices::new(&scene.camera, scene.height, scene.rate);
        let mut map = CellMap::new([scene.width, scene.height], slices.layers() as u32);
        if let Some(picture) = self.known_picture(scene)
            && let Some((_, tile)) = self.held(scene)?
        {
            self.read_tile(&tile, &mut map)?;
            return Ok((picture, map));
        }
        let picture = self.render_anew(scene, progress, Some(&mut map))?;
        Ok((picture, map))
    }

    /// All that is known of the bundle in column and row `bundle`, once `scene` is rendered. Where the
    /// picture is not on the device any more, the bundle alone is cast again.
    pub fn inspect_bundle(
        &mut self,
        scene: &Scene,
        bundle: [u32; 2],
        progress: &mut Progress,
    ) -> Result<BundleDetail, RenderError> {
        if self.knows(scene)
            && let Some((job, tile)) = self.held(scene)?
        {
            let mut detail = blank(&job, bundle);
            self.read_detail(&job, &tile, bundle, &mut detail)?;
            return Ok(detail);
        }
        let result = self.cast_bundle(scene, bundle, progress);
        if result.is_err() {
            self.forget();
        }
        result
    }

    /// The job and the only tile of `scene`, where all that was found out about it is on the device.
    fn held<'a>(&mut self, scene: &'a Scene) -> Result<Option<(Job<'a>, Tile)>, RenderError> {
        let mut job = self.begin(scene)?;
        let tiles = plan::tiles(Renderer::bundles(scene), job.slices.count, job.limits);
        let [tile] = tiles[..] else { return Ok(None) };
        job.only_tile = job.resident;
        Ok(self.is_held(&job).then_some((job, tile)))
    }

    /// Casts one bundle, a tile of its own or several behind one another: the layers of each tile of the last
    /// picture, sampled as that was, where it is of this scene.
    fn cast_bundle(
        &mut self,
        scene: &Scene,
        bundle: [u32; 2],
        progress: &mut Progress,
    ) -> Result<BundleDetail, RenderError> {
        let job = self.begin(scene)?;
        let mut detail = blank(&job, bundle);
        let mut scratch = self.blank(scene, &job.slices);
        let mut todo = self.columns_of(scene, bundle);
        if todo.is_empty() {
            todo.push((Tile { first: bundle, count: [1, 1], first_layer: 0, layers: detail.layers }, None));
        }
        while let Some((tile, pays)) = todo.pop() {
            match self.prepare_tile(&job, &tile, &mut Milliseconds::default())? {
                Ok(size) => {
                    self.cast_tile(&job, &tile, size, pays, progress, &mut scratch)?;
                    self.read_detail(&job, &tile, bundle, &mut detail)?;
                }
                Err(too_large) => todo.extend(self.halves(&tile, too_large)?.map(|half| (half, pays))),
            }
        }
        Ok(detail)
    }

    /// The parts of a bundle that were cast in one tile of the last picture, the first one at the end, and
    /// whether they were sampled as an analysis chose.
    fn columns_of(&self, scene: &Scene, bundle: [u32; 2]) -> Vec<(Tile, Option<bool>)> {
        let holds =
            |tile: &Tile| (0..2).all(|i| (tile.first[i]..tile.first[i] + tile.count[i]).contains(&bundle[i]));
        let column =
            |cast: &CastTile| (Tile { first: bundle, count: [1, 1], ..cast.tile }, Some(cast.adapted));
        self.tiles_of(scene).iter().rev().filter(|cast| holds(&cast.tile)).map(column).collect()
    }

    /// Reads what became of the cells of `tile`, which is on the device.
    pub(crate) fn read_tile(&self, tile: &Tile, map: &mut CellMap) -> Result<(), RenderError> {
        let bundle_bytes = u64::from(tile.layers) * size_of::<CellEntry>() as u64;
        let most = (READ_AT_ONCE.min(self.gpu.memory / READ_PART) / bundle_bytes).max(1);
        let mut first = 0;
        while first < tile.bundles() {
            let end = tile.bundles().min(first + most);
            for (index, read) in (first..).zip(self.read_bundles(tile, first..end)?) {
                read.append_to(tile, map.bundle_mut(tile.place_of(index)));
            }
            first = end;
        }
        Ok(())
    }

    /// Reads the cells of the tile's bundles in a range.
    fn read_bundles(&self, tile: &Tile, bundles: Range<u64>) -> Result<Vec<ReadBundle>, RenderError> {
        let layers = u64::from(tile.layers);
        let cells = bundles.start * layers..bundles.end * layers;
        // Where the references of the first cell begin is where those of the one before it end.
        let before = cells.start.saturating_sub(1);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let ends = self.grid.cells.read_range(&self.gpu, &mut encoder, before..cells.end);
        let adapted = self.adapted.then(|| {
            let entries = self.adapt.cell_values.read_range(&self.gpu, &mut encoder, cells.clone());
            let bundles = self.adapt.bundle_entries.read_range(&self.gpu, &mut encoder, bundles.clone());
            (entries, bundles)
        });
        self.gpu.queue.submit([encoder.finish()]);

        let mut ends: Vec<u32> = ends.take(&self.gpu)?;
        if cells.start == 0 {
            ends.insert(0, 0);
        }
        let counts: Vec<u32> = ends.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let (entries, bundle_entries): (Vec<CellEntry>, Vec<BundleEntry>) = match adapted {
            Some((entries, bundles)) => (entries.take(&self.gpu)?, bundles.take(&self.gpu)?),
            None => (Vec::new(), Vec::new()),
        };
        let layers = layers as usize;
        let chunk = |number: usize| number * layers..(number + 1) * layers;
        let read = |number: usize| ReadBundle {
            counts: counts[chunk(number)].to_vec(),
            adapted: bundle_entries.get(number).map(|&entry| (entry, entries[chunk(number)].to_vec())),
            column_width: self.column_width,
        };
        Ok((0..counts.len() / layers).map(read).collect())
    }

    /// Reads all that is known of one bundle of `tile`, which is on the device.
    fn read_detail(
        &self,
        job: &Job,
        tile: &Tile,
        bundle: [u32; 2],
        detail: &mut BundleDetail,
    ) -> Result<(), RenderError> {
        let [x, y] = [0, 1].map(|axis| u64::from(bundle[axis] - tile.first[axis]));
        let index = y * u64::from(tile.count[0]) + x;
        let read = self.read_bundles(tile, index..index + 1)?.remove(0);
        let mut summary = BundleCells { charged: detail.charged, ..BundleCells::default() };
        let entries: Vec<CellEntry> = read.filled_entries().collect();
        read.append_to(tile, &mut summary);
        (detail.end_layer, detail.charged) = (summary.end_layer, summary.charged);
        if self.adapted {
            detail.budget = job.scene.sampling.budget();
        }

        let mut details = Vec::new();
        for (number, cell) in summary.cells.into_iter().enumerate() {
            let depth = |layer: u32| job.slices.depth(f64::from(CELL_SLICES * layer));
            let entry = entries.get(number).filter(|entry| entry.slot >= WHOLE_KNOWN);
            details.push(CellDetail {
                depths: [depth(cell.layer), depth(cell.layer + 1)],
                cell,
                values: entry.map_or(KnownValues::Unknown, |entry| KnownValues::of(entry.values)),
                bricks: None,
                shown: None,
                slabs: None,
            });
        }
        match detail.bound {
            Bound::Difference => self.add_bricks(&entries, job.scene.quantity.fields(), &mut details)?,
            Bound::Paper => self.add_slabs(&entries, &mut details)?,
        }
        detail.cells.append(&mut details);
        Ok(())
    }

    /// Adds the bricks where they are known.
    fn add_bricks(
        &self,
        entries: &[CellEntry],
        fields: Fields,
        cells: &mut [CellDetail],
    ) -> Result<(), RenderError> {
        let known = || entries.iter().map(|entry| entry.slot).filter(|slot| *slot >= FIRST_SLOT);
        let mut bricks = self.read_bricks(&known().collect::<Vec<u32>>(), fields)?.into_iter();
        for (cell, entry) in cells.iter_mut().zip(entries) {
            (cell.bricks, cell.shown) = (entry.slot >= FIRST_SLOT).then(|| bricks.next()).flatten().unzip();
        }
        Ok(())
    }

    /// Adds the slabs where they are known.
    fn add_slabs(&self, entries: &[CellEntry], cells: &mut [CellDetail]) -> Result<(), RenderError> {
        // A crowded cell has a place for its slabs, at which they are not looked at.
        let known =
            |cell: &CellDetail, entry: &CellEntry| entry.slot >= FIRST_SLOT && cell.cell.particles <= CROWD;
        let pairs = || cells.iter().zip(entries).filter(|(cell, entry)| known(cell, entry));
        let places: Vec<u64> = pairs().map(|(_, entry)| u64::from(entry.slot - FIRST_SLOT)).collect();
        let places: Vec<Range<u64>> = places.into_iter().map(|place| place..place + 1).collect();
        let mut bounds = Vec::new();
        if !places.is_empty() {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            let copy = self.adapt.intervals().read_ranges(&self.gpu, &mut encoder, &places);
            self.gpu.queue.submit([encoder.finish()]);
            bounds = copy.take(&self.gpu)?;
        }
        let mut bounds = bounds.into_iter();
        for (cell, entry) in cells.iter_mut().zip(entries) {
            let of_cell: Option<CellBounds> = known(cell, entry).then(|| bounds.next()).flatten();
            let slabs = of_cell.map(|bounds| bounds.values.map(KnownValues::of));
            cell.values = slabs.map_or(KnownValues::Unknown, |slabs| KnownValues::of_all(&slabs));
            cell.slabs = slabs.map(Box::new);
        }
        Ok(())
    }

    /// Reads the bricks of cells with these slots, and what stands for their columns.
    fn read_bricks(&self, slots: &[u32], fields: Fields) -> Result<Vec<ReadBricks>, RenderError> {
        let columns = self.column_width.columns();
        let places: Vec<Range<u64>> = slots
            .iter()
            .map(|slot| u64::from(slot - FIRST_SLOT) * columns as u64)
            .map(|first| first..first + columns as u64)
            .collect();
        if places.is_empty() {
            return Ok(Vec::new());
        }
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let fields = fields.count();
        let of_fields: Vec<_> = places.iter().map(|range| range.start * fields..range.end * fields).collect();
        let values = self.adapt.bricks.read_ranges(&self.gpu, &mut encoder, &of_fields);
        let offers = self.adapt.offers.read_ranges(&self.gpu, &mut encoder, &places);
        let shows = self.adapt.shows.read_ranges(&self.gpu, &mut encoder, &places);
        self.gpu.queue.submit([encoder.finish()]);
        let values: Vec<ColumnValues> = values.take(&self.gpu)?;
        let offers: Vec<Offers> = offers.take(&self.gpu)?;
        let shows: Vec<[f32; 4]> = shows.take(&self.gpu)?;
        // What is known of a wider column is so of each of the columns in it.
        let parts = COLUMNS / columns;
        let column = |place: usize| {
            let fields = &values[place * fields as usize..(place + 1) * fields as usize];
            let in_brick = |field: &ColumnValues, brick| field.of_brick(brick, self.column_width);
            std::array::from_fn(|brick| Brick {
                opacity: in_brick(&fields[fields.len() - 1], brick),
                colour: (fields.len() > 1).then(|| in_brick(&fields[0], brick)),
                charge: offers[place].to_show(brick),
                coarse_charge: offers[place].to_coarsen(brick),
            })
        };
        let cell = |number: usize| {
            let bricks = std::array::from_fn(|c| column(number * columns + c / parts));
            let shown = std::array::from_fn(|c| shows[number * columns + c / parts]);
            (Box::new(bricks), Box::new(shown))
        };
        Ok((0..slots.len()).map(cell).collect())
    }
}

/// The bricks of a cell, and what stands for each of its columns where none is sampled.
type ReadBricks = (Box<CellBricks>, Box<[[f32; 4]; COLUMNS]>);

/// A bundle of which nothing is known yet.
fn blank(job: &Job, bundle: [u32; 2]) -> BundleDetail {
    let layers = job.slices.layers() as u32;
    let (bound, charged) = (job.scene.sampling.bound, [0.0; COLUMNS]);
    BundleDetail { bundle, layers, end_layer: 0, bound, budget: None, charged, cells: Vec::new() }
}

/// A bundle of a tile as it is on the device.
struct ReadBundle {
    /// Particles of each layer's cell.
    counts: Vec<u32>,
    /// What the analysis left; `None` at full sampling.
    adapted: Option<(BundleEntry, Vec<CellEntry>)>,
    column_width: BrickWidth,
}

impl ReadBundle {
    /// Entries of the cells that hold particles.
    fn filled_entries(&self) -> impl Iterator<Item = CellEntry> {
        let entries = self.adapted.as_ref().map_or(&[][..], |(_, entries)| entries);
        entries.iter().zip(&self.counts).filter(|(_, count)| **count > 0).map(|(entry, _)| *entry)
    }

    /// Puts what was read of `tile` behind what is known of the layers in front of it.
    fn append_to(&self, tile: &Tile, bundle: &mut BundleCells) {
        bundle.end_layer = tile.first_layer + tile.layers;
        if let Some((entry, _)) = &self.adapted {
            bundle.end_layer = tile.first_layer + entry.end_layer;
            bundle.charged = entry.charged;
        }
        let filled = (0..).zip(&self.counts).filter(|(_, count)| **count > 0);
        bundle.cells.extend(filled.map(|(layer, &particles)| self.cell(tile, layer, particles)));
    }

    fn cell(&self, tile: &Tile, layer: u32, particles: u32) -> MapCell {
        let (class, sampled, coarse) = match &self.adapted {
            None => (CellClass::Full, BrickMask::ALL, BrickMask::default()),
            // What the entry says is of an earlier choice.
            Some((bundle, _)) if layer >= bundle.end_layer => {
                (CellClass::Occluded, BrickMask::default(), BrickMask::default())
            }
            Some((_, entries)) => {
                let CellEntry { class_index, sampled, coarse, .. } = entries[layer as usize];
                let [sampled, coarse] =
                    [sampled, coarse].map(|words| BrickMask::from_device(words, self.column_width));
                (CellClass::of_counter(class_index), sampled, coarse)
            }
        };
        MapCell { layer: tile.first_layer + layer, particles, class, sampled, coarse }
    }
}

impl ColumnValues {
    fn of_brick(&self, brick: usize, width: BrickWidth) -> FieldInBrick {
        let values = KnownValues::of([self.low[brick], self.high[brick]]);
        FieldInBrick { values, slope: self.slope(brick, width) }
    }
}

impl KnownValues {
    /// From the two numbers of a brick or a cell on the device.
    fn of([low, high]: [f32; 2]) -> KnownValues {
        if low < 0.0 {
            return KnownValues::Empty;
        }
        let covered = high >= COVERED;
        // The sum with COVERED may have lost half a unit of its last place.
        let high = if covered { (high - COVERED + 3e-7).min(1.0) } else { high };
        KnownValues::Between { low: low.min(high), high, covered }
    }

    /// What is known of parts together.
    fn of_all(parts: &[KnownValues]) -> KnownValues {
        let join = |all, part: &KnownValues| match (all, *part) {
            (KnownValues::Unknown, _) | (_, KnownValues::Unknown) => KnownValues::Unknown,
            // A part without a particle leaves the bounds as they are.
            (KnownValues::Between { low, high, .. }, KnownValues::Empty)
            | (KnownValues::Empty, KnownValues::Between { low, high, .. }) => {
                KnownValues::Between { low, high, covered: false }
            }
            (
                KnownValues::Between { low: a, high: b, covered: c },
                KnownValues::Between { low: d, high: e, covered: f },
            ) => KnownValues::Between { low: a.min(d), high: b.max(e), covered: c && f },
            (KnownValues::Empty, KnownValues::Empty) => KnownValues::Empty,
        };
        parts.iter().skip(1).fold(parts[0], join)
    }
}
