//! What stands over the picture, and whether saved pictures have it, too.

use egui::{Slider, TextEdit, Ui};
use renderer::{AnnotationsView, Ink};

use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

pub fn show(ui: &mut Ui, session: &mut Session) {
    let before = session.annotations();
    let mut look = before.clone();
    let two_fields = session.view.quantity.opacity.is_some();
    items(ui, &mut look, two_fields);
    text(ui, "Title", &mut look.title, "Above the scene", "Written at the upper edge of the picture");
    if look.colour_bar {
        let hint = "Written over the colour bar in place of the quantity's name, such as: Velocity (m/s)";
        text(ui, "Bar title", &mut look.quantity_label, "The quantity's name", hint);
    }
    if look.opacity_bar && two_fields {
        let hint = "Written over the bar of the opacities in place of the name of their field";
        text(ui, "Opacity title", &mut look.opacity_label, "The field's name", hint);
    }
    if look.scale_bar {
        let hint = "Written behind lengths. Files do not say in which unit they are";
        text(ui, "Length unit", &mut look.length_unit, "None", hint);
    }
    if look.time {
        let hint = "Written behind times. Files do not say in which unit they are";
        text(ui, "Time unit", &mut look.time_unit, "None", hint);
    }
    widgets::row(ui, "Size", |ui| {
        ui.spacing_mut().slider_width = ui.available_width() - theme::FIELD_WIDTH - theme::GAP;
        let mut percent = 100.0 * look.size;
        let [least, most] = AnnotationsView::SIZES.map(|size| 100.0 * size);
        let slider = Slider::new(&mut percent, least..=most).logarithmic(true).suffix(" %").max_decimals(0);
        if ui.add(slider).on_hover_text("Sizes are in proportion to the picture's").changed() {
            look.size = (percent / 100.0).clamp(AnnotationsView::SIZES[0], AnnotationsView::SIZES[1]);
        }
    });
    widgets::row(ui, "Letters", |ui| {
        widgets::choice(
            ui,
            &mut look.ink,
            &[
                (Ink::Automatic, "Automatic", "Dark on a light background, light on a dark one and on none"),
                (Ink::Light, "Light", ""),
                (Ink::Dark, "Dark", ""),
            ],
        );
    });
    saved(ui, &mut look);
    session.annotate(&before, look);
}

fn items(ui: &mut Ui, look: &mut AnnotationsView, two_fields: bool) {
    let mut pair = |label, left: (&mut bool, &str, &str), right: (&mut bool, &str, &str)| {
        widgets::row(ui, label, |ui| {
            let width = 0.5 * (ui.available_width() - theme::GAP);
            for (on, name, hint) in [left, right] {
                let place = egui::vec2(width, theme::ROW_HEIGHT);
                ui.allocate_ui_with_layout(place, egui::Layout::left_to_right(egui::Align::Center), |ui| {
                    ui.set_min_width(width);
                    ui.checkbox(on, name).on_hover_text(hint);
                });
            }
        });
    };
    pair(
        "Show",
        (&mut look.colour_bar, "Colour bar", "The colours with the values that they stand for"),
        (&mut look.axes, "Axes", "Which way the scene is turned"),
    );
    pair(
        "",
        (&mut look.time, "Time", "The frame's time, where its file tells one"),
        (&mut look.frame_number, "Frame", "The frame's number, counted from 0"),
    );
    let hint = "A round length at the target's depth: what is closer looks larger, what is farther smaller";
    if two_fields {
        let opacity = "How opaque which value of the opacity's field is, as a curve";
        pair("", (&mut look.opacity_bar, "Opacity bar", opacity), (&mut look.scale_bar, "Scale bar", hint));
    } else {
        widgets::row(ui, "", |ui| ui.checkbox(&mut look.scale_bar, "Scale bar").on_hover_text(hint));
    }
}

fn text(ui: &mut Ui, label: &str, text: &mut String, nothing: &str, hint: &str) {
    widgets::row(ui, label, |ui| {
        let edit = TextEdit::singleline(text).hint_text(nothing).char_limit(AnnotationsView::MAX_TEXT);
        let width = ui.available_width();
        let response = ui.add_sized([width, theme::ROW_HEIGHT], edit).accessible_name(label);
        if response.on_hover_text(hint).changed() {
            text.retain(|letter| !letter.is_control());
        }
    });
}

fn saved(ui: &mut Ui, look: &mut AnnotationsView) {
    widgets::row(ui, "Saved pictures", |ui| {
        let choices = [
            (false, "Without", "The window alone shows them"),
            (true, "As shown here", "Saved pictures have what the window shows, and so has render --view"),
        ];
        widgets::choice(ui, &mut look.in_pictures, &choices);
    });
}
