//! The device and what it can hold.

use crate::error::GpuError;

/// Which adapter to use, and how much of it.
#[derive(Clone, Debug, Default)]
pub struct GpuOptions {
    /// Part of the adapter's name, in any case; the fastest one where it is `None`.
    pub adapter: Option<String>,
    /// Bytes of device memory that the renderer may take; a share of what the adapter allows where it is `None`.
    pub memory: Option<u64>,
}

/// An open device.
pub struct Gpu {}

impl Gpu {
    /// Opens an adapter for compute.
    pub fn new(_options: &GpuOptions) -> Result<Gpu, GpuError> {
        Err(GpuError::NoAdapter)
    }

    /// The adapter's name.
    pub fn adapter_name(&self) -> &str {
        ""
    }

    /// Whether the adapter is a program on the CPU, and pictures take seconds rather than milliseconds.
    pub fn is_software(&self) -> bool {
        true
    }
}
