//! References of each cell in an order that only the particles' places decide, so that sums over them
//! are the same in every run. The grid leaves them as its lanes came by.

use super::grid::Grid;
use super::shared::{FRAME_WGSL, ParticleStore};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription, Room};
use crate::plan::TileLimits;

pub(crate) struct Order {
    batches: Pipeline,
    large: Pipeline,
    /// Cells that are left from the batches.
    left: Buffer,
}

/// A cell that is left from the batches has more references than this (`MOST_ALIKE` of `batches.wgsl`).
const MOST_ALIKE: u64 = 12;

impl Order {
    pub(crate) fn new(gpu: &Gpu) -> Order {
        use Access::{Read, Uniform, Write};
        let pipeline = |entry_point, source| {
            Pipeline::new(
                gpu,
                &PipelineDescription {
                    label: entry_point,
                    sources: &[FRAME_WGSL, include_str!("place.wgsl"), source],
                    entry_point,
                    constants: &[],
                    bindings: &[Uniform, Read, Read, Write, Write, Write],
                },
            )
        };
        Order {
            batches: pipeline("order_batches", include_str!("batches.wgsl")),
            large: pipeline("order_large", include_str!("large.wgsl")),
            left: Buffer::storage(gpu, "cells left to be ordered", 4),
        }
    }

    /// Makes room for the cells that may be left, where there is room for `pairs` references.
    pub(crate) fn reserve(&mut self, gpu: &Gpu, pairs: u64) -> Result<(), RenderError> {
        self.left.reserve(gpu, pairs / MOST_ALIKE)
    }

    /// Records the ordering of most cells of a tile of `bundles` bundles; how many are left is counted
    /// in the grid's totals.
    pub(crate) fn record_batches(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        tile: &Buffer,
        store: &ParticleStore,
        grid: &Grid,
        bundles: u64,
    ) {
        self.batches.dispatch(gpu, pass, &self.bindings(tile, store, grid), bundles);
    }

    /// Records the ordering of the `cells` cells that are left.
    pub(crate) fn record_left(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        tile: &Buffer,
        store: &ParticleStore,
        grid: &Grid,
        cells: u64,
    ) {
        self.large.dispatch(gpu, pass, &self.bindings(tile, store, grid), cells);
    }

    fn bindings<'a>(
        &'a self,
        tile: &'a Buffer,
        store: &'a ParticleStore,
        grid: &'a Grid,
    ) -> [wgpu::BindingResource<'a>; 6] {
        [tile, &store.projected, &grid.cells, &grid.pairs, &grid.totals, &self.left].map(Buffer::binding)
    }

    /// The buffer, and its most elements under `limits`.
    pub(crate) fn room(&mut self, limits: &TileLimits) -> Room<'_> {
        (&mut self.left, limits.pairs / MOST_ALIKE)
    }
}
