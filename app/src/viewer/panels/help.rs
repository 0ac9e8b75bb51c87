//! The list of shortcuts and gestures. Commands without keys are in the palette alone.

use egui::{Align2, RichText, Ui, vec2};

use crate::viewer::keys::shortcuts::{Action, GESTURES, SHORTCUTS, Shortcut, keys};
use crate::viewer::orbit_camera::Side;
use crate::viewer::theme;

/// Column of the keys, in points.
const KEYS_WIDTH: f32 = 164.0;

pub fn show(ui: &Ui, open: &mut bool) {
    if !*open {
        return;
    }
    let frame = egui::Frame::window(ui.style()).inner_margin(24);
    let response = egui::Modal::new(egui::Id::unique("help")).frame(frame).show(ui.ctx(), |ui| {
        ui.set_width(940.0_f32.min(ui.ctx().content_rect().width() - 60.0));
        ui.label(RichText::new("Keyboard and mouse").heading().strong());
        ui.add_space(8.0);
        let height = ui.ctx().content_rect().height() - 190.0;
        egui::ScrollArea::vertical().min_scrolled_height(height).max_height(height).auto_shrink(false).show(
            ui,
            |ui| {
                ui.columns_const(|[left, right]| {
                    mouse(left);
                    group(left, "Files");
                    group(left, "Window");
                    group(right, "Time");
                    group(right, "Camera");
                    group(right, "Picture");
                });
            },
        );
        ui.add_space(8.0);
        ui.vertical_centered(|ui| ui.button("Close").clicked()).inner
    });
    if response.inner || response.should_close() {
        *open = false;
    }
}

fn mouse(ui: &mut Ui) {
    ui.spacing_mut().item_spacing.y = 2.0;
    title(ui, "Mouse and flying");
    for (gesture, meaning) in GESTURES {
        line(ui, gesture, meaning);
    }
    ui.add_space(10.0);
}

fn group(ui: &mut Ui, name: &str) {
    ui.spacing_mut().item_spacing.y = 2.0;
    title(ui, name);
    let here = |shortcut: &&Shortcut| shortcut.group == name && !shortcut.meaning.is_empty();
    for Shortcut { action, meaning, .. } in SHORTCUTS.iter().filter(here) {
        let keys = |action: Action| keys(ui.ctx(), action);
        let series = |first, last| format!("{} … {}", keys(first), keys(last));
        match *action {
            Action::Look(Side::PosX) => {
                let all = series(Action::Look(Side::PosX), Action::Look(Side::NegZ));
                line(ui, &all, "Look from +X, −X, +Y, −Y, +Z, −Z");
            }
            Action::GoTo(1) => {
                let all = series(Action::GoTo(1), Action::GoTo(9));
                line(ui, &all, "Go to a bookmark");
            }
            Action::Look(_) | Action::GoTo(_) => {}
            action if keys(action).is_empty() => {}
            action => line(ui, &keys(action), meaning),
        }
    }
    ui.add_space(10.0);
}

fn title(ui: &mut Ui, name: &str) {
    ui.label(RichText::new(name).strong().color(theme::colours().accent));
}

fn line(ui: &mut Ui, keys: &str, meaning: &str) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 20.0), egui::Sense::hover());
    let font = egui::FontId::proportional(13.5);
    let painter = ui.painter();
    painter.text(rect.left_center(), Align2::LEFT_CENTER, keys, font.clone(), theme::colours().muted);
    let place = rect.left_center() + vec2(KEYS_WIDTH, 0.0);
    painter.text(place, Align2::LEFT_CENTER, meaning, font, theme::colours().text);
}
