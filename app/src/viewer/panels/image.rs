//! Size and background of the picture, and saving it.

use egui::Ui;
use renderer::ImageView;

use crate::viewer::keys::shortcuts::{Action, hint, keys};
use crate::viewer::session::Session;
use crate::viewer::widgets;

/// Sizes on offer.
pub const SIZES: [(&str, [u32; 2]); 6] = [
    ("HD  1280 × 720", [1280, 720]),
    ("Full HD  1920 × 1080", [1920, 1080]),
    ("4K  3840 × 2160", [3840, 2160]),
    ("8K  7680 × 4320", [7680, 4320]),
    ("Square  1024 × 1024", [1024, 1024]),
    ("Square  2048 × 2048", [2048, 2048]),
];

pub fn show(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    size(ui, session);
    background(ui, session);
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        let width = 0.5 * (ui.available_width() - ui.spacing().item_spacing.x);
        let save = widgets::wide_button(ui, "Save picture…", width);
        if save.on_hover_text(hint(ui.ctx(), Action::SavePicture)).clicked() {
            actions.push(Action::SavePicture);
        }
        let quick = widgets::wide_button(ui, "Save in folder", width);
        if quick
            .on_hover_text(format!(
                "Picture and view, in the folder where the program was started  ({})",
                keys(ui.ctx(), Action::QuickSave)
            ))
            .clicked()
        {
            actions.push(Action::QuickSave);
        }
    });
    let width = ui.available_width();
    let export = widgets::wide_button(ui, "Export pictures or a video…", width);
    if export.on_hover_text(hint(ui.ctx(), Action::Export)).clicked() {
        actions.push(Action::Export);
    }
}

fn size(ui: &mut Ui, session: &mut Session) {
    let fitted = session.fitted();
    if session.fits_window {
        [session.view.image.width, session.view.image.height] = fitted.map(|side| side.max(1));
    }
    let mut image = session.view.image;
    widgets::row(ui, "Size", |ui| {
        let chosen = if session.fits_window { "As the window" } else { "By hand" };
        let width = ui.available_width();
        egui::ComboBox::from_id_salt("size").width(width).selected_text(chosen).show_ui(ui, |ui| {
            if ui.selectable_label(session.fits_window, "As the window").clicked() {
                session.fits_window = true;
            }
            for (name, [width, height]) in SIZES {
                let here = !session.fits_window && [image.width, image.height] == [width, height];
                if ui.selectable_label(here, name).clicked() {
                    session.fits_window = false;
                    (image.width, image.height) = (width, height);
                }
            }
        });
    });
    widgets::row(ui, "Pixels", |ui| {
        let before = image;
        let field = |side| egui::DragValue::new(side).range(1..=ImageView::MAX_SIDE).speed(2.0);
        ui.add(field(&mut image.width));
        ui.label("×");
        ui.add(field(&mut image.height));
        if image != before {
            session.fits_window = false;
        }
    });
    session.view.image = image;
}

fn background(ui: &mut Ui, session: &mut Session) {
    let background = &mut session.view.image.background;
    widgets::row(ui, "Background", |ui| {
        // Four things in one row: the colour is no wider than it must be.
        ui.spacing_mut().interact_size.x = 36.0;
        let mut solid = background.is_some();
        if ui
            .checkbox(&mut solid, "")
            .on_hover_text("Without one, the saved picture is transparent")
            .changed()
        {
            *background = solid.then_some([0.0; 3]);
        }
        match background {
            Some(colour) => {
                ui.color_edit_button_rgb(colour);
                if ui.button("Black").clicked() {
                    *colour = [0.0; 3];
                }
                if ui.button("White").clicked() {
                    *colour = [1.0; 3];
                }
            }
            None => {
                ui.label("transparent");
            }
        }
    });
}
