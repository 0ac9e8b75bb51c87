//! The grid stage from inside, for `benches/`: no part of the crate's interface.
//!
//! Benchmarks see what is public and no more. What they need to take the stage apart, and to build
//! another one beside it from the same parts, is within reach here and nowhere else.

use std::time::Instant;

use bytemuck::Pod;

pub use crate::gpu::{Access, Buffer, Pipeline, PipelineDescription};
pub use crate::stages::grid::Grid;
pub use crate::stages::scan::Scan;
pub use crate::stages::shared::ParticleStore;

use crate::error::RenderError;
use crate::gpu::{Gpu, Timing};
use crate::plan::{self, Tile};
use crate::renderer::Renderer;
use crate::scene::Scene;
use crate::stats::Milliseconds;

/// The grid stage after it has sorted a scene that is one tile: projected particles and uniforms are
/// on the device, and every buffer has the size it needs.
pub struct Sorted {
    pub gpu: Gpu,
    pub clock: Clock,
    pub inputs: Inputs,
    pub grid: Grid,
}

/// What a sort of references into cells starts from.
pub struct Inputs {
    pub frame: Buffer,
    pub tile: Buffer,
    pub store: ParticleStore,
    /// Cells of the tile, empty ones included.
    pub cells: u64,
    /// References in all, and cells that hold any.
    pub pairs: u64,
    pub filled: u64,
}

impl Sorted {
    pub fn new(gpu: Gpu, scene: &Scene) -> Result<Sorted, RenderError> {
        let mut renderer = Renderer::new(gpu)?;
        let job = renderer.begin(scene)?;
        let tiles = plan::tiles(Renderer::bundles(scene), job.slices.count, job.limits);
        let cells = tiles.iter().map(Tile::cells).sum();
        let [tile] = tiles[..] else {
            return Err(RenderError::Device("the scene takes more than one tile".to_owned()));
        };
        let size = renderer.prepare_tile(&job, &tile, &mut Milliseconds::default())??;
        let Renderer { gpu, timing, frame, tile, store, grid, .. } = renderer;
        let inputs = Inputs { frame, tile, store, cells, pairs: size.pairs, filled: size.cells };
        Ok(Sorted { gpu, clock: Clock { timing }, inputs, grid })
    }
}

/// Times passes one by one.
pub struct Clock {
    timing: Timing,
}

impl Clock {
    /// Milliseconds of the pass that `record` records: device time where the adapter has timestamps,
    /// else the host's from submission to end.
    pub fn pass(
        &mut self,
        gpu: &Gpu,
        record: impl FnOnce(&mut wgpu::ComputePass) -> Result<(), RenderError>,
    ) -> Result<f64, RenderError> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut recorded = Ok(());
        self.timing.pass(&mut encoder, "bench", |pass| recorded = record(pass));
        recorded?;
        self.timing.resolve(&mut encoder);
        let begin = Instant::now();
        gpu.queue.submit([encoder.finish()]);
        let times = self.timing.take(gpu)?;
        let host = begin.elapsed().as_secs_f64() * 1e3;
        Ok(if gpu.timestamps { times.iter().map(|(_, time)| time).sum() } else { host })
    }
}

/// Sets buffers to zero.
pub fn clear(gpu: &Gpu, buffers: &[&Buffer]) -> Result<(), RenderError> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    buffers.iter().for_each(|buffer| encoder.clear_buffer(buffer.raw(), 0, None));
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()
}

/// The first `count` elements of a buffer.
pub fn read<T: Pod>(gpu: &Gpu, buffer: &Buffer, count: u64) -> Result<Vec<T>, RenderError> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let readback = buffer.read_back(gpu, &mut encoder, count);
    gpu.queue.submit([encoder.finish()]);
    readback.take(gpu)
}
