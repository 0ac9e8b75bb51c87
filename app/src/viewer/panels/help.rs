//! The list of shortcuts and gestures.

use egui::{Align2, RichText, Ui, vec2};

use crate::viewer::shortcuts::{GESTURES, SHORTCUTS, Shortcut};
use crate::viewer::theme;

pub fn show(ui: &Ui, open: &mut bool) {
    if !*open {
        return;
    }
    let response = egui::Modal::new(egui::Id::unique("help")).show(ui.ctx(), |ui| {
        ui.set_width(680.0_f32.min(ui.ctx().content_rect().width() - 60.0));
        ui.label(RichText::new("Keyboard and mouse").heading().strong());
        ui.add_space(8.0);
        let height = ui.ctx().content_rect().height() - 160.0;
        egui::ScrollArea::vertical().max_height(height).show(ui, |ui| {
            ui.columns_const(|[left, right]| {
                mouse(left);
                group(left, "Files");
                group(right, "Time");
                group(right, "Camera");
                group(right, "Window");
            });
        });
        ui.add_space(8.0);
        ui.vertical_centered(|ui| ui.button("Close").clicked()).inner
    });
    if response.inner || response.should_close() {
        *open = false;
    }
}

fn mouse(ui: &mut Ui) {
    title(ui, "Mouse and flying");
    for (gesture, meaning) in GESTURES {
        line(ui, gesture, meaning);
    }
    ui.add_space(10.0);
}

fn group(ui: &mut Ui, name: &str) {
    title(ui, name);
    let here = |shortcut: &&Shortcut| shortcut.group == name && !shortcut.meaning.is_empty();
    for shortcut in SHORTCUTS.iter().filter(here) {
        let keys = ui.ctx().format_shortcut(&shortcut.keys);
        line(ui, &keys, shortcut.meaning);
    }
    ui.add_space(10.0);
}

fn title(ui: &mut Ui, name: &str) {
    ui.label(RichText::new(name).strong().color(theme::ACCENT));
}

fn line(ui: &mut Ui, keys: &str, meaning: &str) {
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(136.0, 18.0), egui::Sense::hover());
        let font = egui::FontId::proportional(13.0);
        ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, keys, font, theme::MUTED);
        ui.label(meaning);
    });
}
