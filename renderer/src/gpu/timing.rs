//! Device time of each stage.

use wgpu_profiler::{GpuProfiler, GpuProfilerSettings, GpuTimerQueryResult};

use super::Gpu;
use crate::error::RenderError;

/// Collects the device time of labelled passes; without timestamps all times are zero.
pub(crate) struct Timing {
    profiler: GpuProfiler,
}

impl Timing {
    pub(crate) fn new(gpu: &Gpu) -> Result<Timing, RenderError> {
        let settings = GpuProfilerSettings {
            enable_timer_queries: gpu.timestamps,
            enable_debug_groups: false,
            ..Default::default()
        };
        let profiler = GpuProfiler::new(&gpu.device, settings)
            .map_err(|error| RenderError::Device(error.to_string()))?;
        Ok(Timing { profiler })
    }

    /// Records one compute pass whose time counts for `label`.
    pub(crate) fn pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        label: &'static str,
        record: impl FnOnce(&mut wgpu::ComputePass),
    ) {
        let mut scope = self.profiler.scope(label, encoder);
        let mut pass = scope.scoped_compute_pass(label);
        record(&mut pass);
    }

    /// Ends the recording of an encoder; call before its submission.
    pub(crate) fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.profiler.resolve_queries(encoder);
    }

    /// Milliseconds for each label, once the submission has finished.
    pub(crate) fn take(&mut self, gpu: &Gpu) -> Result<Vec<(String, f64)>, RenderError> {
        self.profiler.end_frame().map_err(|error| RenderError::Device(error.to_string()))?;
        gpu.wait()?;
        let results = self.profiler.process_finished_frame(gpu.queue.get_timestamp_period());
        Ok(results.unwrap_or_default().iter().map(milliseconds).collect())
    }
}

/// The time of a query; of the passes inside it where the encoder itself cannot be timed.
fn milliseconds(result: &GpuTimerQueryResult) -> (String, f64) {
    let own = result.time.as_ref().map(|time| (time.end - time.start) * 1e3);
    let inner = || result.nested_queries.iter().map(|nested| milliseconds(nested).1).sum();
    (result.label.clone(), own.unwrap_or_else(inner))
}
