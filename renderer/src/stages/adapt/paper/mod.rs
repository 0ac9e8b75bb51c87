//! The bound and the choice of the paper (HPG 2016, Sec. 4 and 5), as a peer of ours and to be measured
//! against it: intervals of irradiance and transparency of each cell at the sampling levels 0 to 4,
//! composited along the rays of a bundle, whose width is to stay below the tolerance; super-pixels; and
//! the relaxation of the lower bounds.
//!
//! Three things differ. In place of a detector of surface particles, a cell is at the surface where some
//! ray may miss all particles of a slab that holds any: like the paper's surface cells it stays at level 0,
//! but its interval holds for such rays too. The fourth channel is bounded like the others, as the opacity
//! that it is. And cells that nothing is seen of are left out.
//!
//! Extremes of the quantity in each slab, and its coverage, stay until the grid or the quantity changes;
//! intervals and choices are made anew for each picture.

use bytemuck::{Pod, Zeroable};

use super::super::shared::{
    BUNDLE_BINDINGS, BUNDLE_WGSL, FRAME_WGSL, Fields, HULL_WGSL, TASKS_WGSL, TRANSFER_WGSL,
};
use super::{Adapt, LISTING_WGSL};
use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};

const SOURCES: [&str; 11] = [
    FRAME_WGSL,
    Fields::One.wgsl(),
    BUNDLE_WGSL,
    TRANSFER_WGSL,
    HULL_WGSL,
    TASKS_WGSL,
    include_str!("slabs.wgsl"),
    include_str!("intervals.wgsl"),
    include_str!("cells.wgsl"),
    LISTING_WGSL,
    include_str!("choice.wgsl"),
];

/// `CellBounds` of `cells.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct CellBounds {
    /// Of each slab, as bricks have them.
    pub values: [[f32; 2]; 16],
    is_surface: [u32; 4],
    levels: [[f32; 8]; 5],
    front: [f32; 8],
}

pub(super) struct Paper {
    pipeline: Pipeline,
    /// [`CellBounds`] of each slot.
    pub bounds: Buffer,
}

impl Paper {
    pub(super) fn new(gpu: &Gpu) -> Paper {
        Paper {
            pipeline: Pipeline::new(
                gpu,
                &PipelineDescription {
                    label: "choose_by_intervals",
                    sources: &SOURCES,
                    entry_point: "choose_by_intervals",
                    constants: &[],
                    bindings: &[&BUNDLE_BINDINGS[..], &[Access::Write; 8]].concat(),
                },
            ),
            bounds: Buffer::storage(gpu, "intervals of cells", size_of::<CellBounds>() as u64),
        }
    }

    /// Makes room for `filled` cells.
    pub(super) fn reserve(&mut self, gpu: &Gpu, filled: u64) -> Result<(), RenderError> {
        self.bounds.reserve(gpu, filled)
    }

    /// Records the analysis of `bundles` bundles, which fills the same buffers of `adapt` as its own.
    pub(super) fn record(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        adapt: &Adapt,
        shared: &[wgpu::BindingResource],
        bundles: u64,
    ) {
        let own = [
            &adapt.cell_values,
            &adapt.slots_taken,
            &self.bounds,
            &adapt.shows,
            &adapt.bundle_entries,
            &adapt.sampled,
            &adapt.tasks,
            &adapt.work,
        ]
        .map(Buffer::binding);
        self.pipeline.dispatch(gpu, pass, &[shared, &own].concat(), bundles);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::layout::check_layout;

    #[test]
    fn bounds_lie_as_the_shader_expects() {
        check_layout!(&SOURCES.concat(), "CellBounds", CellBounds, values, is_surface, levels, front);
    }
}
