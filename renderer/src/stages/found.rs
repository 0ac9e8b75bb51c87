//! What a function of the shaders makes of its arguments, on the device, for tests of it.

use bytemuck::Pod;

use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};

/// A function, in WGSL.
pub(crate) struct Function<'a> {
    /// Shaders that the call needs.
    pub sources: &'a [&'a str],
    /// What these read, in the order of their bindings, from 2 on.
    pub resources: &'a [(Access, wgpu::BindingResource<'a>)],
    /// Types of `given` and of the call.
    pub types: [&'a str; 2],
    /// The call, of `given`.
    pub call: &'a str,
}

impl Function<'_> {
    /// What each input gives.
    pub(crate) fn of<I: Pod, O: Pod>(&self, gpu: &Gpu, inputs: &[I]) -> Vec<O> {
        let mut read = Buffer::storage(gpu, "inputs", size_of::<I>() as u64);
        read.write(gpu, inputs).unwrap();
        let mut written = Buffer::storage(gpu, "outputs", size_of::<O>() as u64);
        written.reserve(gpu, inputs.len() as u64).unwrap();
        let accesses = self.resources.iter().map(|(access, _)| *access);
        let bindings: Vec<Access> = [Access::Read, Access::Write].into_iter().chain(accesses).collect();
        let mut sources = self.sources.to_vec();
        let main = self.main();
        sources.push(&main);
        let pipeline = Pipeline::new(
            gpu,
            &PipelineDescription {
                label: "find",
                sources: &sources,
                entry_point: "find",
                constants: &[],
                bindings: &bindings,
            },
        );
        let others = self.resources.iter().map(|(_, resource)| resource.clone());
        let resources: Vec<_> = [read.binding(), written.binding()].into_iter().chain(others).collect();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pipeline.dispatch(gpu, &mut pass, &resources, inputs.len() as u64);
        drop(pass);
        let found = written.read_back(gpu, &mut encoder, inputs.len() as u64);
        gpu.queue.submit([encoder.finish()]);
        found.take(gpu).unwrap()
    }

    fn main(&self) -> String {
        let ([input, output], call) = (self.types, self.call);
        format!(
            "
            @group(0) @binding(0) var<storage, read> inputs: array<{input}>;
            @group(0) @binding(1) var<storage, read_write> outputs: array<{output}>;
            @compute @workgroup_size(1)
            fn find(@builtin(workgroup_id) workgroup: vec3<u32>) {{
                let given = inputs[workgroup.x];
                outputs[workgroup.x] = {call};
            }}
            "
        )
    }
}
