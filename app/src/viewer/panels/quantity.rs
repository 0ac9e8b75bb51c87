//! Which field is shown, and which of its values are the ends of the transfer function.

use egui::Ui;

use crate::scene::{Selection, quantity_names};
use crate::viewer::session::{RangeSource, Session};
use crate::viewer::{theme, widgets};

pub fn show(ui: &mut Ui, session: &mut Session) {
    let Some((_, frame)) = session.frame().cloned() else {
        ui.label(egui::RichText::new("No frame yet.").color(theme::FAINT));
        return;
    };
    let names = quantity_names(&frame);
    let shown = session.view.quantity.name.clone().or_else(|| Selection::default_of(&frame).name());
    let label = shown.clone().unwrap_or_else(|| "none in this file".into());
    widgets::row(ui, "Field", |ui| {
        let width = ui.available_width();
        let menu = egui::ComboBox::from_id_salt("quantity").width(width).selected_text(label).truncate();
        let menu = menu.show_ui(ui, |ui| {
            for name in names {
                let chosen = shown.as_deref() == Some(name.as_str());
                let text = describe(&name, &frame);
                if ui.selectable_label(chosen, text).clicked() && !chosen {
                    choose(session, name);
                }
            }
        });
        menu.response.accessible_name("Field");
    });
    range(ui, session);
}

/// Another field has other values: a range by hand would mean nothing.
fn choose(session: &mut Session, name: String) {
    session.view.quantity.name = Some(name);
    session.view.quantity.range = None;
    if session.range_source == RangeSource::Fixed {
        session.range_source = RangeSource::Frame;
    }
}

fn range(ui: &mut Ui, session: &mut Session) {
    let in_effect = session.range();
    let mut source = session.range_source;
    let choices = [
        (RangeSource::Frame, "This frame", "Smallest and largest value of the frame in view"),
        (RangeSource::Seen, "All seen", "Smallest and largest value of all frames that were in view"),
        (RangeSource::Fixed, "Fixed", "A range by hand, the same for every frame"),
    ];
    ui.horizontal(|ui| widgets::choice(ui, &mut source, &choices));
    if source != session.range_source {
        session.range_source = source;
        session.view.quantity.range = in_effect.filter(|_| source == RangeSource::Fixed);
    }
    let Some([mut low, mut high]) = in_effect else { return };
    let scale = (high - low).abs();
    widgets::row(ui, "Range", |ui| {
        ui.spacing_mut().button_padding.x = 3.0;
        const BETWEEN: f32 = 16.0;
        let gaps = 2.0 * ui.spacing().item_spacing.x;
        let width = (ui.available_width() - BETWEEN - gaps) / 2.0;
        let size = egui::vec2(width, ui.spacing().interact_size.y);
        let lower = ui.add_sized(size, widgets::number(&mut low, scale)).accessible_name("Lowest value");
        ui.add_sized([BETWEEN, size.y], egui::Label::new("to"));
        let upper = ui.add_sized(size, widgets::number(&mut high, scale)).accessible_name("Highest value");
        let changed = lower.changed() || upper.changed();
        if changed && low.is_finite() && high.is_finite() {
            session.range_source = RangeSource::Fixed;
            // A range is ascending; whichever end was dragged past the other carries it along.
            session.view.quantity.range = Some([low.min(high), high.max(low)]);
        }
    });
    if let Some([least, most]) = session.analysis.as_ref().and_then(|analysis| analysis.extremes) {
        let [least, most] = [least, most].map(|value| widgets::on_axis(value, most - least));
        widgets::fact(ui, "In this frame", format!("{least} … {most}"));
    }
}

/// A name for the menu: a vector stands for its length.
fn describe(name: &str, frame: &crate::frames::Frame) -> String {
    match frame.field(name) {
        Some(field) if field.column.components() > 1 => format!("{name} (length)"),
        _ => name.to_owned(),
    }
}
