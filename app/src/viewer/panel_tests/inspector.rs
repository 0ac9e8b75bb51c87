use std::sync::Arc;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{Bound, BrickMask, BundleDetail, CellClass, CellDetail, KnownValues, MapCell, Stats};

use super::{assert_written, fluid, pictured, shown, texts};
use crate::viewer::inspect::probe::Probed;
use crate::viewer::panels::inspector::Inspector;
use crate::viewer::render_thread::Report;
use crate::viewer::session::Session;
use crate::viewer::theme;

/// The window over a picture, of a pixel at its left.
fn inspector(mut session: Session) -> Harness<'static, Session> {
    session.probe = Some([10, 12]);
    let mut inspector = Inspector::default();
    let mut harness = Harness::builder().with_size(egui::vec2(1280.0, 800.0)).build_ui_state(
        move |ui, session: &mut Session| {
            theme::apply(ui.ctx());
            inspector.show(ui, session, ui.max_rect());
        },
        session,
    );
    harness.run();
    harness
}

fn cell(layer: u32, class: CellClass, sampled: BrickMask, particles: u32) -> CellDetail {
    let cell = MapCell { layer, particles, class, sampled, coarse: BrickMask::default() };
    let values = KnownValues::Between { low: 0.25, high: 0.5, covered: true };
    let depths = [1.0 + 0.1 * f64::from(layer), 1.1 + 0.1 * f64::from(layer)];
    CellDetail { cell, depths, values, bricks: None, slabs: None, shown: None }
}

/// A picture of which the bundle of that pixel is known.
fn probed(cells: Vec<CellDetail>) -> Session {
    let mut session = fluid();
    session.probe = Some([10, 12]);
    let mut shown = shown(&session, Stats::default());
    let bundle = BundleDetail {
        bundle: [1, 1],
        layers: 40,
        end_layer: 5,
        bound: Bound::Difference,
        budget: Some(0.004),
        charged: [0.0025; 16],
        cells,
    };
    let placement = Default::default();
    shown.probed = Some(Arc::new(Probed { asked: [10, 12], pixel: [10, 12], divisor: 1, bundle, placement }));
    session.note(&Report::Picture(Box::new(shown)));
    session
}

/// A picture of which the cells behind a pixel are known, one of each kind.
pub(super) fn looked_into() -> Session {
    let classes = [
        (CellClass::Transparent, BrickMask::default(), 12),
        (CellClass::Full, BrickMask::ALL, 1200),
        (CellClass::Mixed, BrickMask::ALL, 900),
        (CellClass::SuperPixel, BrickMask::default(), 340),
        (CellClass::Occluded, BrickMask::default(), 34),
    ];
    let cells = (2_u32..).zip(classes);
    probed(cells.map(|(layer, (class, sampled, particles))| cell(layer, class, sampled, particles)).collect())
}

#[test]
fn until_the_cells_are_known_it_says_that_it_looks() {
    assert_written(&inspector(pictured(fluid(), Stats::default())), &["Pixel 10, 12", "Looking…"]);
}

#[test]
fn the_cells_behind_the_pixel_are_told() {
    let cells = vec![
        cell(3, CellClass::Full, BrickMask::ALL, 1200),
        cell(4, CellClass::Occluded, BrickMask::default(), 34),
    ];
    let harness = inspector(probed(cells));
    assert_written(
        &harness,
        &[
            "Bundle 1, 1  ·  2 of 40 cells filled, 1 occluded  ·  1\u{202f}234 particle references",
            "Charged to the rays of this pixel: 0.0025 of 0.004",
            "1.30–1.40",
            "0.250–0.500",
            "1\u{202f}200",
            "64",
            "Occluded",
        ],
    );
}

#[test]
fn a_pixel_beside_the_fluid_says_so() {
    assert_written(&inspector(probed(Vec::new())), &["No particle reaches the rays of this bundle."]);
}

#[test]
fn it_closes_by_its_cross() {
    let mut harness = inspector(probed(Vec::new()));
    harness.get_by_label("Close (Escape)").click();
    harness.run();
    assert_eq!(harness.state().probe, None);
    assert!(texts(&harness).is_empty());
}
