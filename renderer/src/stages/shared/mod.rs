//! What several stages' shaders see.

mod bundle;
mod fields;
mod frame;
mod store;
mod transfer;
#[cfg(test)]
mod transfer_tests;

pub(crate) use bundle::{BUNDLE_BINDINGS, Bundles, Counters, spread};
pub(crate) use fields::Fields;
pub(crate) use frame::{FrameUniform, TileUniform, pitch, pivot_depth, radius_floor};
pub use store::ParticleStore;
pub(crate) use transfer::TransferTables;

/// WGSL of the structs in `frame.rs`.
pub(crate) const FRAME_WGSL: &str = include_str!("frame.wgsl");
pub(crate) const KERNEL_WGSL: &str = include_str!("kernel.wgsl");
pub(crate) const TRANSFER_WGSL: &str = include_str!("transfer.wgsl");
/// WGSL of the structs and bindings in `bundle.rs`.
pub(crate) const BUNDLE_WGSL: &str = include_str!("bundle.wgsl");
pub(crate) const HULL_WGSL: &str = include_str!("hull.wgsl");
pub(crate) const TASKS_WGSL: &str = include_str!("tasks.wgsl");
