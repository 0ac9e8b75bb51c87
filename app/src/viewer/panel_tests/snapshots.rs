//! How stable panels look, against pictures of them in `snapshots/`.
//!
//! A panel that is meant to look otherwise gets a new picture by
//! `UPDATE_SNAPSHOTS=1 cargo test -p sphcast --lib snapshots`; look at it before it is committed. Where one
//! differs, what was drawn and where it differs lie beside it (`.new.png`, `.diff.png`).
//!
//! Letters come out a little otherwise on every graphics device, so the pictures are those of Mesa's software
//! renderer; without it the tests are skipped.

use std::sync::Arc;

use egui_kittest::wgpu::WgpuTestRenderer;
use egui_kittest::{Harness, HarnessBuilder, SnapshotOptions};
use egui_wgpu::{WgpuSetup, WgpuSetupCreateNew};
use renderer::{CellClasses, Evaluations, Milliseconds, Stats};

use super::{fluid, inspector, performance, pictured, transfer};
use crate::viewer::panels::inspector::Inspector;
use crate::viewer::panels::sampling::SamplingPanel;
use crate::viewer::panels::transfer_editor::TransferEditor;
use crate::viewer::panels::{cells, measured_error, performance as panel, saved};
use crate::viewer::picture::annotations;
use crate::viewer::picture::overlay::Kind;
use crate::viewer::session::Session;
use crate::viewer::theme;

/// The renderer whose letters the pictures have.
const ADAPTER: &str = "llvmpipe";

/// That renderer, where there is one.
fn software() -> Option<WgpuTestRenderer> {
    let descriptor = wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    let instance = wgpu::Instance::new(descriptor);
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    if !adapters.iter().any(is_software) {
        eprintln!("skipped: snapshots are those of {ADAPTER}, and there is none");
        return None;
    }
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = wgpu::Backends::VULKAN;
    setup.native_adapter_selector = Some(Arc::new(|adapters, _| {
        adapters.iter().find(|adapter| is_software(adapter)).cloned().ok_or_else(|| "none".to_owned())
    }));
    Some(WgpuTestRenderer::from_setup(WgpuSetup::CreateNew(setup)))
}

fn is_software(adapter: &wgpu::Adapter) -> bool {
    let info = adapter.get_info();
    info.device_type == wgpu::DeviceType::Cpu && info.name.contains(ADAPTER)
}

/// A harness of a size in points that draws, in the program's look from the first frame on.
fn drawing<S>(size: [f32; 2]) -> Option<HarnessBuilder<S>> {
    let builder = Harness::builder().with_size(size).renderer(software()?);
    Some(builder.with_context_setup(theme::apply))
}

/// Compares with the picture of that name. Another version of the renderer may round a few edges otherwise.
fn compare<S>(harness: &mut Harness<'_, S>, name: &str) {
    harness.run();
    let options = SnapshotOptions::new().threshold(1.5).max_failed_pixels(12);
    harness.snapshot_options(name, &options.output_path("src/viewer/panel_tests/snapshots"));
}

/// A panel on its ground, as wide as the side panel.
fn side<S: 'static>(
    name: &str,
    height: f32,
    state: S,
    mut show: impl FnMut(&mut egui::Ui, &mut S) + 'static,
) {
    let Some(builder) = drawing([theme::SIDE_WIDTH, height]) else { return };
    let mut harness = builder.build_ui_state(
        move |ui, state| {
            let ground = egui::Frame::new().fill(theme::colours().panel).inner_margin(theme::MARGIN);
            ground.show(ui, |ui| {
                ui.take_available_space();
                show(ui, state);
            });
        },
        state,
    );
    compare(&mut harness, name);
}

/// What an adaptive picture of some size costs.
fn stats() -> Stats {
    Stats {
        adapter: "Some graphics card".into(),
        backend: "vulkan".into(),
        slices: 1232,
        cells: 50_211,
        pairs: 812_345,
        near: 2.5,
        far: 7.5,
        cells_by_class: CellClasses {
            full: 4211,
            mixed: 9000,
            super_pixel: 21_000,
            transparent: 15_000,
            occluded: 1000,
            ..CellClasses::default()
        },
        evaluations: Evaluations { done: 135_000_000, bounds: 35_000_000, ..Evaluations::default() },
        predicted_error: 0.0031,
        milliseconds: Milliseconds {
            upload: 0.25,
            grid: 3.5,
            analysis: 7.25,
            ray_cast: 12.5,
            total: 23.5,
            ..Milliseconds::default()
        },
        gpu_bytes: 256 << 20,
        ..Stats::default()
    }
}

fn session() -> Session {
    pictured(fluid(), stats())
}

#[test]
fn sampling() {
    let mut sampling = SamplingPanel::new();
    side("sampling", 440.0, session(), move |ui, session| {
        sampling.show(ui, session);
        saved::show(ui, session);
        measured_error::show(ui, session, None, &mut Vec::new());
    });
}

#[test]
fn transfer_function_of_two_fields() {
    let mut editor = TransferEditor::default();
    side("transfer", 360.0, transfer::by_density(), move |ui, session| editor.show(ui, session));
}

#[test]
fn bars_of_colour_and_opacity_on_dark_and_on_light() {
    let Some(builder) = drawing([640.0, 320.0]) else { return };
    let on = |background: f32| {
        let mut session = pictured(transfer::by_density(), stats());
        session.view.image.background = Some([background; 3]);
        session
    };
    let mut harness = builder.build_ui_state(
        |ui, sessions: &mut [Session; 2]| {
            for (session, left) in sessions.iter().zip([0.0, 320.0]) {
                let rect = egui::Rect::from_min_size(egui::pos2(left, 0.0), egui::vec2(320.0, 320.0));
                let [ground, ..] = session.view.image.background.unwrap_or_default();
                ui.painter().rect_filled(rect, 0, egui::Rgba::from_gray(ground));
                annotations::show(ui, session, rect, true);
            }
        },
        [on(0.01), on(0.8)],
    );
    compare(&mut harness, "bars");
}

#[test]
fn cells_by_class() {
    let mut session = session();
    session.overlay.kind = Kind::Classes;
    side("cells", 260.0, session, |ui, session| cells::show(ui, session, None, &mut Vec::new()));
}

#[test]
fn performance_panel() {
    side("performance", 420.0, session(), |ui, session| panel::show(ui, session, true, &mut Vec::new()));
}

#[test]
fn performance_over_the_picture() {
    let Some(builder) = drawing([480.0, 480.0]) else { return };
    let mut harness = builder.build_ui_state(
        |ui, state| {
            // A light picture is the harder one.
            ui.painter().rect_filled(ui.ctx().content_rect(), 0, egui::Color32::from_gray(200));
            performance::over(ui, state);
        },
        performance::drawn_for_a_while(),
    );
    compare(&mut harness, "performance_over_picture");
}

#[test]
fn inspector_of_a_pixel() {
    let Some(builder) = drawing([570.0, 550.0]) else { return };
    let mut inspector = Inspector::default();
    let mut harness = builder.build_ui_state(
        move |ui, session| {
            ui.painter().rect_filled(ui.ctx().content_rect(), 0, theme::colours().ground);
            inspector.show(ui, session, ui.max_rect());
        },
        inspector::looked_into(),
    );
    compare(&mut harness, "inspector");
}
