//! Compute pipelines: a row of bindings each, one dispatch helper for all.

use super::Gpu;

/// How a shader uses a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    Uniform,
    Read,
    Write,
    /// A two-dimensional texture of unfilterable floats.
    Texture,
}

/// What makes a pipeline.
pub struct PipelineDescription<'a> {
    pub label: &'static str,
    /// WGSL files, put one behind the other.
    pub sources: &'a [&'a str],
    pub entry_point: &'a str,
    /// Values of `override` constants.
    pub constants: &'a [(&'a str, f64)],
    /// Bindings 0, 1, 2, ... of group 0.
    pub bindings: &'a [Access],
}

/// A compute shader with the layout of its bindings.
pub struct Pipeline {
    label: &'static str,
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

/// Workgroups in x of one dispatch; the rest goes on in y (`ROW_OF_WORKGROUPS` of the shaders).
const ROW_OF_WORKGROUPS: u32 = 32_768;

impl Pipeline {
    pub fn new(gpu: &Gpu, description: &PipelineDescription) -> Pipeline {
        let label = description.label;
        let device = &gpu.device;
        let source = gpu.edits.apply(description.sources.concat());
        #[cfg(test)]
        super::translation_tests::note(description, &source);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let entries: Vec<_> = description.bindings.iter().enumerate().map(layout_entry).collect();
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(description.entry_point),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: description.constants,
                ..Default::default()
            },
            cache: None,
        });
        Pipeline { label, pipeline, layout }
    }

    /// Records `workgroups` workgroups over `resources`, which stand in the order of the bindings.
    pub fn dispatch(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        resources: &[wgpu::BindingResource],
        workgroups: u64,
    ) {
        if workgroups == 0 {
            return;
        }
        let entries: Vec<_> = resources
            .iter()
            .enumerate()
            .map(|(binding, resource)| wgpu::BindGroupEntry {
                binding: binding as u32,
                resource: resource.clone(),
            })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.label),
            layout: &self.layout,
            entries: &entries,
        });
        let (x, y) = rows(workgroups);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(x, y, 1);
    }
}

/// Workgroups in x and y that make at least `workgroups`.
fn rows(workgroups: u64) -> (u32, u32) {
    let row = u64::from(ROW_OF_WORKGROUPS);
    (workgroups.min(row) as u32, workgroups.div_ceil(row) as u32)
}

fn layout_entry((binding, access): (usize, &Access)) -> wgpu::BindGroupLayoutEntry {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let ty = match access {
        Access::Uniform => buffer(wgpu::BufferBindingType::Uniform),
        Access::Read => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
        Access::Write => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
        Access::Texture => wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
    };
    wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_cover_all_workgroups() {
        assert_eq!(rows(1), (1, 1));
        assert_eq!(rows(32_768), (32_768, 1));
        assert_eq!(rows(32_769), (32_768, 2));
    }
}
