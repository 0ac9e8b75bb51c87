//! Which colours the transfer function has: a map by its name, or nodes of its own.

use egui::{Rect, Sense, Ui, pos2, vec2};
use renderer::{ColourMap, MapKind, TransferView};

use crate::viewer::icons::{self, Icon};
use crate::viewer::{accessible, theme, widgets};

use super::transfer_canvas::{gradient, to_screen};
use super::transfer_edit as edit;

/// Width of a map's colours in the menu.
const SWATCH: f32 = 96.0;
/// What the menu says where the colours are no named map's.
const OWN: &str = "own nodes";

/// Returns whether another map was chosen.
pub fn show(ui: &mut Ui, transfer: &mut TransferView) -> bool {
    let before = transfer.map.clone();
    widgets::row(ui, "Colours", |ui| {
        let name = transfer.map.as_ref().and_then(|map| map.name.clone());
        let shown = name.clone().unwrap_or_else(|| OWN.into());
        let width = ui.available_width() - icons::WIDTH - ui.spacing().item_spacing.x;
        let menu = egui::ComboBox::from_id_salt("colours").width(width).height(420.0).selected_text(shown);
        let menu = menu.show_ui(ui, |ui| {
            let here = name.is_none();
            if ui.selectable_label(here, OWN).on_hover_text("Nodes of colour below the strip").clicked()
                && !here
            {
                edit::free_colours(transfer);
            }
            for kind in [MapKind::Sequential, MapKind::Diverging] {
                ui.separator();
                for map in ColourMap::all().iter().filter(|map| map.kind == kind) {
                    if line(ui, map, name.as_deref() == Some(map.name)) {
                        edit::choose_map(transfer, map);
                    }
                }
            }
        });
        menu.response
            .on_hover_text("Another map changes the colours and leaves the opacities alone")
            .accessible_name("Colours");
        let reversed = transfer.map.as_ref().is_some_and(|map| map.reversed);
        if icons::switch(ui, Icon::Reverse, "Reverse the colours", reversed).clicked() {
            edit::reverse_colours(transfer);
        }
    });
    transfer.map != before
}

/// A map's colours and name. Returns whether it was clicked.
fn line(ui: &mut Ui, map: &ColourMap, chosen: bool) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(SWATCH + 92.0, 22.0), Sense::click());
    if chosen || response.hovered() {
        let fill = if chosen { theme::colours().accent_deep } else { theme::colours().raised_hover };
        ui.painter().rect_filled(rect, 4, fill);
    }
    let swatch = Rect::from_min_size(pos2(rect.left() + 5.0, rect.top() + 5.0), vec2(SWATCH, 12.0));
    let last = (map.colours().len() - 1) as f32;
    gradient(ui.painter(), swatch, |u| (swatch.top(), to_screen(map.colours()[(u * last).round() as usize])));
    let place = pos2(swatch.right() + 9.0, rect.center().y);
    let font = egui::TextStyle::Body.resolve(ui.style());
    ui.painter().text(place, egui::Align2::LEFT_CENTER, map.name, font, theme::colours().text);
    accessible::switch(ui, &response, map.name, chosen);
    let clicked = response.clicked();
    if clicked {
        ui.close();
    }
    clicked
}
