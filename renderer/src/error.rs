//! What can go wrong between a scene and its picture.

/// Why there is no device to render with.
#[derive(Clone, Debug, thiserror::Error)]
pub enum GpuError {
    #[error(
        "no graphics adapter found: install a Vulkan, Metal or DirectX 12 driver (on Debian without a GPU: apt install mesa-vulkan-drivers)"
    )]
    NoAdapter,
    #[error("no graphics adapter is named like `{wanted}`; found: {found}")]
    NoSuchAdapter { wanted: String, found: String },
    #[error("graphics adapter {adapter} cannot render: {what}; choose another one or update its driver")]
    TooWeak { adapter: String, what: String },
    #[error("adapter {adapter} refuses a device: {reason}")]
    NoDevice { adapter: String, reason: String },
}

/// Why a picture could not be rendered.
#[derive(Clone, Debug, thiserror::Error)]
pub enum RenderError {
    #[error("cancelled")]
    Cancelled,
    #[error("the device was lost ({0}): the driver reset it or it was removed")]
    DeviceLost(String),
    #[error("out of device memory while rendering: choose a smaller picture or fewer particles ({0})")]
    OutOfMemory(String),
    #[error("{what} need {needed} bytes in one buffer, but the adapter allows {limit}")]
    BufferLimit { what: &'static str, needed: u64, limit: u64 },
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    #[error("the device refused the work: {0}")]
    Device(String),
}

/// A single cell of the grid needs more than the device can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "one cell of 8 × 8 pixels has {needed} {what}, and the device holds {limit}: allow more device memory, choose a larger picture or a closer camera"
)]
pub struct TooLarge {
    pub what: &'static str,
    pub needed: u64,
    pub limit: u64,
}
