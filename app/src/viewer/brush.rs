//! What draws egui in the window, until its device is lost.

use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::Context;
use egui::epaint::ClippedPrimitive;
use egui::{TexturesDelta, ViewportId};
use egui_wgpu::winit::Painter;
use egui_wgpu::{RendererOptions, WgpuConfiguration, WgpuSetup};
use winit::dpi::PhysicalSize;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

use super::{Wake, theme};

/// What draws egui, with a device of its own; another takes its place when that is lost.
pub struct Brush {
    painter: Painter,
    lost: Arc<AtomicBool>,
}

impl Brush {
    /// # Errors
    /// Where no adapter can draw in this window; the message says what to do.
    pub fn new(
        context: &egui::Context,
        events: &ActiveEventLoop,
        window: &Arc<Window>,
        wake: &Wake,
    ) -> anyhow::Result<Brush> {
        let configuration = WgpuConfiguration {
            wgpu_setup: WgpuSetup::from_display_handle(events.owned_display_handle()),
            ..WgpuConfiguration::default()
        };
        let options = RendererOptions::default();
        let mut painter = pollster::block_on(Painter::new(context.clone(), configuration, false, options));
        pollster::block_on(painter.set_window(ViewportId::ROOT, Some(Arc::clone(window)))).context(
            "adapter: no graphics adapter can draw in this window: install a Vulkan, Metal or DirectX 12 \
             driver (on Debian without a GPU: apt install mesa-vulkan-drivers)",
        )?;
        let lost = Arc::new(AtomicBool::new(false));
        if let Some(state) = painter.render_state() {
            watch(&state.device, &lost, wake);
        }
        Ok(Brush { painter, lost })
    }

    /// Whether the device is gone, and this brush with it.
    pub fn is_lost(&self) -> bool {
        self.lost.load(Ordering::Relaxed)
    }

    pub fn largest_texture(&self) -> Option<usize> {
        self.painter.max_texture_side()
    }

    pub fn resize(&mut self, size: PhysicalSize<u32>) {
        if let (Some(width), Some(height)) = (NonZeroU32::new(size.width), NonZeroU32::new(size.height)) {
            self.painter.on_window_resized(ViewportId::ROOT, width, height);
        }
    }

    /// Paints one frame of the window, unless the device is lost meanwhile.
    pub fn paint(
        &mut self,
        window: &Arc<Window>,
        scale: f32,
        primitives: &[ClippedPrimitive],
        textures: &mut TexturesDelta,
    ) {
        let Brush { painter, lost } = self;
        let ground = theme::colours().ground.to_normalized_gamma_f32();
        let (root, no_capture) = (ViewportId::ROOT, Vec::new());
        let painted = catch_unwind(AssertUnwindSafe(|| {
            painter.paint_and_update_textures(root, scale, ground, primitives, textures, no_capture, window)
        }));
        if let Err(panic) = painted {
            // egui's painter panics where its device is lost under its hands. The word of the loss
            // may come as late as with a poll.
            if let Some(state) = painter.render_state() {
                let _ = state.device.poll(wgpu::PollType::Poll);
            }
            if !lost.load(Ordering::Relaxed) {
                resume_unwind(panic);
            }
        }
    }

    /// Drops the surface: for some drivers, two in one window are one too many.
    pub fn let_go_of_window(&mut self) {
        // Without a window there is nothing that can fail.
        let _ = pollster::block_on(self.painter.set_window(ViewportId::ROOT, None));
    }

    /// Gives the device up, for tests of what follows from that.
    pub fn lose(&self) {
        if let Some(state) = self.painter.render_state() {
            state.device.destroy();
        }
    }
}

/// Notes the loss of a device, and keeps errors of the driver from ending the program.
fn watch(device: &wgpu::Device, lost: &Arc<AtomicBool>, wake: &Wake) {
    let (flag, wake) = (Arc::clone(lost), Wake::clone(wake));
    device.set_device_lost_callback(move |_, _| {
        flag.store(true, Ordering::Relaxed);
        wake();
    });
    device.on_uncaptured_error(Arc::new(|error: wgpu::Error| log::error!("window: {error}")));
}
