//! How particles become a continuous field: support radius and kernel.

use egui::Ui;
use renderer::Kernel;

use crate::viewer::session::Session;
use crate::viewer::widgets;

pub fn show(ui: &mut Ui, session: &mut Session) {
    let facts = session.picture.as_ref().map(|picture| picture.facts.clone()).unwrap_or_default();
    let [smallest, largest] = facts.support_radii;
    let settings = &mut session.view.particles;
    widgets::row(ui, "Support", |ui| {
        let mut by_hand = settings.support_radius.is_some();
        let mut radius = settings.support_radius.unwrap_or(largest);
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let field = widgets::number(&mut radius, scale).range(scale * 1e-3..=scale * 1e3);
        let field = ui.add(field).accessible_name("Support radius");
        let field = field.on_hover_text("Radius at which the kernel reaches zero");
        if field.changed() {
            settings.support_radius = Some(radius);
        }
        let hint =
            "One radius for all particles; otherwise what the file says, or an estimate from the spacing";
        if ui.checkbox(&mut by_hand, "fixed").on_hover_text(hint).changed() {
            settings.support_radius = by_hand.then_some(radius);
        }
    });
    widgets::row(ui, "Kernel", |ui| {
        let width = ui.available_width();
        let menu = egui::ComboBox::from_id_salt("kernel").width(width);
        let menu = menu.selected_text(settings.kernel.name()).show_ui(ui, |ui| {
            for kernel in Kernel::ALL {
                ui.selectable_value(&mut settings.kernel, kernel, kernel.name());
            }
        });
        menu.response.accessible_name("Kernel");
    });
    let shown = widgets::count(facts.particles as u64);
    widgets::fact(
        ui,
        "Particles",
        match facts.particles < facts.whole {
            true => format!("{shown} of {}", widgets::count(facts.whole as u64)),
            false => shown,
        },
    );
    if smallest < largest {
        widgets::fact(
            ui,
            "Support radii",
            format!("{} … {}", widgets::short(smallest), widgets::short(largest)),
        );
    }
    if facts.rejected.total() > 0 {
        widgets::fact(ui, "Left out", widgets::count(facts.rejected.total()));
    }
    if let Some(bounds) = facts.bounds {
        let size = (bounds.max - bounds.min).to_array().map(widgets::short);
        widgets::fact(ui, "Extent", size.join(" × "));
    }
}
