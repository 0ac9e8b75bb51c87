//! The start page, beside the picture: open something, go on with what was open, see what there was.

use egui::{Align, Button, Layout, RichText, ScrollArea, Ui, vec2};

use crate::viewer::desk::Desk;
use crate::viewer::icons::{self, Icon};
use crate::viewer::kept::{self, Left, Recent};
use crate::viewer::keys::shortcuts::{Action, keys};
use crate::viewer::widgets::Areas;
use crate::viewer::{accessible, theme};

/// In points.
pub const WIDTH: f32 = 300.0;

/// What was asked for.
enum Wish {
    Restore(usize),
    Open(Recent),
    Forget(Recent),
}

pub fn show(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    let mut wish = None;
    let margin = egui::Margin { left: 16, right: 12, top: 10, bottom: 10 };
    egui::Frame::new().inner_margin(margin).show(ui, |ui| {
        header(ui, desk);
        open(ui, actions);
        last_sessions(ui, desk, &mut wish);
        recent(ui, desk, &mut wish);
        ui.with_layout(Layout::bottom_up(Align::Min), |ui| {
            let mut here = desk.keeping.settings.start_page;
            ui.checkbox(&mut here, "Show this page when sphcast starts")
                .on_hover_text("Without a file to open");
            desk.keeping.settings.start_page = here;
        });
    });
    match wish {
        Some(Wish::Restore(index)) => desk.restore(index),
        Some(Wish::Open(run)) => desk.find(run.paths),
        Some(Wish::Forget(run)) => desk.forget(&run.paths),
        None => {}
    }
}

fn header(ui: &mut Ui, desk: &mut Desk) {
    ui.horizontal(|ui| {
        ui.label(RichText::new("sphcast").size(20.0).strong());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let close = icons::button(ui, Icon::Cross, "Close the start page", true);
            Areas::mark(ui, "close-start", close.rect);
            if close.clicked() {
                desk.start = false;
            }
        });
    });
    let software = desk.session.adapter.as_ref().filter(|(_, software)| *software);
    if let Some((name, _)) = software {
        let text =
            format!("No graphics card is used: {name} makes the pictures on the CPU, in seconds each.");
        ui.label(RichText::new(text).small().color(theme::colours().warning));
    }
    ui.add_space(8.0);
}

fn open(ui: &mut Ui, actions: &mut Vec<Action>) {
    let lines = [
        ("Open files…", Action::OpenFiles),
        ("Open a folder…", Action::OpenFolder),
        ("Play the demo run", Action::OpenDemo),
    ];
    for (label, action) in lines {
        let button = Button::new(label).shortcut_text(keys(ui.ctx(), action));
        if ui.add(button.min_size(vec2(ui.available_width(), 30.0))).clicked() {
            actions.push(action);
        }
    }
    ui.add_space(2.0);
    let text = "Or drop particle files, a folder or a view.json anywhere on the window.";
    ui.label(RichText::new(text).small().color(theme::colours().faint));
    ui.add_space(12.0);
}

fn last_sessions(ui: &mut Ui, desk: &Desk, wish: &mut Option<Wish>) {
    let left = &desk.keeping.sessions.left;
    if left.is_empty() {
        return;
    }
    title(ui, if left.len() > 1 { "Last sessions" } else { "Last session" });
    if left.iter().any(|left| !left.session.ended) {
        let text = "The program did not end properly. What was open is kept:";
        ui.label(RichText::new(text).small().color(theme::colours().warning));
    }
    for (index, Left { session, .. }) in left.iter().enumerate() {
        let about = format!("frame {}, {}", session.frame, kept::ago(session.when, kept::now()));
        let line = entry(ui, &session.title, &about);
        if index == 0 {
            Areas::mark(ui, "last-session", line.rect);
        }
        if line.on_hover_text("Open this run again, with the view and the frame that it had").clicked() {
            *wish = Some(Wish::Restore(index));
        }
    }
    ui.add_space(12.0);
}

fn recent(ui: &mut Ui, desk: &Desk, wish: &mut Option<Wish>) {
    title(ui, "Recent runs");
    let runs = &desk.keeping.recent.runs;
    if runs.is_empty() {
        ui.label(RichText::new("Runs that you open are listed here.").small().color(theme::colours().faint));
    }
    let height = (ui.available_height() - 40.0).max(60.0);
    ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
        for run in runs {
            let frames = match run.frames {
                0 => "no frame as yet".into(),
                1 => "1 frame".into(),
                more => format!("{more} frames"),
            };
            let line = entry(ui, &run.title, &format!("{frames}, {}", kept::ago(run.when, kept::now())));
            let place: Vec<String> = run.paths.iter().map(|path| path.display().to_string()).collect();
            if line.clicked() {
                *wish = Some(Wish::Open(run.clone()));
            }
            line.context_menu(|ui| {
                if ui.button("Remove from this list").clicked() {
                    *wish = Some(Wish::Forget(run.clone()));
                    ui.close();
                }
            });
            line.on_hover_text(place.join("\n"));
        }
    });
}

fn title(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).strong().color(theme::colours().accent));
    ui.add_space(2.0);
}

/// A run by its name, and a word on it below.
fn entry(ui: &mut Ui, name: &str, about: &str) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 42.0), egui::Sense::click());
    if response.hovered() {
        ui.painter().rect_filled(rect, 4, theme::colours().raised);
    }
    accessible::button(ui, &response, &format!("{name}, {about}"));
    let inside = rect.shrink2(vec2(8.0, 4.0));
    let mut lines =
        ui.new_child(egui::UiBuilder::new().max_rect(inside).layout(Layout::top_down(Align::Min)));
    lines.spacing_mut().item_spacing.y = 0.0;
    let name =
        egui::Label::new(RichText::new(name).color(theme::colours().text)).truncate().selectable(false);
    lines.add(name);
    lines.add(
        egui::Label::new(RichText::new(about).small().color(theme::colours().muted))
            .truncate()
            .selectable(false),
    );
    response
}
