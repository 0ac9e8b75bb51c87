use std::sync::Arc;

use egui_kittest::Harness;
use renderer::{BrickMask, BundleCells, CellClass, CellMap, MapCell, Stats};

use super::{assert_written, fluid, panel, shown, texts};
use crate::viewer::panels::overlay_legend;
use crate::viewer::picture::layers::Layers;
use crate::viewer::picture::overlay::{Kind, Overlay, Which};
use crate::viewer::session::Session;

type State = (Session, Layers);

/// A picture of three bundles, two of which begin with a sampled cell and one with a super-pixel.
fn over(choose: impl FnOnce(&mut Overlay)) -> Harness<'static, State> {
    let bundle = |class| BundleCells {
        end_layer: 1,
        charged: [0.002; 16],
        cells: vec![MapCell {
            layer: 0,
            particles: 3,
            class,
            sampled: BrickMask::default(),
            coarse: BrickMask::default(),
        }],
    };
    let bundles = [CellClass::Full, CellClass::SuperPixel, CellClass::Full].map(bundle).to_vec();
    let map = CellMap { size: [24, 8], count: [3, 1], layers: 1, bundles };
    let mut session = fluid();
    choose(&mut session.overlay);
    let mut shown = shown(&session, Stats::default());
    (shown.width, shown.height, shown.pixels) = (24, 8, vec![[0, 0, 0, 255]; 24 * 8]);
    shown.cells = Some(Arc::new(map));
    let mut layers = Layers::default();
    layers.set(shown);
    layers.refresh(&session.overlay);
    panel((session, layers), |ui, (session, layers)| {
        let picture = egui::Rect::from_min_size(ui.max_rect().min, egui::vec2(600.0, 400.0));
        overlay_legend::show(ui, session, layers, None, picture);
    })
}

#[test]
fn classes_are_named_with_the_share_of_the_picture_that_they_cover() {
    let harness = over(|overlay| overlay.kind = Kind::Classes);
    assert_written(&harness, &["Front-most cells", "Full", "66.7 %", "Super-pixel", "33.3 %"]);
    assert!(!texts(&harness).iter().any(|text| text == "Occluded"), "only what is to be seen");
}

#[test]
fn shares_and_errors_have_a_scale() {
    let share = over(|overlay| {
        (overlay.kind, overlay.which, overlay.class) = (Kind::Classes, Which::Share, CellClass::Full);
    });
    assert_written(&share, &["cells: full", "0 %", "100 %"]);
    let predicted = over(|overlay| overlay.kind = Kind::Predicted);
    assert_written(&predicted, &["predicted error", "0", "0.004"]);
}

#[test]
fn nothing_over_the_picture_has_no_legend() {
    assert!(texts(&over(|_| {})).is_empty());
}
