//! Which field decides the opacity, where that is another one than the colour's.

use egui::{RichText, Ui};
use renderer::OpacityView;

use crate::frames::Frame;
use crate::scene::quantity_names;
use crate::viewer::session::{RangeSource, Role, Session};
use crate::viewer::{theme, widgets};

use super::quantity::{describe, values};

/// What the menu says where one field decides both.
const SAME: &str = "the same field";

pub fn show(ui: &mut Ui, session: &mut Session, frame: &Frame) {
    let hint = "Another field may decide how opaque the fluid is: colour by velocity, say, and opacity by \
                density. Both are read from the transfer function, each at its own value in its own range.";
    let field = session.opacity_field().map(|name| name.or_else(|| session.shown_quantity()));
    let label = match &field {
        None => SAME.to_owned(),
        Some(name) => name.clone().unwrap_or_else(|| "none in this file".into()),
    };
    ui.add_space(4.0);
    widgets::row(ui, "Opacity by", |ui| {
        let width = ui.available_width();
        let menu = egui::ComboBox::from_id_salt("opacity").width(width).selected_text(label).truncate();
        let menu = menu.show_ui(ui, |ui| {
            if ui.selectable_label(field.is_none(), SAME).clicked() {
                session.view.quantity.opacity = None;
            }
            ui.separator();
            for name in quantity_names(frame) {
                let chosen = field.as_ref().is_some_and(|field| field.as_deref() == Some(name.as_str()));
                if ui.selectable_label(chosen, describe(&name, frame)).clicked() && !chosen {
                    choose(session, name);
                }
            }
        });
        menu.response.on_hover_text(hint).accessible_name("Opacity by");
    });
    if field.is_some() {
        ui.push_id("opacity", |ui| {
            let names = ["Lowest value of the opacity", "Highest value of the opacity"];
            values(ui, session, Role::Opacity, names);
        });
        let colour = session.shown_quantity().unwrap_or_default();
        let opacity = field.flatten().unwrap_or_default();
        let text = format!(
            "In the transfer function, nodes and histogram are of {opacity}, colours of {colour}. Outside its \
             range, {opacity} is as opaque as at the nearer end."
        );
        ui.label(RichText::new(text).small().color(theme::colours().muted));
    }
}

fn choose(session: &mut Session, name: String) {
    session.view.quantity.opacity = Some(OpacityView { name: Some(name), ..OpacityView::default() });
    // A range by hand is of the field before.
    session.opacity_source = match session.range_source {
        RangeSource::Fixed => RangeSource::Frame,
        steady => steady,
    };
}
