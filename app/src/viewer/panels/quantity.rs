//! Which field is shown, and which of its values are the ends of the transfer function.

use egui::{RichText, Ui};
use renderer::Scale;

use crate::frames::Frame;
use crate::scene::{Selection, quantity_names};
use crate::viewer::session::{RangeSource, Role, Session, Survey};
use crate::viewer::{theme, widgets};

use super::opacity;

pub fn show(ui: &mut Ui, session: &mut Session) {
    let Some((_, frame)) = session.frame().cloned() else {
        ui.label(egui::RichText::new("No frame yet.").color(theme::colours().faint));
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
    values(ui, session, Role::Colour, ["Lowest value", "Highest value"]);
    opacity::show(ui, session, &frame);
}

/// Scale and range of the field that has a role, and what is known of its values.
pub fn values(ui: &mut Ui, session: &mut Session, role: Role, names: [&str; 2]) {
    scale(ui, session, role);
    let quantity = &session.view.quantity;
    let (source, by_hand) = match role {
        Role::Colour => (session.range_source, quantity.range),
        Role::Opacity => {
            (session.opacity_source, quantity.opacity.as_ref().and_then(|opacity| opacity.range))
        }
    };
    let mut range = Range {
        source,
        by_hand,
        in_effect: session.range_of(role),
        extremes: session.distribution(role).and_then(|found| found.extremes),
        scale: session.scale(role),
        quantiles: session.ranges.quantiles[role as usize],
    };
    range.show(ui, names);
    session.ranges.quantiles[role as usize] = range.quantiles;
    match (role, &mut session.view.quantity.opacity) {
        (Role::Colour, _) => {
            (session.range_source, session.view.quantity.range) = (range.source, range.by_hand);
        }
        (Role::Opacity, Some(opacity)) => {
            (session.opacity_source, opacity.range) = (range.source, range.by_hand)
        }
        (Role::Opacity, None) => {}
    }
    if range.source == RangeSource::Seen {
        survey(ui, session, role);
    }
    without_value(ui, session, role);
}

/// How many particles are no part of the picture for want of a value.
fn without_value(ui: &mut Ui, session: &Session, role: Role) {
    let count = session.distribution(role).map_or(0, |found| found.not_finite);
    if count == 0 {
        return;
    }
    let all = session.analysis.as_ref().map_or(0, |analysis| analysis.left_out);
    let text = format!("{}, left out", widgets::count(count as u64));
    let hint = match session.view.quantity.opacity {
        None => "Particles whose value is no finite number are no part of the picture".to_owned(),
        Some(_) => format!(
            "Particles that lack a finite value of either field are no part of the picture: {} in all",
            widgets::count(all as u64)
        ),
    };
    ui.scope(|ui| widgets::fact(ui, "Without a value", text).on_hover_text(hint));
}

/// Another field has other values: a range by hand would mean nothing.
fn choose(session: &mut Session, name: String) {
    session.view.quantity.name = Some(name);
    session.view.quantity.range = None;
    if session.range_source == RangeSource::Fixed {
        session.range_source = RangeSource::Frame;
    }
}

fn scale(ui: &mut Ui, session: &mut Session, role: Role) {
    let before = session.scale(role);
    let mut scale = before;
    let log = "Equal distances along the transfer function are equal ratios: for values of many magnitudes. \
               What is not positive counts as below the range";
    let choices = [
        (Scale::Linear, "Linear", "Equal distances along the transfer function are equal differences"),
        (Scale::Log, "Logarithmic", log),
    ];
    widgets::row(ui, "Scale", |ui| widgets::choice(ui, &mut scale, &choices));
    if scale != before {
        session.set_scale(role, scale);
    }
}

/// Of how many frames the extremes are known, and a way to know them of all.
fn survey(ui: &mut Ui, session: &mut Session, role: Role) {
    let (seen, count) = (session.frames_seen(role), session.playback.count());
    if count < 2 {
        return;
    }
    widgets::row(ui, "Known from", |ui| {
        let text = RichText::new(format!("{seen} of {count} frames")).color(theme::colours().muted);
        match session.ranges.survey {
            Survey::Running(share) => {
                let bar = egui::ProgressBar::new(share).desired_width(84.0).desired_height(8.0);
                ui.add(bar.fill(theme::colours().accent));
                let cancel = ui.button("Cancel");
                widgets::Areas::mark(ui, "cancel-reading", cancel.rect);
                if cancel.clicked() {
                    session.ranges.survey = Survey::Unwanted;
                }
            }
            _ if seen >= count => {
                ui.label(text);
            }
            _ => {
                ui.label(text);
                let hint = "Reads every frame in the background; until then, frames count that were in view";
                let read = ui.button("Read all").on_hover_text(hint);
                widgets::Areas::mark(ui, "read-all", read.rect);
                if read.clicked() {
                    session.ranges.survey = Survey::Wanted;
                }
            }
        }
    });
}

/// Which values of a field are the ends of the transfer function.
struct Range {
    source: RangeSource,
    /// What holds where the source says so.
    by_hand: Option<[f64; 2]>,
    in_effect: Option<[f64; 2]>,
    /// In the frame in view.
    extremes: Option<[f64; 2]>,
    scale: Scale,
    /// Shares of the particles between which values are shown.
    quantiles: [f64; 2],
}

impl Range {
    /// `names`: of the numbers, for those who do not see them.
    fn show(&mut self, ui: &mut Ui, names: [&str; 2]) {
        let before = self.source;
        let percentile = "Without the smallest and the largest values of the frame in view";
        let choices = [
            (RangeSource::Frame, "This frame", "Smallest and largest value of the frame in view"),
            (RangeSource::Seen, "All frames", "Smallest and largest value of all frames that were read"),
            (RangeSource::Quantiles, "Percentile", percentile),
            (RangeSource::Fixed, "Fixed", "A range by hand, the same for every frame"),
        ];
        ui.horizontal(|ui| widgets::choice(ui, &mut self.source, &choices));
        if self.source != before {
            self.by_hand = self.in_effect.filter(|_| self.source == RangeSource::Fixed);
        }
        if self.source == RangeSource::Quantiles {
            shares(ui, &mut self.quantiles);
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
        let possible = self.scale.holds([low.min(high), low.max(high)]);
        if changed && possible && low.is_finite() && high.is_finite() {
            self.source = RangeSource::Fixed;
            // A range is ascending; whichever end was dragged past the other carries it along.
            self.by_hand = Some([low.min(high), high.max(low)]);
        }
    }
}

/// How many particles lie below and above the range, in percent.
fn shares(ui: &mut Ui, [low, high]: &mut [f64; 2]) {
    widgets::row(ui, "Leave out", |ui| {
        for (label, hint, share) in [
            ("Left out below", "Share of the particles with the smallest values", &mut *low),
            ("Left out above", "Share of the particles with the largest values", &mut *high),
        ] {
            let above = label == "Left out above";
            let mut percent = 100.0 * if above { 1.0 - *share } else { *share };
            let field = egui::DragValue::new(&mut percent).range(0.0..=49.0).speed(0.05).suffix(" %");
            let field = ui.add(field.max_decimals(2)).on_hover_text(hint).accessible_name(label);
            if field.changed() {
                *share = if above { 1.0 - 0.01 * percent } else { 0.01 * percent };
            }
        }
    });
}

/// A name for the menu: a vector stands for its length.
pub fn describe(name: &str, frame: &Frame) -> String {
    match frame.field(name) {
        Some(field) if field.column.components() > 1 => format!("{name} (length)"),
        _ => name.to_owned(),
    }
}
