use egui_kittest::kittest::Queryable;

use super::{count, fluid, panel};
use crate::viewer::panels::quantity;
use crate::viewer::session::RangeSource;

#[test]
fn a_field_is_chosen_from_the_menu() {
    let mut harness = panel(fluid(), |ui, session| {
        quantity::show(ui, session);
        count(session);
    });
    harness.get_by_role(egui::accesskit::Role::ComboBox).click();
    harness.run();
    harness.get_by_label("velocity.x").click();
    harness.run();
    assert_eq!(harness.state().view.quantity.name.as_deref(), Some("velocity.x"));
}

#[test]
fn a_fixed_range_is_the_one_in_effect_until_it_is_edited() {
    let mut harness = panel(fluid(), quantity::show);
    let before = harness.state().range();
    harness.get_by_label("Fixed").click();
    harness.run();
    assert_eq!(harness.state().range_source, RangeSource::Fixed);
    assert_eq!(harness.state().view.quantity.range, before);
}
