//! Full-sampling ray casting (HPG 2016, Alg. 2).

use std::ops::Range;

use bytemuck::{Pod, Zeroable};

use super::grid::Grid;
use super::shared::{FRAME_WGSL, KERNEL_WGSL, ParticleStore, TRANSFER_WGSL, TransferTables};
use crate::camera::Slices;
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};
use crate::kernel::Kernel;
use crate::plan::Tile;

/// `Chunk` of `cast.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Chunk {
    first_turn: u32,
    end_turn: u32,
    stride: u32,
    padding: u32,
}

pub(crate) struct Cast {
    /// One a kernel.
    pipelines: Vec<Pipeline>,
    chunk: Buffer,
    /// Depth of the middle of each layer of cells, from the eye and from the pivot, in device units.
    layer_depth: Buffer,
    /// Premultiplied linear RGB and transparency, 64 pixels a bundle.
    pub pixels: Buffer,
    /// Evaluations, and those with a weight above zero where they are counted: low and high words.
    pub counters: Buffer,
}

impl Cast {
    /// `count_inside`: count evaluations with a weight above zero too, which costs time.
    pub(crate) fn new(gpu: &Gpu, count_inside: bool) -> Cast {
        use Access::{Read, Texture, Uniform, Write};
        let pipeline = |kernel: &Kernel| {
            Pipeline::new(
                gpu,
                &PipelineDescription {
                    label: "cast",
                    sources: &[FRAME_WGSL, KERNEL_WGSL, TRANSFER_WGSL, include_str!("cast.wgsl")],
                    entry_point: "cast_rays",
                    constants: &[
                        ("KERNEL", f64::from(kernel.code())),
                        ("COUNT_INSIDE", f64::from(u8::from(count_inside))),
                    ],
                    bindings: &[
                        Uniform, Uniform, Uniform, Read, Read, Read, Read, Read, Read, Read, Write, Write,
                        Texture,
                    ],
                },
            )
        };
        Cast {
            pipelines: Kernel::ALL.iter().map(pipeline).collect(),
            chunk: Buffer::uniform::<Chunk>(gpu, "cast chunk"),
            layer_depth: Buffer::storage(gpu, "layer depths", 8),
            pixels: Buffer::storage(gpu, "pixels", 16),
            counters: Buffer::storage(gpu, "evaluation counters", 16),
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

    /// Makes room for the pixels of `tile`.
    pub(crate) fn reserve(&mut self, gpu: &Gpu, tile: &Tile) -> Result<(), RenderError> {
        self.pixels.reserve(gpu, tile.bundles() * 64)
    }

    /// Says which bundles of the tile the next submission casts: those whose `turns` it is.
    pub(crate) fn write_chunk(
        &mut self,
        gpu: &Gpu,
        turns: Range<u64>,
        bundles: u64,
    ) -> Result<(), RenderError> {
        // A GPU takes its workgroups as it gets done with others, and neighbours share particles in
        // its caches. A software adapter gives each thread a stretch of them beforehand.
        let stride = if gpu.is_software() { spread(bundles) } else { 1 };
        let chunk = Chunk { first_turn: turns.start as u32, end_turn: turns.end as u32, stride, padding: 0 };
        self.chunk.write(gpu, &[chunk])
    }

    /// Records the casting of `bundles` bundles: as many as [`Cast::write_chunk`] named.
    #[expect(clippy::too_many_arguments, reason = "one for each thing the shader reads")]
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        kernel: Kernel,
        uniforms: [&Buffer; 2],
        store: &ParticleStore,
        grid: &Grid,
        transfer: &TransferTables,
        bundles: u64,
    ) {
        let [frame, tile] = uniforms;
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
            &self.pixels,
            &self.counters,
        ]
        .map(Buffer::binding)
        .into();
        resources.push(wgpu::BindingResource::TextureView(&transfer.nodes));
        self.pipelines[kernel.code() as usize].dispatch(gpu, pass, &resources, bundles);
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.pixels.bytes() + self.layer_depth.bytes()
    }
}

/// A stride by which every stretch of turns visits bundles from all over the picture: near the golden
/// ratio of their number, and coprime to it, so that every bundle has its turn once.
fn spread(bundles: u64) -> u32 {
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
        let source = [FRAME_WGSL, KERNEL_WGSL, TRANSFER_WGSL, include_str!("cast.wgsl")].concat();
        check_layout!(&source, "Chunk", Chunk, first_turn, end_turn, stride, padding);
    }
}
