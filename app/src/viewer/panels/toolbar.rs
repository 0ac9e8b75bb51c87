//! The bar on top: files, camera, window.

use egui::{Align, Button, Layout, Response, Ui};

use crate::viewer::icons::{self, Icon};
use crate::viewer::keys::shortcuts::{Action, hint, keys, with_keys};
use crate::viewer::orbit_camera::Side;
use crate::viewer::session::{Session, Tool};
use crate::viewer::theme;
use crate::viewer::widgets::Areas;

/// Which switches are on.
#[derive(Clone, Copy, Debug)]
pub struct Modes {
    pub flying: bool,
    pub tool: Option<Tool>,
    pub panels: bool,
}

pub fn show(ui: &mut Ui, session: &Session, modes: Modes, actions: &mut Vec<Action>) {
    ui.horizontal_centered(|ui| {
        files(ui, actions);
        gap(ui);
        steps(ui, session, actions);
        gap(ui);
        let ready = session.camera.is_some();
        ui.add_enabled_ui(ready, |ui| camera(ui, session, modes, actions));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            call(ui, Button::new("Help"), Action::Help, actions);
            call(ui, Button::new("Settings"), Action::Settings, actions);
            call(ui, switch("Panels", modes.panels), Action::Panels, actions);
        });
    });
}

fn files(ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.menu_button("Open", |ui| {
        item(ui, "Files…", Action::OpenFiles, actions);
        item(ui, "Folder…", Action::OpenFolder, actions);
        item(ui, "Demo run", Action::OpenDemo, actions);
        ui.separator();
        item(ui, "Start page", Action::Start, actions);
    });
    ui.menu_button("View", |ui| {
        item(ui, "Load view…", Action::LoadView, actions);
        item(ui, "Save view…", Action::SaveView, actions);
    });
    ui.menu_button("Picture", |ui| {
        item(ui, "Save picture…", Action::SavePicture, actions);
        item(ui, "Save picture and view in this folder", Action::QuickSave, actions);
        item(ui, "Export pictures or a video…", Action::Export, actions);
    });
}

/// Back and forth through what was changed.
fn steps(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    ui.spacing_mut().item_spacing.x = 2.0;
    let buttons = [
        (Icon::Undo, "Undo", Action::Undo, session.can_undo()),
        (Icon::Redo, "Redo", Action::Redo, session.can_redo()),
    ];
    for (icon, name, action, possible) in buttons {
        let hint = with_keys(ui.ctx(), name, action);
        if icons::hinted_button(ui, icon, name, &hint, possible).clicked() {
            actions.push(action);
        }
    }
}

fn camera(ui: &mut Ui, session: &Session, modes: Modes, actions: &mut Vec<Action>) {
    call(ui, Button::new("Reset"), Action::Reset, actions);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().button_padding.x = 6.0;
        for side in Side::ALL {
            call(ui, Button::new(side.label()), Action::Look(side), actions);
        }
    });
    call(ui, switch("Fly", modes.flying), Action::Fly, actions);
    ui.menu_button("Bookmarks", |ui| {
        item(ui, "Bookmark the camera", Action::Bookmark, actions);
        if !session.view.bookmarks.is_empty() {
            ui.separator();
        }
        for (number, bookmark) in (1..=u8::MAX).zip(&session.view.bookmarks) {
            item(ui, &bookmark.name, Action::GoTo(number), actions);
        }
    });
    gap(ui);
    let tools = [
        ("Inspect", "inspect", Tool::Inspect, Action::Inspect),
        ("Pick", "pick", Tool::Pick, Action::Pick),
        ("Measure", "measure distance", Tool::Measure, Action::Measure),
    ];
    for (label, area, tool, action) in tools {
        let button = call(ui, switch(label, modes.tool == Some(tool)), action, actions);
        Areas::mark(ui, area, button.rect);
    }
}

fn gap(ui: &mut Ui) {
    ui.add_space(4.0);
    let (rect, _) = ui.allocate_exact_size(egui::vec2(1.0, 18.0), egui::Sense::hover());
    ui.painter().rect_filled(rect, 0, theme::colours().line);
    ui.add_space(4.0);
}

/// A button that is on or off.
fn switch(label: &'static str, on: bool) -> Button<'static> {
    let button = Button::new(label).selected(on);
    if on { button.fill(theme::colours().accent_deep) } else { button }
}

fn call(ui: &mut Ui, button: Button<'_>, action: Action, actions: &mut Vec<Action>) -> Response {
    let response = ui.add(button).on_hover_text(hint(ui.ctx(), action));
    if response.clicked() {
        actions.push(action);
    }
    response
}

/// A line of a menu, with its keys at the right edge.
fn item(ui: &mut Ui, label: &str, action: Action, actions: &mut Vec<Action>) {
    if ui.add(Button::new(label).shortcut_text(keys(ui.ctx(), action))).accessible_name(label).clicked() {
        actions.push(action);
        ui.close();
    }
}
