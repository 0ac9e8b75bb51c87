//! Filters: ranges of a field's values in which particles must lie to be in the picture.

use egui::Ui;

use crate::scene::quantity_names;
use crate::viewer::session::Session;
use crate::viewer::widgets;

use super::selection::{ends_of, header};

pub fn show(ui: &mut Ui, session: &mut Session) {
    let Some((_, frame)) = session.frame().cloned() else { return };
    let mut removed = None;
    for number in 0..session.view.select.filters.len() {
        let name = format!("Filter {}", number + 1);
        let known = session.field_ranges.as_ref().filter(|known| known.is_of(&frame));
        let Some(filter) = session.view.select.filters.get_mut(number) else { break };
        let kept =
            header(ui, &name, &mut filter.on, &mut filter.invert, "Keep the values outside of the range");
        if !kept {
            removed = Some(number);
        }
        widgets::row(ui, "Field", |ui| {
            let menu = egui::ComboBox::from_id_salt(("filter", number)).width(ui.available_width());
            let menu = menu.selected_text(&filter.field).truncate().show_ui(ui, |ui| {
                for field in quantity_names(&frame) {
                    let range = known.and_then(|known| known.range(&field));
                    let chosen = filter.field == field;
                    let entry = ui.add_enabled(range.is_some(), egui::Button::selectable(chosen, &field));
                    if let Some(range) = range.filter(|_| entry.clicked() && !chosen) {
                        (filter.field, filter.range) = (field, range);
                    }
                }
            });
            menu.response.accessible_name(format!("Field of {name}"));
        });
        let range = known.and_then(|known| known.range(&filter.field));
        let [low, high] = range.unwrap_or(filter.range);
        widgets::row(ui, "Range", |ui| {
            let mut ends = filter.range;
            if ends_of(ui, &mut ends, high - low, &name) {
                filter.range = ends;
            }
        });
        if let Some([low, high]) = range {
            let [least, most] = [low, high].map(|value| widgets::on_axis(value, high - low));
            ui.scope(|ui| widgets::fact(ui, "In this frame", format!("{least} … {most}")));
        }
    }
    if let Some(number) = removed {
        session.view.select.filters.remove(number);
    }
    session.wants_field_ranges = !session.view.select.filters.is_empty();
}
