//! Field of view, up, and the depths between which the scene is drawn.

use egui::Ui;
use glam::DVec3;

use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

pub fn show(ui: &mut Ui, session: &mut Session) {
    let drawn = session.picture.as_ref().map(|picture| [picture.stats.near, picture.stats.far]);
    let Some(camera) = &mut session.camera else {
        ui.label(egui::RichText::new("No picture yet.").color(theme::FAINT));
        return;
    };
    widgets::row(ui, "Field of view", |ui| {
        let field = egui::DragValue::new(&mut camera.fov_y_degrees).range(1.0..=120.0).speed(0.2);
        ui.add(field.suffix("°").max_decimals(1)).on_hover_text("Vertical angle of view");
    });
    widgets::row(ui, "Up", |ui| {
        let mut axle = camera.axle();
        let other = axle != DVec3::Y && axle != DVec3::Z;
        let mut choices = vec![(DVec3::Y, "Y", ""), (DVec3::Z, "Z", "")];
        if other {
            choices.push((axle, "As loaded", "The up vector of the view that was loaded"));
        }
        if widgets::choice(ui, &mut axle, &choices) {
            camera.set_axle(axle);
        }
    });
    let Some([near, far]) = drawn else { return };
    depth(ui, "Near", &mut camera.near, near, [0.0, camera.far.unwrap_or(f64::MAX)]);
    depth(ui, "Far", &mut camera.far, far, [camera.near.unwrap_or(0.0), f64::MAX]);
}

/// A view depth: fitted to the scene, or cut by hand within `limits`.
fn depth(ui: &mut Ui, label: &str, setting: &mut Option<f64>, fitted: f64, limits: [f64; 2]) {
    widgets::row(ui, label, |ui| {
        let mut by_hand = setting.is_some();
        let mut value = setting.unwrap_or(fitted);
        let range = limits[0].max(fitted * 1e-6) * 1.001..=limits[1] / 1.001;
        let hint = "View depth at which the scene is cut; otherwise fitted to the particles";
        if ui.add(widgets::number(&mut value, fitted).range(range)).on_hover_text(hint).changed() {
            *setting = Some(value);
        }
        if ui.checkbox(&mut by_hand, "fixed").on_hover_text(hint).changed() {
            *setting = by_hand.then_some(value);
        }
    });
}
