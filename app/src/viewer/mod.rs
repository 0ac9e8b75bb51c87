//! The window: open a run, look around in it, colour it, play it, save pictures of it.
//!
//! - [`session`] is the state, without window or egui: run, playhead, view, camera, messages.
//! - [`render_thread`] turns the latest wish into pictures on a device of its own; [`exports`] does
//!   so for saved ones.
//! - [`analysis`] is numbers about the particles, [`inspect`] asks the picture in view, and [`picture`] is
//!   how it gets to the screen.
//! - [`keys`] is what the keyboard does; [`kept`] what outlives the program: settings, recent runs, the
//!   session.
//! - [`desk`] ties all of it together with dialogs and [`panels`]; [`window`] is winit and egui.

mod accessible;
mod analysis;
mod brush;
mod desk;
mod dialogs;
mod exports;
mod icons;
mod inspect;
mod kept;
mod keys;
mod layout;
mod live;
mod messages;
mod orbit_camera;
#[cfg(test)]
mod panel_tests;
mod panels;
mod picture;
mod playback;
mod render_thread;
mod run;
mod session;
mod task;
mod theme;
mod widgets;
mod window;

use std::path::PathBuf;
use std::sync::Arc;

use renderer::{GpuOptions, View};

use crate::frames::Sequence;

/// What the viewer is opened with.
pub struct Options {
    /// What it is opened by: nothing for the embedded run, with a start page beside it.
    pub files: Vec<PathBuf>,
    pub sequence: Sequence,
    /// Settings to start from.
    pub view: View,
    /// Whether the size of the image was asked for; otherwise it is that of the window.
    pub fixed_size: bool,
    pub gpu: GpuOptions,
    /// Whether to write one line on standard error for each thing that happens. With it, F12 takes
    /// the window's graphics device away, for tests of what follows from that.
    pub log_events: bool,
    /// Whether the newest frame is shown, and every new one as it is written.
    pub follow: bool,
}

/// Tells the window from another thread that there is something new.
type Wake = Arc<dyn Fn() + Send + Sync>;

/// Opens the window and returns when it is closed.
///
/// # Errors
/// Without a display or a graphics adapter; the message says what to do.
pub fn run(options: Options) -> anyhow::Result<()> {
    window::run(options)
}
