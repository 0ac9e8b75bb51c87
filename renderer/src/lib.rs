//! An adaptive GPU ray caster for unstructured, dynamic particle sets.

mod camera;
mod error;
mod gpu;
mod kernel;
mod pace;
mod particles;
mod picture;
mod plan;
mod renderer;
mod scene;
mod stages;
mod stats;
mod transfer;
mod view;

pub use camera::{BUNDLE_SIDE, CELL_SLICES, Camera, Slices};
pub use error::{GpuError, RenderError};
pub use gpu::{Gpu, GpuOptions};
pub use kernel::Kernel;
pub use particles::{Bounds, ParticleSet, Quantity, RawParticle, Rejected};
pub use picture::Picture;
pub use renderer::{Progress, Renderer};
pub use scene::{Scene, default_reference_length};
pub use stats::{CellClasses, Evaluations, Milliseconds, Stats};
pub use transfer::{ControlPoint, TransferFunction};
pub use view::{
    CameraView, ImageView, ParticleView, QuantityView, SamplingView, TransferView, View, ViewError,
};
