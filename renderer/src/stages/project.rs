//! Projection: particles from the world into view space, once for each camera.

use super::shared::{FRAME_WGSL, ParticleStore};
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};

pub(crate) struct Project {
    pipeline: Pipeline,
}

impl Project {
    pub(crate) fn new(gpu: &Gpu) -> Project {
        use Access::{Read, Uniform, Write};
        let pipeline = Pipeline::new(
            gpu,
            &PipelineDescription {
                label: "project",
                sources: &[FRAME_WGSL, include_str!("project.wgsl")],
                entry_point: "project",
                constants: &[],
                bindings: &[Uniform, Read, Read, Write, Write],
            },
        );
        Project { pipeline }
    }

    /// Fills `store.projected` and `store.weights`.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        frame: &Buffer,
        store: &ParticleStore,
    ) {
        let buffers = [frame, &store.high, &store.low, &store.projected, &store.weights].map(Buffer::binding);
        self.pipeline.dispatch(gpu, pass, &buffers, store.count().div_ceil(256));
    }
}
