//! The settings of the program: device, memory, keys. They outlive it, and change no picture.

use egui::{Align, Event, Key, KeyboardShortcut, Layout, RichText, ScrollArea, Ui, vec2};
use renderer::GpuOptions;

use crate::viewer::desk::Desk;
use crate::viewer::kept::Settings;
use crate::viewer::keys::keymap::{Keymap, actions};
use crate::viewer::keys::shortcuts::{Action, meaning};
use crate::viewer::theme::{self, Appearance};
use crate::viewer::widgets;

/// The open settings.
#[derive(Default)]
pub struct Preferences {
    page: Page,
    /// What could render; `None` while the drivers are asked.
    pub adapters: Option<Vec<String>>,
    /// The action that waits for its keys.
    waiting: Option<Action>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Program,
    Keys,
}

impl Preferences {
    /// Shows the settings while they are open, and puts into force what is chosen.
    pub fn show(ui: &Ui, desk: &mut Desk) {
        let Some(preferences) = &mut desk.preferences else { return };
        let frame = egui::Frame::window(ui.style()).inner_margin(20);
        let settings = &mut desk.keeping.settings;
        let response = egui::Modal::new(egui::Id::unique("settings")).frame(frame).show(ui.ctx(), |ui| {
            ui.set_width(520.0_f32.min(ui.ctx().content_rect().width() - 60.0));
            ui.label(RichText::new("Settings").heading().strong());
            ui.add_space(8.0);
            let pages = [(Page::Program, "Program", ""), (Page::Keys, "Keys", "")];
            ui.horizontal(|ui| widgets::choice(ui, &mut preferences.page, &pages));
            ui.add_space(8.0);
            match preferences.page {
                Page::Program => preferences.program(ui, settings),
                Page::Keys => preferences.keys(ui, settings),
            }
            ui.add_space(8.0);
            ui.vertical_centered(|ui| ui.button("Close").clicked()).inner
        });
        // A key that is waited for may be the one that closes.
        let closing = preferences.waiting.is_none() && response.should_close();
        if response.inner || closing {
            desk.preferences = None;
        }
        // A device takes a while to open: not at every step of a drag.
        if desk.preferences.is_none() || !ui.input(|input| input.pointer.any_down()) {
            desk.apply_settings();
        }
    }

    pub fn program(&self, ui: &mut Ui, settings: &mut Settings) {
        widgets::row(ui, "Appearance", |ui| {
            let choices = [
                (Appearance::Dark, "Dark", ""),
                (Appearance::Light, "Light", ""),
                (Appearance::System, "System", "As the desktop has it; dark where it does not say"),
            ];
            widgets::choice(ui, &mut settings.appearance, &choices);
        });
        self.adapter(ui, settings);
        widgets::row(ui, "Frame memory", |ui| {
            let range = Settings::FRAME_CACHE_MIB;
            let field = egui::DragValue::new(&mut settings.frame_cache_mib).range(range).suffix(" MiB");
            ui.add(field.speed(16.0).update_while_editing(false)).accessible_name("Frame memory").on_hover_text(
                "Frames are read ahead and kept for playing and scrubbing, up to this many bytes beside the one \
                 in view",
            );
        });
        widgets::row(ui, "Device memory", |ui| {
            let mut own = settings.device_memory_mib.is_some();
            let limit = ui.checkbox(&mut own, "Limit").on_hover_text(
                "The picture in view takes no more: one that needs more is made part by part, which takes longer, \
                 and is the same. An export or a measured error beside it may take as much again",
            );
            if limit.changed() {
                settings.device_memory_mib = own.then_some(1024);
            }
            if let Some(mib) = &mut settings.device_memory_mib {
                let field = egui::DragValue::new(mib).range(GpuOptions::MEMORY_MIB).suffix(" MiB");
                ui.add(field.speed(16.0).update_while_editing(false)).accessible_name("Device memory");
            }
        });
        widgets::row(ui, "Text size", |ui| {
            let mut percent = 100.0 * settings.usable_scale();
            let (least, most) = Settings::SCALE.into_inner();
            let field = egui::DragValue::new(&mut percent).range(100.0 * least..=100.0 * most).suffix(" %");
            let field = ui.add(field.speed(1.0).fixed_decimals(0).update_while_editing(false));
            let hint = "Of letters and controls; Ctrl with plus, minus and 0 in the window does the same";
            if field.accessible_name("Text size").on_hover_text(hint).changed() {
                settings.scale = percent / 100.0;
            }
        });
        widgets::row(ui, "Start page", |ui| {
            ui.checkbox(&mut settings.start_page, "Show when no file is named");
        });
    }

    fn adapter(&self, ui: &mut Ui, settings: &mut Settings) {
        widgets::row(ui, "Adapter", |ui| {
            let shown = settings.adapter.clone().unwrap_or_else(|| "The fastest".into());
            let menu = egui::ComboBox::from_id_salt("adapter").width(ui.available_width()).truncate();
            let menu = menu.selected_text(shown).show_ui(ui, |ui| {
                ui.selectable_value(&mut settings.adapter, None, "The fastest");
                for name in self.adapters.iter().flatten() {
                    ui.selectable_value(&mut settings.adapter, Some(name.clone()), name);
                }
                if self.adapters.is_none() {
                    ui.label(RichText::new("Asking the drivers…").color(theme::colours().muted));
                }
            });
            menu.response
                .accessible_name("Adapter")
                .on_hover_text("What makes the pictures. --adapter on the command line goes first");
        });
    }

    pub fn keys(&mut self, ui: &mut Ui, settings: &mut Settings) {
        let mut keymap = settings.keymap();
        if let Some(action) = self.waiting
            && let Some(keys) = pressed(ui)
        {
            match keys.logical_key {
                Key::Escape => {}
                Key::Backspace => keymap.clear(action),
                _ => keymap.assign(action, keys),
            }
            self.waiting = None;
        }
        let height = (ui.ctx().content_rect().height() - 280.0).max(120.0);
        ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
            for action in actions() {
                self.line(ui, action, &mut keymap);
            }
        });
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            let changed = keymap != Keymap::default();
            if ui.add_enabled(changed, egui::Button::new("Reset all keys")).clicked() {
                keymap = Keymap::default();
            }
            let text = "Click keys to change them; Backspace leaves a command without any.";
            ui.label(RichText::new(text).small().color(theme::colours().faint));
        });
        settings.keys = keymap.to_bindings();
    }

    /// An action and its keys.
    fn line(&mut self, ui: &mut Ui, action: Action, keymap: &mut Keymap) {
        ui.horizontal(|ui| {
            ui.set_min_height(theme::ROW_HEIGHT);
            ui.label(meaning(action));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add_space(10.0);
                let reset = ui.add_enabled(keymap.is_changed(action), egui::Button::new("Reset"));
                if reset.accessible_name(format!("Reset the keys of: {}", meaning(action))).clicked() {
                    keymap.reset(action);
                }
                let waiting = self.waiting == Some(action);
                let text = if waiting { "Press keys…".into() } else { all_keys(ui, keymap, action) };
                let button = egui::Button::new(RichText::new(text).monospace().size(12.0)).selected(waiting);
                let button = ui.add(button.min_size(vec2(150.0, 0.0)));
                if button.accessible_name(format!("Keys of: {}", meaning(action))).clicked() {
                    self.waiting = (!waiting).then_some(action);
                }
            });
        });
    }
}

fn all_keys(ui: &Ui, keymap: &Keymap, action: Action) -> String {
    let keys: Vec<String> = keymap.keys(action).iter().map(|keys| ui.ctx().format_shortcut(keys)).collect();
    if keys.is_empty() { "none".into() } else { keys.join(", ") }
}

/// The keys that were pressed in this frame, taken away from everything else.
fn pressed(ui: &Ui) -> Option<KeyboardShortcut> {
    ui.input_mut(|input| {
        let found = input.events.iter().find_map(|event| match event {
            Event::Key { key, pressed: true, modifiers, .. } => {
                let held = egui::Modifiers {
                    command: modifiers.command,
                    shift: modifiers.shift,
                    alt: modifiers.alt,
                    ..egui::Modifiers::NONE
                };
                Some(KeyboardShortcut::new(held, *key))
            }
            _ => None,
        });
        if found.is_some() {
            input.events.retain(|event| !matches!(event, Event::Key { .. } | Event::Text(_)));
        }
        found
    })
}
