//! Which field is shown, and which of its values are the ends of the transfer function.

use egui::Ui;

use crate::frames::Frame;
use crate::scene::{Selection, quantity_names};
use crate::viewer::session::{RangeSource, Session};
use crate::viewer::{theme, widgets};

use super::opacity;

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
    let mut range = Range {
        source: session.range_source,
        by_hand: session.view.quantity.range,
        in_effect: session.range(),
        extremes: session.analysis.as_ref().and_then(|analysis| analysis.extremes),
    };
    range.show(ui, ["Lowest value", "Highest value"]);
    (session.range_source, session.view.quantity.range) = (range.source, range.by_hand);
    opacity::show(ui, session, &frame);
}

/// Another field has other values: a range by hand would mean nothing.
fn choose(session: &mut Session, name: String) {
    session.view.quantity.name = Some(name);
    session.view.quantity.range = None;
    if session.range_source == RangeSource::Fixed {
        session.range_source = RangeSource::Frame;
    }
}

/// Which values of a field are the ends of the transfer function.
pub struct Range {
    pub source: RangeSource,
    /// What holds where the source says so.
    pub by_hand: Option<[f64; 2]>,
    pub in_effect: Option<[f64; 2]>,
    /// In the frame in view.
    pub extremes: Option<[f64; 2]>,
}

impl Range {
    /// `names`: of the numbers, for those who do not see them.
    pub fn show(&mut self, ui: &mut Ui, names: [&str; 2]) {
        let before = self.source;
        let choices = [
            (RangeSource::Frame, "This frame", "Smallest and largest value of the frame in view"),
            (RangeSource::Seen, "All seen", "Smallest and largest value of all frames that were in view"),
            (RangeSource::Fixed, "Fixed", "A range by hand, the same for every frame"),
        ];
        ui.horizontal(|ui| widgets::choice(ui, &mut self.source, &choices));
        if self.source != before {
            self.by_hand = self.in_effect.filter(|_| self.source == RangeSource::Fixed);
        }
        let Some(ends) = self.in_effect else { return };
        widgets::row(ui, "Range", |ui| self.ends(ui, ends, names));
        if let Some([least, most]) = self.extremes {
            let [least, most] = [least, most].map(|value| widgets::on_axis(value, most - least));
            ui.scope(|ui| widgets::fact(ui, "In this frame", format!("{least} … {most}")));
        }
    }

    fn ends(&mut self, ui: &mut Ui, [mut low, mut high]: [f64; 2], names: [&str; 2]) {
        const BETWEEN: f32 = 16.0;
        let scale = (high - low).abs();
        ui.spacing_mut().button_padding.x = 3.0;
        let gaps = 2.0 * ui.spacing().item_spacing.x;
        let width = (ui.available_width() - BETWEEN - gaps) / 2.0;
        let size = egui::vec2(width, ui.spacing().interact_size.y);
        let lower = ui.add_sized(size, widgets::number(&mut low, scale)).accessible_name(names[0]);
        ui.add_sized([BETWEEN, size.y], egui::Label::new("to"));
        let upper = ui.add_sized(size, widgets::number(&mut high, scale)).accessible_name(names[1]);
        let changed = lower.changed() || upper.changed();
        if changed && low.is_finite() && high.is_finite() {
            self.source = RangeSource::Fixed;
            // A range is ascending; whichever end was dragged past the other carries it along.
            self.by_hand = Some([low.min(high), high.max(low)]);
        }
    }
}

/// A name for the menu: a vector stands for its length.
pub fn describe(name: &str, frame: &Frame) -> String {
    match frame.field(name) {
        Some(field) if field.column.components() > 1 => format!("{name} (length)"),
        _ => name.to_owned(),
    }
}
