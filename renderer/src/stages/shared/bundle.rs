//! What the shaders share that take a workgroup for each bundle (`bundle.wgsl`).

use std::ops::Range;

use bytemuck::{Pod, Zeroable};

use super::{ParticleStore, TransferTables};
use crate::camera::Slices;
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu};
use crate::sampling::Sampling;
use crate::stages::grid::Grid;

/// `Chunk` of `bundle.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Chunk {
    first_turn: u32,
    end_turn: u32,
    stride: u32,
    budget: f32,
    relaxation: f32,
    super_pixels: u32,
    between: u32,
    padding: u32,
}

/// The first bindings of these shaders, in their order.
pub(crate) const BUNDLE_BINDINGS: [Access; 12] = {
    use Access::{Read, Texture, Uniform, Write};
    [Uniform, Uniform, Uniform, Read, Read, Read, Read, Read, Read, Read, Texture, Write]
};

/// Which bundles a submission takes, the depths of the layers, and what is counted.
pub(crate) struct Bundles {
    chunk: Buffer,
    /// Depth of the middle of each layer of cells, from the eye and from the pivot, in device units.
    layer_depth: Buffer,
    counters: Buffer,
}

/// What the shaders counted since the last clearing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counters {
    /// Evaluations of the casting, and those of them with a weight above zero where that is counted.
    pub evaluations: u64,
    pub inside: u64,
    /// Evaluations of the analysis.
    pub bounds: u64,
    /// Largest charge to any ray.
    pub largest_charge: f32,
    /// Cells sampled as a whole or in part, shown without a sample, and with nothing to be seen.
    pub full: u64,
    pub mixed: u64,
    pub super_pixel: u64,
    pub transparent: u64,
    /// Cells sampled at levels 1 to 4.
    pub z_adaptive: [u64; 4],
}

impl Counters {
    /// Cells of all classes.
    pub(crate) fn cells(&self) -> u64 {
        self.full + self.mixed + self.super_pixel + self.transparent + self.z_adaptive.iter().sum::<u64>()
    }
}

const COUNTER_WORDS: u64 = 16;

impl Bundles {
    pub(crate) fn new(gpu: &Gpu) -> Bundles {
        Bundles {
            chunk: Buffer::uniform::<Chunk>(gpu, "chunk of bundles"),
            layer_depth: Buffer::storage(gpu, "layer depths", 8),
            counters: Buffer::storage(gpu, "counters", 4 * COUNTER_WORDS),
        }
    }

    /// Prepares the depths of the layers, from the eye and from `pivot_depth`, in units of `unit`.
    pub(crate) fn write_slices(
        &mut self,
        gpu: &Gpu,
        slices: &Slices,
        pivot_depth: f64,
        unit: f64,
    ) -> Result<(), RenderError> {
        let middle = |layer: u64| slices.depth((16 * layer + 8) as f64);
        let depths: Vec<[f32; 2]> = (0..slices.layers())
            .map(|layer| [middle(layer), middle(layer) - pivot_depth].map(|depth| (depth / unit) as f32))
            .collect();
        self.layer_depth.write(gpu, &depths)
    }

    /// Says which bundles of a tile the next submission takes: those whose `turns` it is, where turn t is that
    /// of bundle t·`stride` mod their number; and how they are sampled.
    pub(crate) fn write_chunk(
        &mut self,
        gpu: &Gpu,
        turns: Range<u64>,
        stride: u32,
        sampling: &Sampling,
    ) -> Result<(), RenderError> {
        let chunk = Chunk {
            first_turn: turns.start as u32,
            end_turn: turns.end as u32,
            stride,
            budget: sampling.budget().unwrap_or(0.0),
            relaxation: sampling.relaxation,
            super_pixels: sampling.super_pixels.into(),
            between: sampling.between() as u32,
            padding: 0,
        };
        self.chunk.write(gpu, &[chunk])
    }

    /// Resources for [`BUNDLE_BINDINGS`].
    pub(crate) fn bindings<'a>(
        &'a self,
        [frame, tile]: [&'a Buffer; 2],
        store: &'a ParticleStore,
        grid: &'a Grid,
        transfer: &'a TransferTables,
    ) -> Vec<wgpu::BindingResource<'a>> {
        let mut resources: Vec<_> = [
            frame,
            tile,
            &self.chunk,
            &store.projected,
            &store.weights,
            &store.quantities,
            &grid.cells,
            &grid.pairs,
            &self.layer_depth,
            &transfer.buckets,
        ]
        .map(Buffer::binding)
        .into();
        resources.push(wgpu::BindingResource::TextureView(&transfer.nodes));
        resources.push(self.counters.binding());
        resources
    }

    pub(crate) fn clear_counters(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(self.counters.raw(), 0, None);
    }

    pub(crate) fn read_counters(&self, gpu: &Gpu) -> Result<Counters, RenderError> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let words = self.counters.read_back(gpu, &mut encoder, 1);
        gpu.queue.submit([encoder.finish()]);
        let words: Vec<u32> = words.take(gpu)?;
        let wide = |low: usize| u64::from(words[low]) | u64::from(words[low + 1]) << 32;
        Ok(Counters {
            evaluations: wide(0),
            inside: wide(2),
            bounds: wide(4),
            largest_charge: f32::from_bits(words[6]),
            full: words[8].into(),
            mixed: words[9].into(),
            super_pixel: words[10].into(),
            transparent: words[11].into(),
            z_adaptive: std::array::from_fn(|level| words[12 + level].into()),
        })
    }
}

/// A stride by which every stretch of turns visits bundles from all over the picture: near the golden
/// ratio of their number, and coprime to it, so that every bundle has its turn once.
pub(crate) fn spread(bundles: u64) -> u32 {
    // The product with a turn has to fit 32 bits.
    let limit = u64::from(u32::MAX) / bundles.max(1);
    let wanted = ((bundles as f64 * 0.618) as u64).clamp(1, limit);
    (1..=wanted).rev().find(|&stride| gcd(stride, bundles) == 1).unwrap_or(1) as u32
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::shared::{BUNDLE_WGSL, FRAME_WGSL, Fields, TRANSFER_WGSL};

    #[test]
    fn every_bundle_has_its_turn_once() {
        for bundles in [1, 2, 3, 4, 6, 48, 660, 4096, 10_007, 131_072] {
            let stride = u64::from(spread(bundles));
            let mut seen = vec![false; bundles as usize];
            for turn in 0..bundles {
                let product = u32::try_from(turn * stride).expect("32 bits, as in the shader");
                let bundle = u64::from(product) % bundles;
                assert!(!std::mem::replace(&mut seen[bundle as usize], true));
            }
        }
    }
    use crate::stages::layout::check_layout;

    #[test]
    fn chunks_lie_as_the_shader_expects() {
        let source = [FRAME_WGSL, Fields::One.wgsl(), BUNDLE_WGSL, TRANSFER_WGSL].concat();
        check_layout!(
            &source,
            "Chunk",
            Chunk,
            first_turn,
            end_turn,
            stride,
            budget,
            relaxation,
            super_pixels,
            between,
            padding
        );
    }
}
