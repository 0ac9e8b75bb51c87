//! Cameras by their names: go there, rename, update, delete.

use egui::{RichText, TextEdit, Ui, vec2};

use crate::viewer::icons::{self, Icon};
use crate::viewer::keys::shortcuts::{Action, hint, with_keys};
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

/// What was pressed in the list.
enum Press {
    Go(usize),
    Update(usize),
    Delete(usize),
}

pub fn show(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    if session.view.bookmarks.is_empty() {
        let text = "Keep cameras by a name. They are saved with the view.";
        ui.label(RichText::new(text).color(theme::colours().faint));
    }
    let ready = session.camera.is_some();
    let mut press = None;
    for (index, bookmark) in session.view.bookmarks.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let buttons = 54.0 + 62.0 + theme::ROW_HEIGHT + 4.0 + 3.0 * 4.0;
            let name = format!("Name of bookmark {}", index + 1);
            let edit = TextEdit::singleline(&mut bookmark.name).char_limit(100);
            let size = vec2(ui.available_width() - buttons, theme::ROW_HEIGHT);
            ui.add_sized(size, edit).accessible_name(name);
            ui.spacing_mut().button_padding.x = 2.0;
            let name = &bookmark.name;
            ui.add_enabled_ui(ready, |ui| {
                let go = widgets::wide_button(ui, "Go to", 54.0).accessible_name(format!("Go to {name}"));
                let number = u8::try_from(index + 1).unwrap_or(u8::MAX);
                let hint = with_keys(ui.ctx(), "Moves the camera there", Action::GoTo(number));
                if go.on_hover_text(hint).clicked() {
                    press = Some(Press::Go(index));
                }
                let update =
                    widgets::wide_button(ui, "Update", 62.0).accessible_name(format!("Update {name}"));
                if update.on_hover_text("Takes the present camera in its place").clicked() {
                    press = Some(Press::Update(index));
                }
            });
            if icons::button(ui, Icon::Cross, &format!("Delete {name}"), true).clicked() {
                press = Some(Press::Delete(index));
            }
        });
    }
    match (press, session.camera) {
        (Some(Press::Go(index)), _) => session.go_to_bookmark(index, std::time::Instant::now()),
        (Some(Press::Update(index)), Some(camera)) => session.view.bookmarks[index].camera = camera.to_view(),
        (Some(Press::Delete(index)), _) => {
            session.view.bookmarks.remove(index);
        }
        _ => {}
    }
    ui.add_enabled_ui(ready, |ui| {
        let add = widgets::wide_button(ui, "Bookmark this camera", ui.available_width());
        if add.on_hover_text(hint(ui.ctx(), Action::Bookmark)).clicked() {
            actions.push(Action::Bookmark);
        }
    });
}
