//! What the particles in the picture have in common, in numbers.

use egui::{RichText, Ui};
use renderer::Bounds;

use crate::viewer::analysis::statistics::{Statistics, Values};
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

pub fn show(ui: &mut Ui, session: &mut Session) {
    session.wants_statistics = true;
    let Some(answer) = &session.statistics else {
        ui.label(RichText::new("Counting…").color(theme::colours().faint));
        return;
    };
    let statistics = match &answer.statistics {
        Ok(statistics) => statistics,
        Err(why) => {
            ui.label(RichText::new(why.to_string()).small().color(theme::colours().warning));
            return;
        }
    };
    ui.scope(|ui| facts(ui, statistics));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let width = 0.5 * (ui.available_width() - ui.spacing().item_spacing.x);
        if widgets::wide_button(ui, "Copy", width).on_hover_text("A line for each number").clicked() {
            ui.ctx().copy_text(statistics.text());
        }
        let hint = "A line of names and a line of numbers, for a table";
        if widgets::wide_button(ui, "Copy as CSV", width).on_hover_text(hint).clicked() {
            ui.ctx().copy_text(statistics.csv());
        }
    });
}

fn facts(ui: &mut Ui, statistics: &Statistics) {
    let Statistics { particles, of, mass, volume, bounds, quantity, values, .. } = statistics;
    let [shown, all] = [*particles, *of].map(|count| widgets::count(count as u64));
    let text = if particles == of { shown } else { format!("{shown} of {all}") };
    widgets::fact(ui, "Particles", text);
    if let Some(mass) = mass {
        widgets::fact(ui, "Mass", widgets::short(*mass));
    }
    if let Some(volume) = volume {
        widgets::fact(ui, "Volume", widgets::short(*volume)).on_hover_text("Sum of mass over density");
    }
    if let Some(Bounds { min, max }) = bounds {
        let scale = (*max - *min).length();
        for (axis, name) in ["X", "Y", "Z"].into_iter().enumerate() {
            let [low, high] = [min[axis], max[axis]].map(|x| widgets::on_scale(x, scale));
            widgets::fact(ui, name, format!("{low} … {high}"));
        }
    }
    let Some(Values { count, min, max, mean, deviation, median }) = *values else { return };
    ui.add_space(4.0);
    let name = quantity.as_deref().unwrap_or("value");
    ui.label(RichText::new(name).strong());
    let numbers = [
        ("Smallest", min),
        ("Largest", max),
        ("Mean", mean),
        ("Standard deviation", deviation),
        ("Median", median),
    ];
    for (label, value) in numbers {
        widgets::fact(ui, label, widgets::on_axis(value, max - min));
    }
    if count < *particles {
        widgets::fact(ui, "Not a number", widgets::count((particles - count) as u64));
    }
}
