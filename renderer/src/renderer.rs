//! The stages in order, and which of them a change makes stale.

use std::ops::ControlFlow;

use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::picture::Picture;
use crate::scene::Scene;

/// Turns scenes into pictures; keeps what the next picture can use again.
pub struct Renderer {
    gpu: Gpu,
}

impl Renderer {
    /// Builds every pipeline.
    pub fn new(gpu: Gpu) -> Result<Renderer, RenderError> {
        Ok(Renderer { gpu })
    }

    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Renders `scene` at full sampling. Blocks until the picture is there, and asks `progress`
    /// (share done, 0 to 1) between steps of some tens of milliseconds whether to go on.
    pub fn render(
        &mut self,
        _scene: &Scene,
        _progress: &mut dyn FnMut(f32) -> ControlFlow<()>,
    ) -> Result<Picture, RenderError> {
        Err(RenderError::Cancelled)
    }
}
