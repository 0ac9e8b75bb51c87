//! The shaders of the casting, in the variants that they have.

use super::super::shared::{
    BUNDLE_BINDINGS, BUNDLE_WGSL, FRAME_WGSL, Fields, HULL_WGSL, KERNEL_WGSL, TASKS_WGSL, TRANSFER_WGSL,
};
use crate::gpu::{Access, Gpu, Pipeline, PipelineDescription};
use crate::kernel::Kernel;

const COLOUR_WGSL: &str = include_str!("colour.wgsl");
const FULL_WGSL: &str = include_str!("full.wgsl");
const PORTIONS_WGSL: &str = include_str!("portions.wgsl");
const SAMPLES_WGSL: &str = concat!(include_str!("meetings.wgsl"), include_str!("samples.wgsl"));
const WORK_WGSL: &str = include_str!("work.wgsl");

/// Bindings of what samples cells that `adapt` left.
const WORK_BINDINGS: [Access; 8] = {
    use Access::{Read, Write};
    [Read, Write, Write, Read, Read, Read, Read, Read]
};

/// What samples cells, with one kernel and for so many fields.
pub(super) struct Samplers {
    pub portions: Pipeline,
    pub full: Pipeline,
    pub wholes: Pipeline,
    pub parts: Pipeline,
    pub slopes: Pipeline,
}

/// Makes pipelines.
pub(super) struct Shaders {
    /// Count evaluations with a weight above zero too, which costs time.
    pub count_inside: bool,
}

impl Shaders {
    pub fn samplers(&self, gpu: &Gpu, kernel: Kernel, fields: Fields) -> Samplers {
        use Access::{Read, Write};
        let pipeline = |entry_point, sources: &[&str], bindings: &[Access]| {
            self.pipeline(gpu, kernel, fields, entry_point, sources, bindings)
        };
        let work = |entry_point, source| {
            let bounds = fields.bounds_wgsl();
            let sources = [HULL_WGSL, TASKS_WGSL, bounds, WORK_WGSL, PORTIONS_WGSL, COLOUR_WGSL, SAMPLES_WGSL, source];
            pipeline(entry_point, &sources, &WORK_BINDINGS)
        };
        Samplers {
            portions: pipeline(
                "sum_portions",
                &[PORTIONS_WGSL, COLOUR_WGSL, SAMPLES_WGSL, include_str!("crowds.wgsl")],
                &[Read, Write],
            ),
            full: self.full(gpu, kernel, fields, COLOUR_WGSL),
            wholes: work("sample_wholes", include_str!("whole.wgsl")),
            parts: work("sample_parts", include_str!("parts.wgsl")),
            slopes: work("follow_slopes", include_str!("slopes.wgsl")),
        }
    }

    /// What samples in full, and composites depths in place of colours.
    pub fn depth(&self, gpu: &Gpu, kernel: Kernel, fields: Fields) -> Pipeline {
        self.full(gpu, kernel, fields, include_str!("depth.wgsl"))
    }

    /// What samples in full, and composites what `seen` says.
    fn full(&self, gpu: &Gpu, kernel: Kernel, fields: Fields, seen: &str) -> Pipeline {
        use Access::{Read, Write};
        let sources = [PORTIONS_WGSL, seen, SAMPLES_WGSL, FULL_WGSL];
        self.pipeline(gpu, kernel, fields, "cast_rays", &sources, &[Read, Write, Write])
    }

    /// What samples cells more coarsely along the rays.
    pub fn coarse(&self, gpu: &Gpu, kernel: Kernel) -> Pipeline {
        let fields = Fields::One;
        let (bounds, source) = (fields.bounds_wgsl(), include_str!("coarse.wgsl"));
        let sources = [HULL_WGSL, TASKS_WGSL, bounds, WORK_WGSL, PORTIONS_WGSL, COLOUR_WGSL, SAMPLES_WGSL, source];
        self.pipeline(gpu, kernel, fields, "sample_coarsely", &sources, &WORK_BINDINGS)
    }

    /// What puts cells together, whatever they were sampled from.
    pub fn composite(&self, gpu: &Gpu) -> Pipeline {
        use Access::{Read, Write};
        let bindings = [Write, Read, Read, Read, Read, Read];
        let sources = [HULL_WGSL, include_str!("composite.wgsl")];
        self.pipeline(gpu, Kernel::default(), Fields::One, "composite_cells", &sources, &bindings)
    }

    fn pipeline(
        &self,
        gpu: &Gpu,
        kernel: Kernel,
        fields: Fields,
        entry_point: &'static str,
        sources: &[&str],
        bindings: &[Access],
    ) -> Pipeline {
        let kernel = ("KERNEL", f64::from(kernel.code()));
        let counting = ("COUNT_INSIDE", f64::from(u8::from(self.count_inside)));
        let some_shown = ("SOME_SHOWN", f64::from(u8::from(sources.contains(&WORK_WGSL))));
        let constants = [kernel, counting, some_shown];
        let used = if sources.contains(&SAMPLES_WGSL) { 3 } else { 1 };
        let shared = [FRAME_WGSL, KERNEL_WGSL, fields.wgsl(), BUNDLE_WGSL, TRANSFER_WGSL];
        Pipeline::new(
            gpu,
            &PipelineDescription {
                label: entry_point,
                sources: &[&shared, sources].concat(),
                entry_point,
                constants: &constants[..used],
                bindings: &[&BUNDLE_BINDINGS, bindings].concat(),
            },
        )
    }
}
