//! What several stages' shaders see.

mod frame;
mod store;
mod transfer;

pub(crate) use frame::{FrameUniform, TileUniform, pitch, pivot_depth, radius_floor};
pub use store::ParticleStore;
pub(crate) use transfer::TransferTables;

/// WGSL of the structs in `frame.rs`.
pub(crate) const FRAME_WGSL: &str = include_str!("frame.wgsl");
pub(crate) const KERNEL_WGSL: &str = include_str!("kernel.wgsl");
pub(crate) const TRANSFER_WGSL: &str = include_str!("transfer.wgsl");
