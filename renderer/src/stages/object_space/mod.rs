//! Full sampling that looks particles up by place, in a hash grid in world space: what cells along the rays
//! are compared with. For measurements; no view asks for it.

mod hash_grid;

use bytemuck::{Pod, Zeroable};

use super::shared::{BUNDLE_BINDINGS, BUNDLE_WGSL, FRAME_WGSL, Fields, KERNEL_WGSL, TRANSFER_WGSL};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};
use crate::kernel::Kernel;
use crate::scene::Scene;
pub(crate) use hash_grid::HashGrid;

/// `HashGrid` of `cast.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct HashGridUniform {
    pivot: [f32; 3],
    side: f32,
    count: [u32; 3],
    mask: u32,
}

pub(crate) struct ObjectSpace {
    pipeline: Pipeline,
    grid: Buffer,
    slots: Buffer,
    references: Buffer,
}

fn sources(fields: Fields) -> [&'static str; 6] {
    [FRAME_WGSL, KERNEL_WGSL, fields.wgsl(), BUNDLE_WGSL, TRANSFER_WGSL, include_str!("cast.wgsl")]
}

/// The shader for this kernel and so many fields.
pub(crate) fn pipeline(gpu: &Gpu, kernel: Kernel, fields: Fields) -> Pipeline {
    use Access::{Read, Uniform, Write};
    let description = PipelineDescription {
        label: "cast_by_places",
        sources: &sources(fields),
        entry_point: "cast_by_places",
        constants: &[("KERNEL", f64::from(kernel.code()))],
        bindings: &[&BUNDLE_BINDINGS[..], &[Uniform, Read, Read, Write]].concat(),
    };
    Pipeline::new(gpu, &description)
}

impl ObjectSpace {
    /// Brings `grid`, whose lengths are the device's, there. `pivot`: of positions in view space.
    pub(crate) fn new(
        gpu: &Gpu,
        scene: &Scene,
        grid: &HashGrid,
        pivot: glam::DVec3,
    ) -> Result<ObjectSpace, RenderError> {
        let mut object_space = ObjectSpace {
            pipeline: pipeline(gpu, scene.kernel, scene.quantity.fields()),
            grid: Buffer::uniform::<HashGridUniform>(gpu, "hash grid"),
            slots: Buffer::storage(gpu, "slots of a hash grid", size_of::<hash_grid::Slot>() as u64),
            references: Buffer::storage(gpu, "references of a hash grid", 4),
        };
        let uniform = HashGridUniform {
            pivot: (pivot - grid.corner).as_vec3().to_array(),
            side: grid.side as f32,
            count: grid.count,
            mask: grid.slots.len() as u32 - 1,
        };
        object_space.grid.write(gpu, &[uniform])?;
        object_space.slots.write(gpu, &grid.slots)?;
        object_space.references.write(gpu, &grid.references)?;
        Ok(object_space)
    }

    /// Records full sampling of `bundles` bundles. `shared`: resources for [`BUNDLE_BINDINGS`].
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        shared: &[wgpu::BindingResource],
        pixels: &Buffer,
        bundles: u64,
    ) {
        let own = [&self.grid, &self.slots, &self.references, pixels].map(Buffer::binding);
        self.pipeline.dispatch(gpu, pass, &[shared, &own].concat(), bundles);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::layout::check_layout;

    #[test]
    fn the_grid_lies_as_the_shader_expects() {
        let source = sources(Fields::One).concat();
        check_layout!(&source, "HashGrid", HashGridUniform, pivot, side, count, mask);
    }
}
