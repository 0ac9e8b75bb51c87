use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{CellClass, CellClasses, Evaluations, Stats};

use super::{assert_written, fluid, panel, pictured};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::panels::cells;
use crate::viewer::picture::overlay::{Kind, Which};
use crate::viewer::session::Session;

type State = (Session, Vec<Action>);

/// The panel over an adaptive picture of 33 layers between the depths 1 and 4.
fn over(evaluations: Evaluations) -> Harness<'static, State> {
    let cells_by_class =
        CellClasses { full: 2000, super_pixel: 5000, transparent: 2999, occluded: 1, ..Default::default() };
    let stats =
        Stats { cells_by_class, evaluations, slices: 33 * 16, near: 1.0, far: 4.0, ..Default::default() };
    panel((pictured(fluid(), stats), Vec::new()), |ui, (session, actions)| {
        cells::show(ui, session, None, actions);
    })
}

fn adaptive() -> Harness<'static, State> {
    over(Evaluations { done: 100, bounds: 20, ..Default::default() })
}

fn click(harness: &mut Harness<'_, State>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

#[test]
fn cells_are_told_by_class_as_counts_and_shares() {
    let harness = adaptive();
    assert_written(&harness, &["Full", "2\u{202f}000", "20.0 %", "Super-pixel", "50.0 %"]);
    // One cell of ten thousand is not none.
    assert_written(&harness, &["Occluded", "1", "< 0.1 %"]);
}

#[test]
fn overlays_are_chosen_and_the_measured_one_measures() {
    let mut harness = adaptive();
    for (label, kind) in [("Classes", Kind::Classes), ("Predicted", Kind::Predicted), ("Off", Kind::Off)] {
        click(&mut harness, label);
        assert_eq!(harness.state().0.overlay.kind, kind);
    }
    assert!(harness.state().1.is_empty());
    click(&mut harness, "Measured");
    assert_eq!(harness.state().1, [Action::MeasureError]);
    assert_written(&harness, &["Not measured for this view: see Sampling above."]);

    let mut full = adaptive();
    full.state_mut().0.view.sampling.tolerance = None;
    click(&mut full, "Measured");
    assert!(full.state().1.is_empty(), "at full sampling there is no error to measure");
}

#[test]
fn classes_are_shown_at_the_front_as_shares_or_in_slices() {
    let mut harness = adaptive();
    click(&mut harness, "Classes");
    click(&mut harness, "Share");
    harness.get_by_role_and_label(Role::ComboBox, "Class").click();
    harness.run();
    harness.get_by_role_and_label(Role::Button, "Occluded").click();
    harness.run();
    assert_eq!(harness.state().0.overlay.class, CellClass::Occluded);

    click(&mut harness, "Slice");
    assert_eq!(harness.state().0.overlay.which, Which::Slice);
    assert_written(&harness, &["1.958 to 2.042"]);
    harness.get_by_role_and_label(Role::Slider, "Layer").set_value_accesskit(32.0);
    harness.run();
    assert_eq!(harness.state().0.overlay.layer(33), 32);
    assert_written(&harness, &["3.835 to 4"]);

    harness.get_by_role_and_label(Role::Slider, "Opacity").set_value_accesskit(25.0);
    harness.run();
    assert_eq!(harness.state().0.overlay.opacity(), 0.25);
}

#[test]
fn a_picture_that_was_not_worth_adapting_can_be_adapted_anyway() {
    let mut harness = over(Evaluations { full: 100, done: 120, bounds: 20, ..Default::default() });
    click(&mut harness, "Predicted");
    click(&mut harness, "Adapt it anyway");
    assert!(harness.state().0.view.sampling.always_adaptive);
    let mut harness = adaptive();
    click(&mut harness, "Predicted");
    assert!(harness.query_by_label("Adapt it anyway").is_none());
}
