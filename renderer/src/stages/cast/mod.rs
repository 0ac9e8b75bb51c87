//! Ray casting (HPG 2016, Alg. 2): at full sampling, or as `adapt` planned it.

use super::adapt::Adapt;
use super::grid::Grid;
use super::shared::{
    BUNDLE_BINDINGS, BUNDLE_WGSL, Bundles, FRAME_WGSL, HULL_WGSL, KERNEL_WGSL, ParticleStore, TRANSFER_WGSL,
    TransferTables,
};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};
use crate::kernel::Kernel;
use crate::plan::Tile;

const SAMPLES_WGSL: &str = include_str!("samples.wgsl");

pub(crate) struct Cast {
    /// One a kernel.
    full: Vec<Pipeline>,
    adaptive: Vec<Pipeline>,
    /// Premultiplied linear RGB and transparency, 64 pixels a bundle.
    pub pixels: Buffer,
}

impl Cast {
    /// `count_inside`: count evaluations with a weight above zero too, which costs time.
    pub(crate) fn new(gpu: &Gpu, count_inside: bool) -> Cast {
        use Access::{Read, Write};
        let pipelines = |entry_point, sources: &[&str], bindings: &[Access]| {
            let pipeline = |kernel: &Kernel| {
                Pipeline::new(
                    gpu,
                    &PipelineDescription {
                        label: entry_point,
                        sources: &[&[FRAME_WGSL, KERNEL_WGSL, BUNDLE_WGSL, TRANSFER_WGSL], sources].concat(),
                        entry_point,
                        constants: &[
                            ("KERNEL", f64::from(kernel.code())),
                            ("COUNT_INSIDE", f64::from(u8::from(count_inside))),
                        ],
                        bindings: &[&BUNDLE_BINDINGS, bindings].concat(),
                    },
                )
            };
            Kernel::ALL.iter().map(pipeline).collect()
        };
        Cast {
            full: pipelines("cast_rays", &[SAMPLES_WGSL, include_str!("full.wgsl")], &[Write]),
            adaptive: pipelines(
                "cast_adaptively",
                &[HULL_WGSL, SAMPLES_WGSL, include_str!("adaptive.wgsl")],
                &[Write, Read, Read, Read],
            ),
            pixels: Buffer::storage(gpu, "pixels", 16),
        }
    }

    /// Makes room for the pixels of `tile`.
    pub(crate) fn reserve(&mut self, gpu: &Gpu, tile: &Tile) -> Result<(), RenderError> {
        self.pixels.reserve(gpu, tile.bundles() * 64)
    }

    /// Records the casting of `count` bundles: as many as [`Bundles::write_chunk`] named. Where there
    /// is a plan, at the sampling that it chose.
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
        plan: Option<&Adapt>,
        count: u64,
    ) {
        let mut resources = bundles.bindings(uniforms, store, grid, transfer);
        resources.push(self.pixels.binding());
        let pipelines = match plan {
            None => &self.full,
            Some(adapt) => {
                resources.extend(adapt.bindings());
                &self.adaptive
            }
        };
        pipelines[kernel.code() as usize].dispatch(gpu, pass, &resources, count);
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.pixels.bytes()
    }
}
