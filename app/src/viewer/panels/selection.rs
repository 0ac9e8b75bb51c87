//! Which particles are in the picture: clip box, clip plane, and filters by value.

use egui::{Align, Layout, RichText, Ui};
use glam::DVec3;
use renderer::{Bounds, ClipBox, ClipPlane, Filter};

use crate::viewer::icons::{self, Icon};
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

use super::filters;

pub fn show(ui: &mut Ui, session: &mut Session, handles: &mut bool) {
    let Some(scene) = session.scene_bounds() else {
        ui.label(RichText::new("No picture yet.").color(theme::colours().faint));
        return;
    };
    add(ui, session, &scene);
    let looking = session.camera.map_or(DVec3::NEG_Z, |camera| -camera.axes()[2]);
    let select = &mut session.view.select;
    let clips = select.clip_box.is_some() || select.clip_plane.is_some();
    if let Some(clip) = &mut select.clip_box
        && !clip_box(ui, clip, &scene)
    {
        select.clip_box = None;
    }
    if let Some(clip) = &mut select.clip_plane
        && !clip_plane(ui, clip, &scene, looking)
    {
        select.clip_plane = None;
    }
    filters::show(ui, session);
    if clips {
        ui.add_space(2.0);
        let hint = "Outlines of box and plane over the picture, with dots to drag them by; not saved with it";
        ui.checkbox(handles, "Handles in the picture").on_hover_text(hint);
    }
    told(ui, session);
}

/// Buttons for what is not there yet.
fn add(ui: &mut Ui, session: &mut Session, scene: &Bounds) {
    let looking = session.camera.map_or(DVec3::NEG_Z, |camera| -camera.axes()[2]);
    let extremes = session.analysis.as_ref().and_then(|analysis| analysis.colour.extremes);
    let shown = session.shown_quantity();
    let select = &mut session.view.select;
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
        let mut button = |enabled: bool, label: &'static str, hint: &'static str| {
            let button = egui::Button::new(label).min_size(egui::vec2(width, theme::ROW_HEIGHT));
            let button = ui.add_enabled(enabled, button).on_hover_text(hint);
            widgets::Areas::mark(ui, label, button.rect);
            button.clicked()
        };
        if button(select.clip_box.is_none(), "+ Box", "Keep what lies inside a box, or outside of it") {
            let Bounds { min, max } = *scene;
            select.clip_box =
                Some(ClipBox { min, max, rotation_degrees: DVec3::ZERO, invert: false, on: true });
        }
        if button(select.clip_plane.is_none(), "+ Plane", "Keep what lies on one side of a plane") {
            let normal = axis_along(looking);
            select.clip_plane = Some(ClipPlane { point: scene.centre(), normal, invert: false, on: true });
        }
        let filter =
            shown.zip(extremes).map(|(field, range)| Filter { field, range, invert: false, on: true });
        let hint = "Keep the particles with values in a range, or outside of it";
        if button(filter.is_some(), "+ Filter", hint) {
            select.filters.extend(filter);
        }
    });
}

/// How many particles that leaves.
fn told(ui: &mut Ui, session: &mut Session) {
    if session.view.select.is_empty() {
        return;
    }
    if let Some(picture) = &session.picture {
        let [shown, all] = [picture.facts.particles, picture.facts.whole].map(|count| count as u64);
        let text = format!("{} of {}", widgets::count(shown), widgets::count(all));
        widgets::fact(ui, "Particles in the picture", text);
    }
    if ui.button("Remove all").on_hover_text("Back to the whole frame").clicked() {
        session.view.select = Default::default();
    }
}

/// The axis that is closest to `direction`, as a unit vector: from the front, the half before the
/// middle is cut away.
fn axis_along(direction: DVec3) -> DVec3 {
    let size = direction.abs();
    match () {
        () if size.x >= size.y && size.x >= size.z => DVec3::X * direction.x.signum(),
        () if size.y >= size.z => DVec3::Y * direction.y.signum(),
        () => DVec3::Z * direction.z.signum(),
    }
}

/// A line with a switch, the choice to invert, and a cross. Returns whether the thing is kept.
pub fn header(ui: &mut Ui, name: &str, on: &mut bool, invert: &mut bool, meaning: &str) -> bool {
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        ui.set_min_height(theme::ROW_HEIGHT);
        ui.checkbox(on, RichText::new(name).strong()).on_hover_text("Whether it has an effect");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let removed = icons::button(ui, Icon::Cross, &format!("Remove {name}"), true).clicked();
            let invert = ui.checkbox(invert, "Invert");
            invert.on_hover_text(meaning).accessible_name(format!("Invert {name}"));
            !removed
        })
        .inner
    })
    .inner
}

fn clip_box(ui: &mut Ui, clip: &mut ClipBox, scene: &Bounds) -> bool {
    let kept = header(ui, "Box", &mut clip.on, &mut clip.invert, "Keep what lies outside the box");
    let scale = scene.diagonal();
    for (axis, label) in ["X", "Y", "Z"].into_iter().enumerate() {
        widgets::row(ui, label, |ui| {
            let mut ends = [clip.min[axis], clip.max[axis]];
            if ends_of(ui, &mut ends, scale, &format!("Box {label}")) {
                (clip.min[axis], clip.max[axis]) = (ends[0], ends[1]);
            }
        });
    }
    widgets::row(ui, "Turned", |ui| {
        let hint = "Turns the box around its middle: about X, then Y, then Z of the world";
        three(ui, clip.rotation_degrees.as_mut(), "Box turned about", |angle| {
            egui::DragValue::new(angle).speed(0.5).suffix("°").max_decimals(1)
        })
        .on_hover_text(hint);
    });
    let width = ui.available_width();
    let hint = "The box around all particles seen so far, not turned";
    if widgets::wide_button(ui, "Fit to the scene", width).on_hover_text(hint).clicked() {
        (clip.min, clip.max, clip.rotation_degrees) = (scene.min, scene.max, DVec3::ZERO);
    }
    kept
}

fn clip_plane(ui: &mut Ui, clip: &mut ClipPlane, scene: &Bounds, looking: DVec3) -> bool {
    let kept =
        header(ui, "Plane", &mut clip.on, &mut clip.invert, "Keep the side that the normal points away from");
    widgets::row(ui, "Facing", |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().button_padding.x = 2.0;
        let width = (ui.available_width() - 8.0) / 5.0;
        let presets = [
            ("X", DVec3::X, "Across X, through the middle of the scene"),
            ("Y", DVec3::Y, "Across Y, through the middle of the scene"),
            ("Z", DVec3::Z, "Across Z, through the middle of the scene"),
            ("View", looking, "Facing you, through the middle of the scene"),
        ];
        for (label, normal, hint) in presets {
            if widgets::wide_button(ui, label, width).on_hover_text(hint).clicked() {
                (clip.point, clip.normal) = (scene.centre(), normal);
            }
        }
        if widgets::wide_button(ui, "Flip", width).on_hover_text("Keep the other side").clicked() {
            clip.normal = -clip.normal;
        }
    });
    offset(ui, clip, scene);
    let scale = scene.diagonal();
    widgets::row(ui, "Point", |ui| {
        three(ui, clip.point.as_mut(), "Point of the plane", |x| {
            widgets::number(x, scale).custom_formatter(move |x, _| widgets::on_scale(x, scale))
        })
        .on_hover_text("Any point of the plane, in the unit of the run");
    });
    widgets::row(ui, "Normal", |ui| {
        let mut normal = clip.normal;
        three(ui, normal.as_mut(), "Normal of the plane", |x| {
            egui::DragValue::new(x).speed(0.01).max_decimals(3)
        })
        .on_hover_text("Points to the side that is kept; of any length");
        if normal.try_normalize().is_some() {
            clip.normal = normal;
        }
    });
    kept
}

/// Where the plane is along its normal, from one end of the scene to the other.
fn offset(ui: &mut Ui, clip: &mut ClipPlane, scene: &Bounds) {
    let Some(normal) = clip.direction() else { return };
    let middle = scene.centre();
    let reach = 0.5 * (scene.max - scene.min).dot(normal.abs());
    let mut offset = (clip.point - middle).dot(normal);
    widgets::row(ui, "Offset", |ui| {
        let number = ui.spacing().interact_size.x;
        ui.spacing_mut().slider_width = ui.available_width() - number - ui.spacing().item_spacing.x;
        let slider = egui::Slider::new(&mut offset, -reach..=reach)
            .clamping(egui::SliderClamping::Never)
            .custom_formatter(move |value, _| widgets::on_scale(value, reach));
        let slider = ui.add(slider).accessible_name("Offset of the plane");
        if slider.on_hover_text("Distance from the middle of the scene, along the normal").changed() {
            clip.point += (offset - (clip.point - middle).dot(normal)) * normal;
        }
    });
}

/// Two numbers, the ends of a range, which carry each other along. Returns whether they changed.
pub fn ends_of(ui: &mut Ui, ends: &mut [f64; 2], scale: f64, name: &str) -> bool {
    ui.spacing_mut().button_padding.x = 3.0;
    const BETWEEN: f32 = 16.0;
    let width = (ui.available_width() - BETWEEN - 2.0 * ui.spacing().item_spacing.x) / 2.0;
    let size = egui::vec2(width, ui.spacing().interact_size.y);
    let [low, high] = ends;
    let lower = ui.add_sized(size, widgets::number(low, scale)).accessible_name(format!("{name} from"));
    ui.add_sized([BETWEEN, size.y], egui::Label::new("to"));
    let upper = ui.add_sized(size, widgets::number(high, scale)).accessible_name(format!("{name} to"));
    match (lower.changed(), upper.changed()) {
        (true, _) => *high = high.max(*low),
        (_, true) => *low = low.min(*high),
        _ => return false,
    }
    low.is_finite() && high.is_finite()
}

/// Three numbers side by side.
fn three<'a>(
    ui: &mut Ui,
    values: &'a mut [f64; 3],
    name: &str,
    field: impl Fn(&'a mut f64) -> egui::DragValue<'a>,
) -> egui::Response {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        ui.spacing_mut().button_padding.x = 2.0;
        let size = egui::vec2((ui.available_width() - 6.0) / 3.0, ui.spacing().interact_size.y);
        ui.spacing_mut().interact_size.x = size.x;
        for (value, axis) in values.iter_mut().zip(["X", "Y", "Z"]) {
            ui.add_sized(size, field(value)).accessible_name(format!("{name} {axis}"));
        }
    })
    .response
}
