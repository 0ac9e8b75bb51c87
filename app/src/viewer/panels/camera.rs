//! How the camera is moved, where it is in numbers, its lens, and the depths between which the scene is drawn.

use egui::{DragValue, RichText, Ui};
use glam::DVec3;

use crate::viewer::keys::shortcuts::{Action, hint};
use crate::viewer::orbit_camera::OrbitCamera;
use crate::viewer::picture::picture_view::Motion;
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

pub fn show(ui: &mut Ui, session: &mut Session, motion: &mut Motion, actions: &mut Vec<Action>) {
    let drawn = session.picture.as_ref().map(|picture| [picture.stats.near, picture.stats.far]);
    let cut = session.picture.as_ref().map_or([None; 2], |picture| picture.facts.cut);
    let Some(camera) = &mut session.camera else {
        ui.label(RichText::new("No picture yet.").color(theme::colours().faint));
        return;
    };
    let before = *camera;
    widgets::row(ui, "Move by", |ui| {
        let walk = "W A S D keep the height, whatever is looked at; Q and E sink and rise";
        let choices = [
            (Motion::Orbit, "Orbit", "A drag turns the scene around the target"),
            (Motion::Fly, "Fly", "W A S D go where the camera looks, a drag looks around"),
            (Motion::Walk, "Walk", walk),
        ];
        widgets::choice(ui, motion, &choices);
    });
    place(ui, camera);
    axle(ui, camera);
    roll(ui, camera);
    widgets::row(ui, "Field of view", |ui| {
        let field = DragValue::new(&mut camera.fov_y_degrees).range(0.1..=170.0).speed(0.2);
        let field = ui.add(field.suffix("°").max_decimals(2));
        field.accessible_name("Field of view").on_hover_text("Vertical angle of view");
    });
    if let Some([near, far]) = drawn {
        depth(ui, "Near", &mut camera.near, near, [0.0, camera.far.unwrap_or(f64::MAX)]);
        depth(ui, "Far", &mut camera.far, far, [camera.near.unwrap_or(0.0), f64::MAX]);
    }
    warn(ui, camera, cut);
    if *camera != before {
        session.steered(std::time::Instant::now());
    }
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
        for (label, action) in
            [("Whole scene", Action::Reset), ("Copy", Action::CopyCamera), ("Paste", Action::PasteCamera)]
        {
            let button = widgets::wide_button(ui, label, width).on_hover_text(hint(ui.ctx(), action));
            if button.clicked() {
                actions.push(action);
            }
        }
    });
}

/// Eye, target and up in numbers. What makes no camera is not taken.
fn place(ui: &mut Ui, camera: &mut OrbitCamera) {
    let scale = camera.distance();
    let mut view = camera.to_view();
    let mut changed = point(ui, "Eye", &mut view.eye, scale, "Where the camera is, in the unit of the run");
    changed |= point(ui, "Target", &mut view.target, scale, "What it looks at, and orbits around");
    changed |= point(ui, "Up", &mut view.up, 1.0, "What is up in the picture, of any length");
    if changed && view.validate().is_ok() {
        camera.adopt(&view);
    }
}

fn point(ui: &mut Ui, label: &str, point: &mut DVec3, scale: f64, hint: &str) -> bool {
    widgets::row(ui, label, |ui| {
        let gap = 4.0;
        ui.spacing_mut().item_spacing.x = gap;
        ui.spacing_mut().interact_size.x = ((ui.available_width() - 2.0 * gap) / 3.0).floor();
        ui.spacing_mut().button_padding.x = 2.0;
        let mut changed = false;
        for (axis, value) in ["x", "y", "z"].into_iter().zip(point.as_mut()) {
            // Taken when it is complete: half a number may be no camera.
            // A thousandth of the scale is all that there is room for.
            let unit = 10_f64.powf(scale.log10().floor() - 3.0);
            let shown = move |value: f64, _| widgets::short((value / unit).round() * unit);
            let field = widgets::number(value, scale).custom_formatter(shown).update_while_editing(false);
            let name = format!("{label} {axis}");
            changed |=
                ui.add(field).accessible_name(&name).on_hover_text(format!("{name}. {hint}")).changed();
        }
        changed
    })
}

fn axle(ui: &mut Ui, camera: &mut OrbitCamera) {
    widgets::row(ui, "Turntable", |ui| {
        let mut axle = camera.axle();
        let other = axle != DVec3::Y && axle != DVec3::Z;
        let mut choices =
            vec![(DVec3::Y, "Y up", "A drag turns the scene around Y"), (DVec3::Z, "Z up", "Around Z")];
        if other {
            choices.push((axle, "As given", "Around the up vector that was loaded or typed"));
        }
        if widgets::choice(ui, &mut axle, &choices) {
            camera.set_axle(axle);
        }
    });
}

/// Degrees of one press.
const STEP: f64 = 15.0;

fn roll(ui: &mut Ui, camera: &mut OrbitCamera) {
    widgets::row(ui, "Roll", |ui| {
        let mut degrees = camera.roll().to_degrees();
        let field = DragValue::new(&mut degrees).range(-180.0..=180.0).speed(0.5).suffix("°").max_decimals(2);
        let hint = "Turns the camera around its view; Ctrl + Shift + drag does so in the picture";
        if ui.add(field).accessible_name("Roll").on_hover_text(hint).changed() {
            camera.set_roll(degrees.to_radians());
        }
        let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
        ui.spacing_mut().button_padding.x = 2.0;
        for (label, degrees) in [("−15°", degrees - STEP), ("+15°", degrees + STEP), ("Level", 0.0)] {
            if widgets::wide_button(ui, label, width).clicked() {
                camera.set_roll(degrees.to_radians());
            }
        }
    });
}

/// A view depth: fitted to the scene, or cut by hand within `limits`.
fn depth(ui: &mut Ui, label: &str, setting: &mut Option<f64>, fitted: f64, limits: [f64; 2]) {
    widgets::row(ui, label, |ui| {
        let mut automatic = setting.is_none();
        let mut value = setting.unwrap_or(fitted);
        let range = limits[0].max(fitted * 1e-6) * 1.001..=limits[1] / 1.001;
        let hint = "View depth at which the scene is cut";
        let field = widgets::number(&mut value, fitted).range(range);
        if ui.add(field).accessible_name(label).on_hover_text(hint).changed() {
            *setting = Some(value);
        }
        let name = format!("{label} automatic");
        let fit = ui.checkbox(&mut automatic, "automatic").accessible_name(&name);
        if fit.on_hover_text("Fitted to the particles in front of the camera: nothing is cut off").changed() {
            *setting = (!automatic).then_some(value);
        }
    });
}

/// Says where near or far cut off what is in the picture.
fn warn(ui: &mut Ui, camera: &mut OrbitCamera, cut: [Option<f64>; 2]) {
    for (what, depth, setting) in [
        ("Near cuts off particles: they begin at", cut[0], &mut camera.near),
        ("Far cuts off particles: they end at", cut[1], &mut camera.far),
    ] {
        let Some(depth) = depth.filter(|_| setting.is_some()) else { continue };
        ui.horizontal(|ui| {
            let text = format!("{what} {}", widgets::short(depth));
            ui.label(RichText::new(text).small().color(theme::colours().warning));
            let name = if what.starts_with("Near") { "Fit near" } else { "Fit far" };
            if ui.small_button(name).on_hover_text("Automatic: nothing is cut off").clicked() {
                *setting = None;
            }
        });
    }
}
