//! Transfer functions to start from.

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{PopupCloseBehavior, Ui};
use renderer::{ControlPoint, TransferView};

use crate::viewer::icons::{self, Icon};
use crate::viewer::kept::library::Saved;
use crate::viewer::theme;
use crate::viewer::widgets::Areas;

/// A named transfer function.
pub struct Preset {
    pub name: &'static str,
    pub hint: &'static str,
    /// u, sRGB colour, opacity.
    points: &'static [(f32, u32, f32)],
}

/// Colours follow perceptually even maps where the order of values is what matters.
pub const PRESETS: [Preset; 6] = [
    Preset {
        name: "Two-ended",
        hint: "Both extremes stand out, the middle is thin",
        points: &[
            (0.0, 0x3b4cc0, 0.35),
            (0.25, 0x7b9ff9, 0.06),
            (0.5, 0xdddddd, 0.0),
            (0.75, 0xf49a7b, 0.06),
            (1.0, 0xb40426, 0.35),
        ],
    },
    Preset {
        name: "Ramp",
        hint: "Opacity grows with the value",
        points: &[(0.0, 0x2a5ca8, 0.0), (0.5, 0xd8d8c8, 0.12), (1.0, 0xc8452c, 0.4)],
    },
    Preset {
        name: "Narrow peak",
        hint: "One value as a shell: move the peak to where it is needed",
        points: &[
            (0.0, 0x40b0c0, 0.0),
            (0.44, 0x40b0c0, 0.0),
            (0.5, 0xf2d06b, 0.8),
            (0.56, 0xe8743b, 0.0),
            (1.0, 0xe8743b, 0.0),
        ],
    },
    Preset {
        name: "Viridis",
        hint: "Dark to bright, readable without colour vision",
        points: &[
            (0.0, 0x440154, 0.02),
            (0.25, 0x3b528b, 0.06),
            (0.5, 0x21918c, 0.12),
            (0.75, 0x5ec962, 0.2),
            (1.0, 0xfde725, 0.35),
        ],
    },
    Preset {
        name: "Inferno",
        hint: "Black to yellow: speed, temperature, energy",
        points: &[
            (0.0, 0x000004, 0.0),
            (0.25, 0x57106e, 0.05),
            (0.5, 0xbc3754, 0.12),
            (0.75, 0xf98e09, 0.25),
            (1.0, 0xfcffa4, 0.5),
        ],
    },
    Preset {
        name: "Solid above half",
        hint: "A step: nothing below the middle, opaque above it",
        points: &[(0.0, 0x6fa8dc, 0.0), (0.5, 0x6fa8dc, 0.0), (0.5, 0x6fa8dc, 0.9), (1.0, 0xf3f6f9, 0.9)],
    },
];

/// What is wanted of files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wish {
    Import,
    Export,
    Save(String),
    Delete(String),
}

/// The menu of functions to start from, and of what is done with files.
#[derive(Default)]
pub struct Presets {
    /// By name.
    pub saved: Vec<Saved>,
    /// Not yet done.
    pub wishes: Vec<Wish>,
    /// What the present function is to be saved as.
    name: String,
}

impl Presets {
    pub fn show(&mut self, ui: &mut Ui, transfer: &mut TransferView) {
        let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        let (menu, _) = MenuButton::new("Presets").config(config).ui(ui, |ui| {
            ui.set_min_width(190.0);
            for preset in &PRESETS {
                if ui.button(preset.name).on_hover_text(preset.hint).clicked() {
                    (transfer.points, transfer.map) = (preset.points(), None);
                    ui.close();
                }
            }
            if ui.button("Default").on_hover_text("What a view without a transfer function shows").clicked() {
                (transfer.points, transfer.map) = (default_points(), None);
                ui.close();
            }
            ui.separator();
            self.own(ui, transfer);
            ui.separator();
            for (label, area, wish) in [
                ("Import from ParaView…", "import", Wish::Import),
                ("Export for ParaView…", "export-colours", Wish::Export),
            ] {
                let button = ui.button(label);
                Areas::mark(ui, area, button.rect);
                if button.clicked() {
                    self.wishes.push(wish);
                    ui.close();
                }
            }
        });
        Areas::mark(ui, "presets", menu.rect);
    }

    /// Functions saved under a name, and a field to save this one.
    fn own(&mut self, ui: &mut Ui, transfer: &mut TransferView) {
        for Saved { name, transfer: saved } in &self.saved {
            ui.horizontal(|ui| {
                let button = ui.button(name);
                Areas::mark(ui, "preset", button.rect);
                if button.clicked() {
                    (transfer.points, transfer.map) = (saved.points.clone(), saved.map.clone());
                    ui.close();
                }
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    if icons::button(ui, Icon::Cross, &format!("Delete {name}"), true).clicked() {
                        self.wishes.push(Wish::Delete(name.clone()));
                    }
                });
            });
        }
        ui.horizontal(|ui| {
            let field = egui::TextEdit::singleline(&mut self.name).hint_text("name").desired_width(118.0);
            let field = ui.add(field).accessible_name("Name of the preset");
            Areas::mark(ui, "preset-name", field.rect);
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            let named = !self.name.trim().is_empty();
            let button = egui::Button::new("Save").min_size(egui::vec2(0.0, theme::ROW_HEIGHT));
            let save = ui.add_enabled(named, button).on_hover_text("Keep this function under the name");
            if named && (save.clicked() || entered) {
                self.wishes.push(Wish::Save(std::mem::take(&mut self.name).trim().to_owned()));
            }
        });
    }
}

impl Preset {
    pub fn points(&self) -> Vec<ControlPoint> {
        let point = |&(u, colour, opacity): &(f32, u32, f32)| {
            let channel = |shift: u32| from_srgb((colour >> shift) as u8);
            ControlPoint { u, rgb: [channel(16), channel(8), channel(0)], opacity }
        };
        self.points.iter().map(point).collect()
    }
}

/// What a view without a transfer function shows.
pub fn default_points() -> Vec<ControlPoint> {
    TransferView::default().points
}

fn from_srgb(byte: u8) -> f32 {
    let value = f32::from(byte) / 255.0;
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_a_transfer_function() {
        for preset in &PRESETS {
            assert!(renderer::TransferFunction::new(&preset.points()).is_ok(), "{}", preset.name);
        }
    }
}
