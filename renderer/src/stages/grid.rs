//! The view-aligned sparse grid (HPG 2016, Sec. 6.1): which particles each cell needs.
//!
//! By a counting sort; `benches/grid_sort` measures it against the paper's sort of pairs.

use bytemuck::{Pod, Zeroable};

use super::scan::Scan;
use super::shared::{FRAME_WGSL, ParticleStore};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription, Room, Timing};
use crate::plan::{Tile, TileLimits};

/// Builds the grid of one tile at a time.
pub struct Grid {
    counting: Pipeline,
    scattering: Pipeline,
    sums: Scan,
    /// Where the references of each cell end, cells along a ray side by side.
    pub cells: Buffer,
    /// Particles of each cell, in the order in which the device came by them; `order` has another.
    pub pairs: Buffer,
    /// [`Totals`].
    pub totals: Buffer,
}

/// What is counted while the grid of a tile is built and ordered.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Totals {
    /// References in all, cells that hold any.
    pub pairs: u32,
    pub cells: u32,
    /// Cells that are left to be ordered one by one, and references of the largest of them.
    pub left_cells: u32,
    pub largest_cell: u32,
    /// Most references of a bundle in cells that are no crowds.
    pub busiest_bundle: u32,
    padding: [u32; 3],
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
            counting: pipeline("count"),
            scattering: pipeline("scatter"),
            sums: Scan::new(gpu),
            cells: Buffer::storage(gpu, "cells", 4),
            pairs: Buffer::storage(gpu, "cell-particle pairs", 4),
            totals: Buffer::storage(gpu, "grid totals", size_of::<Totals>() as u64),
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
        let mut result = Ok(());
        timing.pass(encoder, "grid", |pass| {
            self.count(gpu, pass, uniforms, store);
            result = self.scan(gpu, pass, tile.cells());
            self.scatter(gpu, pass, uniforms, store);
        });
        result
    }

    /// References of each cell; `cells` and `totals` must be zero before.
    pub fn count(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        uniforms: [&Buffer; 2],
        store: &ParticleStore,
    ) {
        self.walk(&self.counting, gpu, pass, uniforms, store);
    }

    /// From the references of each of `cells` cells to where they begin.
    pub fn scan(&mut self, gpu: &Gpu, pass: &mut wgpu::ComputePass, cells: u64) -> Result<(), RenderError> {
        self.sums.record(gpu, pass, &self.cells, &self.totals, cells)
    }

    /// References to their places.
    pub fn scatter(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        uniforms: [&Buffer; 2],
        store: &ParticleStore,
    ) {
        self.walk(&self.scattering, gpu, pass, uniforms, store);
    }

    fn walk(
        &self,
        pipeline: &Pipeline,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        [frame, tile]: [&Buffer; 2],
        store: &ParticleStore,
    ) {
        let buffers = [frame, tile, &store.projected, &self.cells, &self.pairs].map(Buffer::binding);
        pipeline.dispatch(gpu, pass, &buffers, store.count().div_ceil(256));
    }

    /// The buffers, and the most elements of each under `limits`.
    pub(crate) fn rooms(&mut self, limits: &TileLimits) -> [Room<'_>; 2] {
        [(&mut self.cells, Scan::buffer_length(limits.cells)), (&mut self.pairs, limits.pairs)]
    }
}
