//! The view-aligned sparse grid (HPG 2016, Sec. 6.1): which particles each cell needs.

use super::scan::Scan;
use super::shared::{FRAME_WGSL, ParticleStore};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription, Timing};
use crate::plan::Tile;

/// Builds the grid of one tile at a time.
pub(crate) struct Grid {
    count: Pipeline,
    scatter: Pipeline,
    scan: Scan,
    /// Where the references of each cell end, cells along a ray side by side.
    pub cells: Buffer,
    /// Particles of each cell, in no particular order.
    pub pairs: Buffer,
    /// References in all, cells that hold any.
    pub totals: Buffer,
}

impl Grid {
    pub(crate) fn new(gpu: &Gpu) -> Grid {
        use Access::{Read, Uniform, Write};
        let pipeline = |entry_point| {
            Pipeline::new(
                gpu,
                &PipelineDescription {
                    label: entry_point,
                    sources: &[FRAME_WGSL, include_str!("grid.wgsl")],
                    entry_point,
                    constants: &[],
                    bindings: &[Uniform, Uniform, Read, Write, Write],
                },
            )
        };
        Grid {
            count: pipeline("count"),
            scatter: pipeline("scatter"),
            scan: Scan::new(gpu),
            cells: Buffer::storage(gpu, "cells", 4),
            pairs: Buffer::storage(gpu, "cell-particle pairs", 4),
            totals: Buffer::storage(gpu, "grid totals", 16),
        }
    }

    /// Makes room for the cells of `tile`.
    pub(crate) fn reserve(&mut self, gpu: &Gpu, tile: &Tile) -> Result<(), RenderError> {
        self.cells.reserve(gpu, Scan::buffer_length(tile.cells()))
    }

    /// Records the grid of `tile` for the projected particles of `store`. References beyond the
    /// capacity of `pairs` are counted in `totals` but not written.
    pub(crate) fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        timing: &Timing,
        uniforms: [&Buffer; 2],
        store: &ParticleStore,
        tile: &Tile,
    ) -> Result<(), RenderError> {
        encoder.clear_buffer(self.cells.raw(), 0, None);
        encoder.clear_buffer(self.totals.raw(), 0, None);
        let [frame, tile_uniform] = uniforms;
        let workgroups = store.count().div_ceil(256);
        let mut result = Ok(());
        timing.pass(encoder, "grid", |pass| {
            let buffers =
                [frame, tile_uniform, &store.projected, &self.cells, &self.pairs].map(Buffer::binding);
            self.count.dispatch(gpu, pass, &buffers, workgroups);
            result = self.scan.record(gpu, pass, &self.cells, &self.totals, tile.cells());
            self.scatter.dispatch(gpu, pass, &buffers, workgroups);
        });
        result
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.cells.bytes() + self.pairs.bytes()
    }
}
