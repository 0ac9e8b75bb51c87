//! The shaders of the casting, in the variants that they have.

use super::super::shared::{
    BUNDLE_BINDINGS, BUNDLE_WGSL, FRAME_WGSL, Fields, HULL_WGSL, KERNEL_WGSL, TASKS_WGSL, TRANSFER_WGSL,
};
use crate::gpu::{Access, Gpu, Pipeline, PipelineDescription};
use crate::kernel::Kernel;
use crate::sampling::{Between, Bound, BrickWidth};
use crate::scene::Scene;

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

/// What a scene needs of the shaders, which are made for that alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Variant {
    /// A kernel's code.
    pub kernel: u32,
    pub fields: Fields,
    pub has_crowds: bool,
    pub brick_width: BrickWidth,
    /// Bricks may be sampled at level 2.
    pub has_level_2: bool,
}

impl Variant {
    /// Without crowds and level 2, with bricks of the usual width.
    pub fn plain(kernel: Kernel, fields: Fields) -> Variant {
        let brick_width = BrickWidth::default();
        Variant { kernel: kernel.code(), fields, has_crowds: false, brick_width, has_level_2: false }
    }

    pub fn of(scene: &Scene, has_crowds: bool) -> Variant {
        let sampling = &scene.sampling;
        let has_level_2 = sampling.bound == Bound::Difference && sampling.between() == Between::Levels;
        let plain = Variant::plain(scene.kernel, scene.quantity.fields());
        Variant { has_crowds, brick_width: sampling.column_width(), has_level_2, ..plain }
    }
}

/// What samples cells.
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
    pub fn samplers(&self, gpu: &Gpu, variant: Variant) -> Samplers {
        use Access::{Read, Write};
        let pipeline = |entry_point, sources: &[&str], bindings: &[Access]| {
            self.pipeline(gpu, variant, entry_point, sources, bindings)
        };
        let work = |entry_point, source| {
            let bounds = variant.fields.bounds_wgsl();
            let sources =
                [HULL_WGSL, TASKS_WGSL, bounds, WORK_WGSL, PORTIONS_WGSL, COLOUR_WGSL, SAMPLES_WGSL, source];
            pipeline(entry_point, &sources, &WORK_BINDINGS)
        };
        Samplers {
            portions: pipeline(
                "sum_portions",
                &[PORTIONS_WGSL, COLOUR_WGSL, SAMPLES_WGSL, include_str!("crowds.wgsl")],
                &[Read, Write],
            ),
            full: self.full(gpu, variant, COLOUR_WGSL),
            wholes: work("sample_wholes", include_str!("whole.wgsl")),
            parts: work("sample_parts", include_str!("parts.wgsl")),
            slopes: work("follow_slopes", include_str!("slopes.wgsl")),
        }
    }

    /// What samples in full, and composites depths in place of colours.
    pub fn depth(&self, gpu: &Gpu, variant: Variant) -> Pipeline {
        self.full(gpu, variant, include_str!("depth.wgsl"))
    }

    /// What samples in full, and composites what `seen` says.
    fn full(&self, gpu: &Gpu, variant: Variant, seen: &str) -> Pipeline {
        use Access::{Read, Write};
        let sources = [PORTIONS_WGSL, seen, SAMPLES_WGSL, FULL_WGSL];
        self.pipeline(gpu, variant, "cast_rays", &sources, &[Read, Write, Write])
    }

    /// What samples cells more coarsely along the rays.
    pub fn coarse(&self, gpu: &Gpu, kernel: Kernel) -> Pipeline {
        let variant = Variant::plain(kernel, Fields::One);
        let (bounds, source) = (variant.fields.bounds_wgsl(), include_str!("coarse.wgsl"));
        let sources =
            [HULL_WGSL, TASKS_WGSL, bounds, WORK_WGSL, PORTIONS_WGSL, COLOUR_WGSL, SAMPLES_WGSL, source];
        self.pipeline(gpu, variant, "sample_coarsely", &sources, &WORK_BINDINGS)
    }

    /// What puts cells together, whatever they were sampled from.
    pub fn composite(&self, gpu: &Gpu, brick_width: BrickWidth) -> Pipeline {
        use Access::{Read, Write};
        let bindings = [Write, Read, Read, Read, Read, Read];
        let sources = [HULL_WGSL, include_str!("composite.wgsl")];
        let variant = Variant { brick_width, ..Variant::plain(Kernel::default(), Fields::One) };
        self.pipeline(gpu, variant, "composite_cells", &sources, &bindings)
    }

    fn pipeline(
        &self,
        gpu: &Gpu,
        variant: Variant,
        entry_point: &'static str,
        sources: &[&str],
        bindings: &[Access],
    ) -> Pipeline {
        let on = |name, value| (name, f64::from(u8::from(value)));
        let constants = [
            ("KERNEL", f64::from(variant.kernel)),
            ("COLUMN_SIDE", f64::from(variant.brick_width.rays())),
            on("COUNT_INSIDE", self.count_inside),
            on("SOME_SHOWN", sources.contains(&WORK_WGSL)),
            on("HAS_CROWDS", variant.has_crowds),
            on("HAS_LEVEL_2", variant.has_level_2),
        ];
        let used = if sources.contains(&SAMPLES_WGSL) { constants.len() } else { 2 };
        let shared = [FRAME_WGSL, KERNEL_WGSL, variant.fields.wgsl(), BUNDLE_WGSL, TRANSFER_WGSL];
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
