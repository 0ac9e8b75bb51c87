//! Adaptive sampling: bounds of the quantity in each brick of 2 × 2 rays × 4 slices, and the choice
//! of the bricks that need no samples.
//!
//! The bricks of a cell are found out when a picture first needs them and stay until the grid, the
//! quantity or the kernel changes; the choice is made anew for each picture.

use super::grid::Grid;
use super::shared::{
    BUNDLE_BINDINGS, BUNDLE_WGSL, Bundles, FRAME_WGSL, HULL_WGSL, KERNEL_WGSL, ParticleStore, TRANSFER_WGSL,
    TransferTables,
};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};
use crate::kernel::Kernel;
use crate::plan::Tile;

pub(crate) struct Adapt {
    /// One a kernel.
    pipelines: Vec<Pipeline>,
    /// Number of slots of `bricks` that are taken.
    slots_taken: Buffer,
    /// For each cell its slot of bricks, and bounds over the whole cell.
    cell_values: Buffer,
    /// Bounds of the quantity in the 64 bricks of a cell, slot by slot.
    bricks: Buffer,
    /// For each of the 16 columns of a bundle, what it may show unsampled.
    plan: Buffer,
}

/// Bricks of a cell.
const BRICKS: u64 = 64;
/// Columns of bricks of a bundle.
const COLUMNS: u64 = 16;

impl Adapt {
    pub(crate) fn new(gpu: &Gpu) -> Adapt {
        let pipeline = |kernel: &Kernel| {
            Pipeline::new(
                gpu,
                &PipelineDescription {
                    label: "choose_levels",
                    sources: &[
                        FRAME_WGSL,
                        KERNEL_WGSL,
                        BUNDLE_WGSL,
                        TRANSFER_WGSL,
                        HULL_WGSL,
                        include_str!("bricks.wgsl"),
                        include_str!("levels.wgsl"),
                    ],
                    entry_point: "choose_levels",
                    constants: &[("KERNEL", f64::from(kernel.code()))],
                    bindings: &[&BUNDLE_BINDINGS[..], &[Access::Write; 4]].concat(),
                },
            )
        };
        Adapt {
            pipelines: Kernel::ALL.iter().map(pipeline).collect(),
            slots_taken: Buffer::storage(gpu, "slots taken", 4),
            cell_values: Buffer::storage(gpu, "values of cells", 8),
            bricks: Buffer::storage(gpu, "values of bricks", 4),
            plan: Buffer::storage(gpu, "plan of columns", 8),
        }
    }

    /// Makes room for the analysis of `tile`, of whose cells `filled` hold particles.
    pub(crate) fn reserve(&mut self, gpu: &Gpu, tile: &Tile, filled: u64) -> Result<(), RenderError> {
        self.cell_values.reserve(gpu, tile.cells())?;
        self.bricks.reserve(gpu, filled * BRICKS)?;
        self.plan.reserve(gpu, tile.bundles() * COLUMNS)
    }

    /// Forgets the bounds of all bricks.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(self.slots_taken.raw(), 0, None);
        encoder.clear_buffer(self.cell_values.raw(), 0, None);
    }

    /// Records the analysis of `count` bundles: as many as [`Bundles::write_chunk`] named.
    #[expect(clippy::too_many_arguments, reason = "one for each thing the shader reads")]
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        kernel: Kernel,
        bundles: &Bundles,
        uniforms: [&Buffer; 2],
        store: &ParticleStore,
        grid: &Grid,
        transfer: &TransferTables,
        count: u64,
    ) {
        let mut resources = bundles.bindings(uniforms, store, grid, transfer);
        resources.push(self.slots_taken.binding());
        resources.extend(self.bindings());
        self.pipelines[kernel.code() as usize].dispatch(gpu, pass, &resources, count);
    }

    /// What the analysis leaves to the casting.
    pub(crate) fn bindings(&self) -> [wgpu::BindingResource<'_>; 3] {
        [&self.cell_values, &self.bricks, &self.plan].map(Buffer::binding)
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.cell_values.bytes() + self.bricks.bytes() + self.plan.bytes()
    }
}
