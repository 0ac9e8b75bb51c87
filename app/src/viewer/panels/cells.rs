//! What lies over the picture: classes of cells, predicted errors, measured errors.

use egui::{ComboBox, RichText, Slider, Ui};
use renderer::{CELL_SLICES, CellClass, Stats};

use crate::overlay::look;
use crate::viewer::inspect::measurement::State;
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::picture::overlay::{Kind, Overlay, Which};
use crate::viewer::session::Session;
use crate::viewer::theme;
use crate::viewer::widgets::{self, Areas};

use super::cell_classes;

const KINDS: [(Kind, &str, &str); 4] = [
    (Kind::Off, "Off", "The picture alone"),
    (Kind::Classes, "Classes", "What became of the cells: 8 × 8 pixels × 16 slices each"),
    (
        Kind::Predicted,
        "Predicted",
        "The largest error that the pixels of each column of bricks may have, as charged to them",
    ),
    (Kind::Measured, "Measured", "The error of each pixel against full sampling; measures it first"),
];
const DEPTHS: [(Which, &str, &str); 3] = [
    (Which::FrontMost, "Front", "The first cell in which anything is to be seen"),
    (Which::Share, "Share", "How many of the cells along the ray are of one class"),
    (Which::Slice, "Slice", "The cells of one layer"),
];

pub fn show(ui: &mut Ui, session: &mut Session, measurement: Option<&State>, actions: &mut Vec<Action>) {
    let response = ui.horizontal(|ui| widgets::choice(ui, &mut session.overlay.kind, &KINDS));
    Areas::mark(ui, "overlay", response.response.rect);
    let adaptive = session.view.sampling.tolerance.is_some();
    if response.inner && session.overlay.kind == Kind::Measured && measurement.is_none() && adaptive {
        actions.push(Action::MeasureError);
    }
    let stats = session.picture.as_ref().map(|picture| &picture.stats);
    match session.overlay.kind {
        Kind::Off => {}
        Kind::Classes => {
            depth(ui, &mut session.overlay, stats);
            opacity(ui, &mut session.overlay);
        }
        Kind::Predicted => opacity(ui, &mut session.overlay),
        Kind::Measured => {
            opacity(ui, &mut session.overlay);
            if measurement.is_none() {
                let text = "Not measured for this view: see Sampling above.";
                ui.label(RichText::new(text).small().color(theme::colours().muted));
            }
        }
    }
    if matches!(session.overlay.kind, Kind::Classes | Kind::Predicted) {
        adapt_anyway(ui, session);
    }
    ui.add_space(4.0);
    cell_classes::show(ui, session);
}

/// Where adapting does not pay, all cells are alike: a way to see them adapted all the same.
fn adapt_anyway(ui: &mut Ui, session: &mut Session) {
    let given_up = session.picture.as_ref().is_some_and(|picture| {
        picture.sampling.tolerance.is_some()
            && !picture.sampling.always_adaptive
            && picture.stats.is_in_full()
    });
    if given_up {
        let text = "Sampled in full: to adapt this view would take longer than it saves.";
        ui.label(RichText::new(text).small().color(theme::colours().muted));
        let button = ui.button("Adapt it anyway").on_hover_text("Sampling: Adapt, even where it hardly pays");
        Areas::mark(ui, "adapt-anyway", button.rect);
        if button.clicked() {
            session.view.sampling.always_adaptive = true;
        }
    }
}

fn depth(ui: &mut Ui, overlay: &mut Overlay, stats: Option<&Stats>) {
    widgets::row(ui, "Depth", |ui| {
        let row = ui.horizontal(|ui| widgets::choice(ui, &mut overlay.which, &DEPTHS));
        Areas::mark(ui, "depth", row.response.rect);
    });
    match overlay.which {
        Which::FrontMost => {}
        Which::Share => widgets::row(ui, "Class", |ui| {
            let (width, name) = (ui.available_width(), look(overlay.class).name);
            let menu = ComboBox::from_id_salt("class").width(width).selected_text(name);
            let menu = menu.show_ui(ui, |ui| {
                for class in CellClass::ALL {
                    ui.selectable_value(&mut overlay.class, class, look(class).name);
                }
            });
            menu.response.accessible_name("Class");
        }),
        Which::Slice => slice(ui, overlay, stats),
    }
}

fn slice(ui: &mut Ui, overlay: &mut Overlay, stats: Option<&Stats>) {
    let Some(stats) = stats else { return };
    let layers = (stats.slices / u64::from(CELL_SLICES)) as u32;
    let mut layer = overlay.layer(layers);
    widgets::row(ui, "Layer", |ui| {
        let number = ui.spacing().interact_size.x;
        ui.spacing_mut().slider_width = ui.available_width() - number - ui.spacing().item_spacing.x;
        let slider = ui.add(Slider::new(&mut layer, 0..=layers.saturating_sub(1)));
        let slider = slider.accessible_name("Layer");
        Areas::mark(ui, "slice", slider.rect);
        if slider.changed() {
            overlay.set_layer(layer, layers);
        }
    });
    let [near, far] = [layer, layer + 1].map(|layer| widgets::short(depth_of(stats, layer)));
    ui.scope(|ui| widgets::fact(ui, "View depth", format!("{near} to {far}")));
}

/// View depth where a layer begins.
pub fn depth_of(stats: &Stats, layer: u32) -> f64 {
    let share = f64::from(layer * CELL_SLICES) / stats.slices.max(1) as f64;
    stats.near * (stats.far / stats.near).powf(share)
}

fn opacity(ui: &mut Ui, overlay: &mut Overlay) {
    widgets::row(ui, "Opacity", |ui| {
        let number = ui.spacing().interact_size.x;
        ui.spacing_mut().slider_width = ui.available_width() - number - ui.spacing().item_spacing.x;
        let mut percent = 100.0 * overlay.opacity();
        let slider = ui.add(Slider::new(&mut percent, 0.0..=100.0).fixed_decimals(0).suffix(" %"));
        if slider.accessible_name("Opacity").changed() {
            *overlay.opacity_mut() = percent / 100.0;
        }
    });
}
