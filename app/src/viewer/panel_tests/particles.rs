use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use renderer::{Kernel, Stats};

use super::{assert_written, fluid, panel, pictured};
use crate::viewer::panels::particles;

#[test]
fn a_support_radius_is_fixed_changed_and_let_go() {
    let mut harness = panel(pictured(fluid(), Stats::default()), particles::show);
    // Twice the distance of neighbours, where the file says nothing.
    assert_written(&harness, &["2", "64", "3 × 3 × 3"]);
    harness.get_by_label("fixed").click();
    harness.run();
    assert_eq!(harness.state().view.particles.support_radius, Some(2.0));
    harness.get_by_role_and_label(Role::SpinButton, "Support radius").set_value_accesskit(1.5);
    harness.run();
    assert_eq!(harness.state().view.particles.support_radius, Some(1.5));
    harness.get_by_label("fixed").click();
    harness.run();
    assert_eq!(harness.state().view.particles.support_radius, None);
}

#[test]
fn a_kernel_is_chosen_from_the_menu() {
    let mut harness = panel(pictured(fluid(), Stats::default()), particles::show);
    harness.get_by_role_and_label(Role::ComboBox, "Kernel").click();
    harness.run();
    harness.get_by_label("wendland-c2").click();
    harness.run();
    assert_eq!(harness.state().view.particles.kernel, Kernel::WendlandC2);
}
