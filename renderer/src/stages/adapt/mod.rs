//! Adaptive sampling: bounds of the quantity in each brick of 4 × 4 or 2 × 2 rays × 4 slices, and the choice
//! of the bricks that need no samples.
//!
//! The bounds of a cell are found out when a picture first needs them and stay until the grid, the
//! quantity or the kernel changes; the choice is made anew for each picture. [`paper`] is another way.

mod paper;

pub(crate) mod entries;
#[cfg(test)]
mod remainder_tests;

use std::collections::BTreeMap;

use super::shared::{
    BUNDLE_BINDINGS, BUNDLE_WGSL, FRAME_WGSL, Fields, HULL_WGSL, KERNEL_WGSL, TASKS_WGSL, TRANSFER_WGSL,
};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription, Readback, Room};
use crate::kernel::Kernel;
use crate::plan::{Contents, Tile, TileLimits};
use crate::sampling::{Bound, BrickWidth, Without};
use crate::scene::Scene;
pub(crate) use paper::CellBounds;
use paper::Paper;

/// Buffers as `levels.wgsl` and `filing.wgsl` describe them.
pub(crate) struct Adapt {
    /// For each kernel; for parts of the method to be left out, and for two fields, where that was asked for.
    pipelines: BTreeMap<Variant, Pipeline>,
    paper: Paper,
    /// For each cell of a tile.
    pub cell_values: Buffer,
    pub sampled: Buffer,
    slots_taken: Buffer,
    /// For each column of a slot, and field.
    pub bricks: Buffer,
    pub offers: Buffer,
    pub shows: Buffer,
    /// For each bundle.
    pub bundle_entries: Buffer,
    /// Lists of cells that are work of their own, of one submission, and how many there are on each.
    pub tasks: Buffer,
    pub work: Buffer,
}

/// A kernel's code, what is left out, how many fields there are, and how wide bricks are.
type Variant = (u32, Without, Fields, BrickWidth);

/// Used by the paper's choice, too.
const LISTING_WGSL: &str = include_str!("listing.wgsl");
const REMAINDER_WGSL: &str = include_str!("remainder.wgsl");

/// Lists of work that a cell may be on one of (`tasks.wgsl`).
pub(crate) const LISTS: u64 = 3;
/// Bytes of the values of a column.
pub(crate) const COLUMN_STRIDE: u64 = size_of::<entries::ColumnValues>() as u64;

impl Adapt {
    pub(crate) fn new(gpu: &Gpu) -> Adapt {
        let complete = |kernel: Kernel| {
            let variant = (kernel.code(), Without::Nothing, Fields::One, BrickWidth::default());
            (variant, pipeline(gpu, variant))
        };
        Adapt {
            pipelines: Kernel::ALL.map(complete).into(),
            paper: Paper::new(gpu),
            cell_values: Buffer::storage(gpu, "values of cells", 32),
            sampled: Buffer::storage(gpu, "sampled cells", 4),
            slots_taken: Buffer::storage(gpu, "slots taken", 4),
            bricks: Buffer::storage(gpu, "values of bricks", COLUMN_STRIDE),
            offers: Buffer::storage(gpu, "offers of bricks", 32),
            shows: Buffer::storage(gpu, "middles of columns", 16),
            bundle_entries: Buffer::storage(gpu, "bundles", 4 * 17),
            tasks: Buffer::storage(gpu, "lists of cells", 8),
            work: Buffer::storage(gpu, "work", 16),
        }
    }

    /// Makes room for the analysis of `tile`, of whose cells `filled` hold particles.
    pub(crate) fn reserve(
        &mut self,
        gpu: &Gpu,
        tile: &Tile,
        filled: u64,
        scene: &Scene,
    ) -> Result<(), RenderError> {
        self.cell_values.reserve(gpu, tile.cells())?;
        self.sampled.reserve(gpu, tile.cells())?;
        self.bundle_entries.reserve(gpu, tile.bundles())?;
        let columns = scene.sampling.column_width().columns() as u64;
        match scene.sampling.bound {
            Bound::Difference => {
                self.bricks.reserve(gpu, filled * columns * scene.quantity.fields().count())?;
                self.offers.reserve(gpu, filled * columns)?;
            }
            Bound::Paper => self.paper.reserve(gpu, filled)?,
        }
        self.shows.reserve(gpu, filled * columns)?;
        self.tasks.reserve(gpu, filled * LISTS)
    }

    /// Has the pipeline for this kernel, this part to be left out, so many fields, and bricks of this width.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        kernel: Kernel,
        without: Without,
        fields: Fields,
        width: BrickWidth,
    ) {
        let variant = (kernel.code(), without, fields, width);
        self.pipelines.entry(variant).or_insert_with(|| pipeline(gpu, variant));
    }

    /// Forgets the bounds of all bricks.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        self.clear_slots(encoder);
        encoder.clear_buffer(self.cell_values.raw(), 0, None);
    }

    /// Lets the bounds of other bricks take the places of those that are known: no cell of theirs is to be
    /// looked at again.
    pub(crate) fn clear_slots(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(self.slots_taken.raw(), 0, None);
    }

    /// Forgets the work of the submission before.
    pub(crate) fn clear_work(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(self.work.raw(), 0, None);
    }

    /// Records the analysis of `bundles` bundles, for which the pipeline is prepared. `shared`: resources
    /// for [`BUNDLE_BINDINGS`].
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        scene: &Scene,
        shared: &[wgpu::BindingResource],
        bundles: u64,
    ) {
        if scene.sampling.bound == Bound::Paper {
            return self.paper.record(gpu, pass, self, shared, bundles);
        }
        let own = [
            &self.cell_values,
            &self.slots_taken,
            &self.bricks,
            &self.offers,
            &self.shows,
            &self.bundle_entries,
            &self.sampled,
            &self.tasks,
            &self.work,
        ]
        .map(Buffer::binding);
        let Scene { kernel, sampling, quantity, .. } = scene;
        let variant = (kernel.code(), sampling.without, quantity.fields(), sampling.brick_width);
        let pipeline = &self.pipelines[&variant];
        pipeline.dispatch(gpu, pass, &[shared, &own].concat(), bundles);
    }

    /// [`CellBounds`] of each slot, where they were chosen by the paper's bound.
    pub(crate) fn intervals(&self) -> &Buffer {
        &self.paper.bounds
    }

    /// Asks for the number of cells on each list.
    pub(crate) fn read_work(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Readback {
        self.work.read_back(gpu, encoder, 1)
    }

    /// The buffers, and the most elements of each under `limits`.
    pub(crate) fn rooms(
        &mut self,
        limits: &TileLimits,
        Contents { fields, bound, column_width, .. }: Contents,
    ) -> Vec<Room<'_>> {
        let filled = limits.filled_cells;
        let columns = column_width.columns() as u64;
        let [of_bricks, of_slabs] = match bound {
            Bound::Difference => [filled * columns, 0],
            Bound::Paper => [0, filled],
        };
        vec![
            (&mut self.cell_values, limits.cells),
            (&mut self.sampled, limits.cells),
            (&mut self.bricks, of_bricks * fields.count()),
            (&mut self.offers, of_bricks),
            (&mut self.paper.bounds, of_slabs),
            (&mut self.shows, filled * columns),
            (&mut self.bundle_entries, limits.bundles),
            (&mut self.tasks, filled * LISTS),
        ]
    }
}

fn pipeline(gpu: &Gpu, (kernel, without, fields, width): Variant) -> Pipeline {
    let left_out = |name, part| (name, f64::from(u8::from(without == part)));
    let description = PipelineDescription {
        label: "choose_levels",
        sources: &[
            FRAME_WGSL,
            KERNEL_WGSL,
            fields.wgsl(),
            BUNDLE_WGSL,
            TRANSFER_WGSL,
            HULL_WGSL,
            TASKS_WGSL,
            fields.bounds_wgsl(),
            include_str!("jets.wgsl"),
            include_str!("cubic.wgsl"),
            include_str!("taylor.wgsl"),
            REMAINDER_WGSL,
            include_str!("bricks.wgsl"),
            include_str!("sheaves.wgsl"),
            expansions_wgsl(fields),
            include_str!("walk.wgsl"),
            include_str!("extremes.wgsl"),
            include_str!("survey.wgsl"),
            include_str!("loading.wgsl"),
            include_str!("values.wgsl"),
            include_str!("offers.wgsl"),
            LISTING_WGSL,
            include_str!("filing.wgsl"),
            include_str!("levels.wgsl"),
        ],
        entry_point: "choose_levels",
        constants: &[
            ("KERNEL", f64::from(kernel)),
            ("COLUMN_SIDE", f64::from(width.rays())),
            left_out("EXTREMES_ONLY", Without::Expansion),
            left_out("NO_COVERAGE", Without::Coverage),
            left_out("FRONT_TO_BACK", Without::GreedFromFront),
            left_out("BACK_TO_FRONT", Without::GreedFromBack),
        ],
        bindings: &[&BUNDLE_BINDINGS[..], &[Access::Write; 9]].concat(),
    };
    Pipeline::new(gpu, &description)
}

/// How the particles of a cell are summed up.
fn expansions_wgsl(fields: Fields) -> &'static str {
    match fields {
        Fields::One => include_str!("one_field.wgsl"),
        Fields::Two => include_str!("two_fields.wgsl"),
    }
}
