//! Ray casting (HPG 2016, Alg. 2): at full sampling, or as `adapt` chose.
//!
//! At full sampling a workgroup takes a bundle through its cells. Adaptively, the cells that are to be
//! sampled are work of their own, independent of each other, so that a workgroup does one thing: it
//! samples a cell as a whole, or some of its bricks, or more coarsely along the rays. Then the cells of a
//! bundle are put together.

mod crowds;

pub(crate) use crowds::{CROWD, Crowds, portions};

use super::adapt::Adapt;
use super::shared::{BUNDLE_BINDINGS, BUNDLE_WGSL, FRAME_WGSL, HULL_WGSL, KERNEL_WGSL, TRANSFER_WGSL};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};
use crate::kernel::Kernel;
use crate::plan::Tile;
use crate::sampling::Bound;
use crate::scene::Scene;

const PORTIONS_WGSL: &str = include_str!("portions.wgsl");
const SAMPLES_WGSL: &str = include_str!("samples.wgsl");
const WORK_WGSL: &str = include_str!("work.wgsl");

pub(crate) struct Cast {
    /// One a kernel.
    portions: Vec<Pipeline>,
    full: Vec<Pipeline>,
    wholes: Vec<Pipeline>,
    parts: Vec<Pipeline>,
    coarse: Vec<Pipeline>,
    composite: Pipeline,
    pub crowds: Crowds,
    /// Premultiplied linear RGB and transparency, 64 pixels a bundle.
    pub pixels: Buffer,
    /// Colour and opacity of each ray in a sampled cell, 64 a cell.
    segments: Buffer,
}

/// How much of the cells of a submission `adapt` left to be sampled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    /// Cells to be sampled as a whole, and in parts or at a coarser level.
    pub wholes: u64,
    pub parts: u64,
}

impl Cast {
    /// `count_inside`: count evaluations with a weight above zero too, which costs time.
    pub(crate) fn new(gpu: &Gpu, count_inside: bool) -> Cast {
        use Access::{Read, Write};
        let pipeline = |kernel: Kernel, entry_point, sources: &[&str], bindings: &[Access]| {
            let kernel = ("KERNEL", f64::from(kernel.code()));
            let counting = ("COUNT_INSIDE", f64::from(u8::from(count_inside)));
            let some_shown = ("SOME_SHOWN", f64::from(u8::from(sources.contains(&WORK_WGSL))));
            let constants = [kernel, counting, some_shown];
            let used = if sources.contains(&SAMPLES_WGSL) { 3 } else { 1 };
            Pipeline::new(
                gpu,
                &PipelineDescription {
                    label: entry_point,
                    sources: &[&[FRAME_WGSL, KERNEL_WGSL, BUNDLE_WGSL, TRANSFER_WGSL], sources].concat(),
                    entry_point,
                    constants: &constants[..used],
                    bindings: &[&BUNDLE_BINDINGS, bindings].concat(),
                },
            )
        };
        let pipelines = |entry_point, sources: &[&str], bindings: &[Access]| {
            Kernel::ALL.iter().map(|&kernel| pipeline(kernel, entry_point, sources, bindings)).collect()
        };
        Cast {
            portions: pipelines(
                "sum_portions",
                &[PORTIONS_WGSL, SAMPLES_WGSL, include_str!("crowds.wgsl")],
                &[Read, Write],
            ),
            full: pipelines(
                "cast_rays",
                &[PORTIONS_WGSL, SAMPLES_WGSL, include_str!("full.wgsl")],
                &[Read, Write, Write],
            ),
            wholes: pipelines(
                "sample_wholes",
                &[HULL_WGSL, WORK_WGSL, PORTIONS_WGSL, SAMPLES_WGSL, include_str!("whole.wgsl")],
                &[Read, Write, Write, Read, Read, Read, Read, Read],
            ),
            parts: pipelines(
                "sample_parts",
                &[HULL_WGSL, WORK_WGSL, PORTIONS_WGSL, SAMPLES_WGSL, include_str!("parts.wgsl")],
                &[Read, Write, Write, Read, Read, Read, Read, Read],
            ),
            coarse: pipelines(
                "sample_coarsely",
                &[HULL_WGSL, WORK_WGSL, PORTIONS_WGSL, SAMPLES_WGSL, include_str!("coarse.wgsl")],
                &[Read, Write, Write, Read, Read, Read, Read, Read],
            ),
            composite: pipeline(
                Kernel::default(),
                "composite_cells",
                &[HULL_WGSL, include_str!("composite.wgsl")],
                &[Write, Read, Read, Read, Read, Read],
            ),
            crowds: Crowds::new(gpu),
            pixels: Buffer::storage(gpu, "pixels", 16),
            segments: Buffer::storage(gpu, "segments of rays", 16),
        }
    }

    /// Makes room for the pixels of `tile`.
    pub(crate) fn reserve(&mut self, gpu: &Gpu, tile: &Tile) -> Result<(), RenderError> {
        self.pixels.reserve(gpu, tile.bundles() * 64)
    }

    /// Makes room for what `work` leaves.
    pub(crate) fn reserve_segments(&mut self, gpu: &Gpu, work: Work) -> Result<(), RenderError> {
        self.segments.reserve(gpu, (work.wholes + work.parts) * 64)
    }

    /// Records the sums over `portions` portions of crowded cells. `shared`: resources for
    /// [`BUNDLE_BINDINGS`], whose turns are portions here.
    pub(crate) fn record_portions(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        kernel: Kernel,
        shared: &[wgpu::BindingResource],
        portions: u64,
    ) {
        let resources = with(shared, &self.crowds.buffers());
        self.portions[kernel.code() as usize].dispatch(gpu, pass, &resources, portions);
    }

    /// Records full sampling of `bundles` bundles. `shared`: resources for [`BUNDLE_BINDINGS`].
    pub(crate) fn record_full(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        kernel: Kernel,
        shared: &[wgpu::BindingResource],
        bundles: u64,
    ) {
        let [portions, sums] = self.crowds.buffers();
        let resources = with(shared, &[portions, sums, &self.pixels]);
        self.full[kernel.code() as usize].dispatch(gpu, pass, &resources, bundles);
    }

    /// Records the sampling of what `adapt` left of `bundles` bundles, and puts their cells together.
    #[expect(clippy::too_many_arguments, reason = "one for each thing the shaders read")]
    pub(crate) fn record_adaptive(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        scene: &Scene,
        shared: &[wgpu::BindingResource],
        adapt: &Adapt,
        work: Work,
        bundles: u64,
    ) {
        let kernel = scene.kernel.code() as usize;
        // What is not sampled as a whole is bricks, or all of a cell at a coarser level.
        let parts = match scene.sampling.bound {
            Bound::Difference => &self.parts,
            Bound::Paper => &self.coarse,
        };
        let (segments, values) = (&self.segments, &adapt.cell_values);
        let [portions, sums] = self.crowds.buffers();
        let sample = |pipeline: &Pipeline, pass: &mut wgpu::ComputePass, tasks, count| {
            let own = [portions, sums, segments, &adapt.work, tasks, values, &adapt.bricks, &adapt.offers];
            pipeline.dispatch(gpu, pass, &with(shared, &own), count);
        };
        sample(&self.wholes[kernel], pass, &adapt.wholes, work.wholes);
        sample(&parts[kernel], pass, &adapt.parts, work.parts);
        let cells = with(
            shared,
            &[&self.pixels, segments, &adapt.sampled, &adapt.bundle_entries, values, &adapt.shows],
        );
        self.composite.dispatch(gpu, pass, &cells, bundles);
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.pixels.bytes() + self.segments.bytes() + self.crowds.bytes()
    }
}

/// Resources of a shader: the shared ones, then its own.
fn with<'a>(shared: &[wgpu::BindingResource<'a>], own: &[&'a Buffer]) -> Vec<wgpu::BindingResource<'a>> {
    shared.iter().cloned().chain(own.iter().map(|buffer| buffer.binding())).collect()
}
