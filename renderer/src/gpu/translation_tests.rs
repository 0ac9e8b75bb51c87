//! Every shader in the languages of Metal and Direct3D: tests run on Vulkan, users run on all three.

use std::cell::RefCell;

use naga::back::{hlsl, msl, pipeline_constants};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ShaderStage};

use super::needs::{STORAGE_BUFFERS, WORKGROUP_BYTES, WORKGROUP_SIZE};
use super::pipeline::{Access, PipelineDescription};
use super::{Gpu, GpuOptions};
use crate::kernel::Kernel;
use crate::renderer::Renderer;
use crate::sampling::{BrickWidth, Without};
use crate::stages::adapt::Adapt;
use crate::stages::cast::{Cast, Variant};
use crate::stages::object_space;
use crate::stages::shared::Fields;

/// Argument slots for buffers that Metal has (its feature set tables), less those that wgpu keeps: one for
/// the lengths of the others, and one for immediates.
const SLOTS_OF_METAL: usize = 31 - 2;

/// What a pipeline was made of.
struct Made {
    label: &'static str,
    source: String,
    entry_point: String,
    constants: Vec<(String, f64)>,
    buffers: usize,
    storage_buffers: usize,
}

thread_local! {
    static MADE: RefCell<Vec<Made>> = const { RefCell::new(Vec::new()) };
}

/// Takes note of a pipeline that is made on this thread.
pub(super) fn note(description: &PipelineDescription, source: &str) {
    let constants = description.constants.iter().map(|(name, value)| ((*name).to_owned(), *value));
    let count =
        |counts: fn(Access) -> bool| description.bindings.iter().filter(|access| counts(**access)).count();
    let made = Made {
        label: description.label,
        source: source.to_owned(),
        entry_point: description.entry_point.to_owned(),
        constants: constants.collect(),
        buffers: count(|access| access != Access::Texture),
        storage_buffers: count(|access| matches!(access, Access::Read | Access::Write)),
    };
    MADE.with_borrow_mut(|all| all.push(made));
}

impl Made {
    /// The shader as wgpu hands it to a backend.
    fn settled(&self) -> (Module, ModuleInfo) {
        let module = naga::front::wgsl::parse_str(&self.source).unwrap();
        // What all three have; WebGPU's own but for packing halves into a word.
        let capabilities = Capabilities::default() | Capabilities::SHADER_FLOAT16_IN_FLOAT32;
        let info = Validator::new(ValidationFlags::all(), capabilities).validate(&module).unwrap();
        let constants = self.constants.iter().cloned().collect();
        let entry_point = Some((ShaderStage::Compute, self.entry_point.as_str()));
        let settled = pipeline_constants::process_overrides(&module, &info, entry_point, &constants).unwrap();
        (settled.0.into_owned(), settled.1.into_owned())
    }

    /// Invocations of a workgroup, and bytes that they share.
    fn workgroup(&self, module: &Module, info: &ModuleInfo) -> [u32; 2] {
        let number = module.entry_points.iter().position(|entry| entry.name == self.entry_point).unwrap();
        let uses = info.get_entry_point(number);
        let shared = module.global_variables.iter().filter(|(handle, variable)| {
            variable.space == naga::AddressSpace::WorkGroup && !uses[*handle].is_empty()
        });
        let bytes = |ty| module.types[ty].inner.size(module.to_ctx()).next_multiple_of(16);
        let size = module.entry_points[number].workgroup_size.iter().product();
        [size, shared.map(|(_, variable)| bytes(variable.ty)).sum()]
    }

    fn in_msl(&self, module: &Module, info: &ModuleInfo) -> Result<String, msl::Error> {
        let options = msl::Options { lang_version: (2, 4), ..msl::Options::default() };
        let entry_point = Some((ShaderStage::Compute, self.entry_point.clone()));
        let pipeline = msl::PipelineOptions { entry_point, ..msl::PipelineOptions::default() };
        msl::write_string(module, info, &options, &pipeline).map(|(text, _)| text)
    }

    fn in_hlsl(&self, module: &Module, info: &ModuleInfo) -> Result<String, hlsl::Error> {
        let options = hlsl::Options { shader_model: hlsl::ShaderModel::V6_0, ..hlsl::Options::default() };
        let entry_point = Some((ShaderStage::Compute, self.entry_point.clone()));
        let pipeline = hlsl::PipelineOptions { entry_point };
        let mut text = String::new();
        hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None)?;
        Ok(text)
    }
}

/// Makes every pipeline that there is, but for those that differ in a constant only.
fn make_all() {
    let gpu = Gpu::new(&GpuOptions::default()).unwrap();
    let (mut adapt, mut cast) = (Adapt::new(&gpu), Cast::new(&gpu, true));
    for fields in [Fields::One, Fields::Two] {
        for kernel in Kernel::ALL {
            for width in BrickWidth::ALL {
                adapt.prepare(&gpu, kernel, Without::Nothing, fields, width);
            }
            let plain = Variant::plain(kernel, fields);
            let fine = Variant { brick_width: BrickWidth::Two, ..plain };
            for variant in [plain, fine, Variant { has_crowds: true, has_level_2: true, ..plain }] {
                cast.prepare(&gpu, variant);
                cast.prepare_depth(&gpu, variant);
            }
            object_space::pipeline(&gpu, kernel, fields);
        }
    }
    // The other stages come with it.
    Renderer::new(gpu).unwrap();
}

#[test]
fn every_shader_translates_for_metal_and_direct3d() {
    make_all();
    let made = MADE.take();
    assert!(made.len() > 20, "{} pipelines", made.len());
    for pipeline in &made {
        let (module, info) = pipeline.settled();
        let texts = [
            pipeline.in_msl(&module, &info).map_err(|error| error.to_string()),
            pipeline.in_hlsl(&module, &info).map_err(|error| error.to_string()),
        ];
        for text in texts {
            let text = text.unwrap_or_else(|error| panic!("{}: {error}", pipeline.label));
            assert!(text.contains(&pipeline.entry_point), "{}", pipeline.label);
        }
        let buffers = pipeline.buffers;
        assert!(buffers <= SLOTS_OF_METAL, "{}: {buffers} buffers", pipeline.label);
        let [size, bytes] = pipeline.workgroup(&module, &info);
        assert!(size <= WORKGROUP_SIZE, "{}: {size} invocations", pipeline.label);
        assert!(bytes <= WORKGROUP_BYTES, "{}: {bytes} bytes in a workgroup", pipeline.label);
    }
    // No adapter is turned away for what no shader needs.
    let most = made.iter().map(|pipeline| pipeline.storage_buffers).max();
    assert_eq!(most, Some(STORAGE_BUFFERS as usize));
}
