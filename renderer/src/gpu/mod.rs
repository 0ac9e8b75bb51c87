//! The device: what it is, what it can hold, and what went wrong on it.

mod buffer;
mod edits;
mod ledger;
mod needs;
mod pipeline;
mod timing;
#[cfg(test)]
mod translation_tests;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

pub use buffer::Buffer;
pub(crate) use buffer::{Readback, Room};
use edits::ShaderEdits;
pub(crate) use ledger::{Entry, Ledger};
pub use pipeline::{Access, Pipeline, PipelineDescription};
pub(crate) use timing::Timing;

use crate::error::{GpuError, RenderError};

/// Which adapter to use, and how much of it.
#[derive(Clone, Debug, Default)]
pub struct GpuOptions {
    /// Part of the adapter's name, in any case; the fastest one where it is `None`.
    pub adapter: Option<String>,
    /// The same, except that another adapter is as good where there is none of that name.
    pub preferred: Option<String>,
    /// Bytes of device memory that all of a picture's arrays together may take; 4 GiB on a graphics card and
    /// 1 GiB elsewhere where it is `None`. Pictures that need more are rendered in tiles.
    pub memory: Option<u64>,
    /// Texts in the shaders and what stands in their place: for tests of the tests. A text that no
    /// shader has is an error of [`Renderer::new`](crate::Renderer::new).
    #[doc(hidden)]
    pub shader_edits: Vec<(String, String)>,
}

impl GpuOptions {
    /// What settings and flags offer for `memory`, in MiB. With less, every picture would come in small tiles.
    pub const MEMORY_MIB: std::ops::RangeInclusive<u32> = 64..=1 << 18;
}

const GRAPHICS_CARD_MEMORY: u64 = 4 << 30;
const SHARED_MEMORY: u64 = 1 << 30;

/// An open device.
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    pub(crate) limits: wgpu::Limits,
    pub(crate) timestamps: bool,
    pub(crate) memory: u64,
    pub(crate) ledger: Ledger,
    pub(crate) edits: ShaderEdits,
    failures: Arc<Mutex<Failures>>,
}

/// What the device's callbacks reported since the last check.
#[derive(Default)]
struct Failures {
    lost: Option<String>,
    out_of_memory: Option<String>,
    other: Option<String>,
}

impl Gpu {
    /// Opens an adapter for compute; the fastest one unless `options` names another.
    pub fn new(options: &GpuOptions) -> Result<Gpu, GpuError> {
        pollster::block_on(Gpu::open(options))
    }

    async fn open(options: &GpuOptions) -> Result<Gpu, GpuError> {
        let adapter = match (&options.adapter, &options.preferred) {
            (None, Some(preferred)) => match find_adapter(Some(preferred)).await {
                Err(GpuError::NoSuchAdapter { .. } | GpuError::TooWeak { .. }) => find_adapter(None).await?,
                found => found?,
            },
            (wanted, _) => find_adapter(wanted.as_deref()).await?,
        };
        let info = adapter.get_info();
        let limits = adapter.limits();
        let timestamps = adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let required_features =
            if timestamps { wgpu::Features::TIMESTAMP_QUERY } else { wgpu::Features::empty() };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("renderer"),
            required_features,
            // All that the adapter has: buffers are as large as a binding may be.
            required_limits: limits.clone(),
            memory_hints: wgpu::MemoryHints::Performance,
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|error| GpuError::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
        let failures = Arc::new(Mutex::new(Failures::default()));
        listen(&device, &failures);
        let memory = options.memory.unwrap_or(match info.device_type {
            wgpu::DeviceType::DiscreteGpu => GRAPHICS_CARD_MEMORY,
            _ => SHARED_MEMORY,
        });
        let edits = ShaderEdits::new(&options.shader_edits);
        Ok(Gpu {
            device,
            queue,
            info,
            limits,
            timestamps,
            memory,
            ledger: Ledger::default(),
            edits,
            failures,
        })
    }

    /// The names of all adapters that could render, each once. Asks every driver, which takes a while.
    pub fn adapters() -> Vec<String> {
        let instance = instance(wgpu::Backends::PRIMARY);
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        let able = adapters.iter().filter(|adapter| needs::lacking(&adapter.limits()).is_none());
        let mut names: Vec<String> = able.map(|adapter| adapter.get_info().name).collect();
        let mut known = std::collections::HashSet::new();
        names.retain(|name| known.insert(name.clone()));
        names
    }

    /// The adapter's name, as its driver gives it.
    pub fn adapter_name(&self) -> &str {
        &self.info.name
    }

    /// Graphics interface: vulkan, metal, dx12 or gl.
    pub fn backend(&self) -> String {
        self.info.backend.to_string().to_lowercase()
    }

    /// Whether the adapter is a program on the CPU: pictures then take seconds rather than milliseconds.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Gives the device up: what is rendered from now on ends as it does when the driver takes the
    /// device away, with [`RenderError::DeviceLost`]. For tests of what follows from that.
    pub fn lose(&self) {
        self.device.destroy();
    }

    /// The most bytes that one shader binding may see.
    pub(crate) fn binding_limit(&self) -> u64 {
        self.limits.max_storage_buffer_binding_size.min(self.limits.max_buffer_size)
    }

    /// Waits for all submitted work, then reports what failed since the last check.
    pub(crate) fn wait(&self) -> Result<(), RenderError> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        waited.map(drop).map_err(|error| RenderError::DeviceLost(error.to_string()))
    }

    /// Reports what failed since the last check.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        if lock(&self.failures).any() {
            // Work on a lost device fails in many ways; the word of its loss comes with a poll.
            let _ = self.device.poll(wgpu::PollType::Poll);
        }
        let mut failures = lock(&self.failures);
        if let Some(reason) = &failures.lost {
            return Err(RenderError::DeviceLost(reason.clone()));
        }
        let Failures { out_of_memory, other, .. } = std::mem::take(&mut *failures);
        match (out_of_memory, other) {
            (Some(reason), _) => Err(RenderError::OutOfMemory(reason)),
            (None, Some(reason)) => Err(RenderError::Device(reason)),
            (None, None) => Ok(()),
        }
    }
}

impl Failures {
    fn any(&self) -> bool {
        self.lost.is_some() || self.out_of_memory.is_some() || self.other.is_some()
    }
}

async fn find_adapter(wanted: Option<&str>) -> Result<wgpu::Adapter, GpuError> {
    // OpenGL last, if at all: just asking for it makes some systems write warnings of their own.
    match find_adapter_of(wgpu::Backends::PRIMARY, wanted).await {
        Err(GpuError::NoAdapter) => find_adapter_of(wgpu::Backends::SECONDARY, wanted).await,
        found => found,
    }
}

async fn find_adapter_of(backends: wgpu::Backends, wanted: Option<&str>) -> Result<wgpu::Adapter, GpuError> {
    let instance = instance(backends);
    if wanted.is_none() {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let fastest = instance.request_adapter(&options).await.map_err(|_| GpuError::NoAdapter)?;
        if needs::lacking(&fastest.limits()).is_none() {
            return Ok(fastest);
        }
    }
    let mut adapters = instance.enumerate_adapters(backends).await;
    let described = |adapter: &wgpu::Adapter| (adapter.get_info().name, adapter.limits());
    let chosen = needs::choose(&adapters.iter().map(described).collect::<Vec<_>>(), wanted)?;
    Ok(adapters.swap_remove(chosen))
}

fn instance(backends: wgpu::Backends) -> wgpu::Instance {
    let descriptor =
        wgpu::InstanceDescriptor { backends, ..wgpu::InstanceDescriptor::new_without_display_handle() };
    wgpu::Instance::new(descriptor.with_env())
}

/// Turns the device's callbacks, which would panic by default, into failures to be checked.
fn listen(device: &wgpu::Device, failures: &Arc<Mutex<Failures>>) {
    let on_lost = Arc::clone(failures);
    device.set_device_lost_callback(move |_, reason| {
        lock(&on_lost).lost.get_or_insert(reason);
    });
    let on_error = Arc::clone(failures);
    device.on_uncaptured_error(Arc::new(move |error| {
        let mut failures = lock(&on_error);
        match error {
            wgpu::Error::OutOfMemory { source } => failures.out_of_memory.get_or_insert(source.to_string()),
            other => failures.other.get_or_insert(other.to_string()),
        };
    }));
}

fn lock(failures: &Mutex<Failures>) -> MutexGuard<'_, Failures> {
    failures.lock().unwrap_or_else(PoisonError::into_inner)
}
