//! Which field decides the opacity, where that is another one than the colour's.

use egui::{RichText, Ui};
use renderer::{OpacityView, Scale};

use crate::frames::Frame;
use crate::scene::quantity_names;
use crate::viewer::session::{RangeSource, Session};
use crate::viewer::{theme, widgets};

use super::quantity::{Range, describe};

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
        range(ui, session);
        let colour = session.shown_quantity().unwrap_or_default();
        let opacity = field.flatten().unwrap_or_default();
        let text = format!(
            "Along the transfer function, colours and histogram are of {colour}, opacities of {opacity}."
        );
        ui.label(RichText::new(text).small().color(theme::colours().muted));
    }
}

fn choose(session: &mut Session, name: String) {
    session.view.quantity.opacity = Some(OpacityView { name: Some(name), range: None });
    // A range by hand is of the field before.
    session.opacity_source = match session.range_source {
        RangeSource::Seen => RangeSource::Seen,
        RangeSource::Frame | RangeSource::Quantiles | RangeSource::Fixed => RangeSource::Frame,
    };
}

fn range(ui: &mut Ui, session: &mut Session) {
    let by_hand = session.view.quantity.opacity.as_ref().and_then(|opacity| opacity.range);
    let mut range = Range {
        source: session.opacity_source,
        by_hand,
        in_effect: session.opacity_range(),
        extremes: session.opacity_extremes(),
        scale: Scale::Linear,
        quantiles: None,
    };
    ui.push_id("opacity", |ui| {
        range.show(ui, ["Lowest value of the opacity", "Highest value of the opacity"])
    });
    session.opacity_source = range.source;
    if let Some(opacity) = &mut session.view.quantity.opacity {
        opacity.range = range.by_hand;
    }
}
