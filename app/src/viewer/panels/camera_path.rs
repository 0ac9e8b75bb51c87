//! The path of the camera through the frames: keyframes and turntable.

use egui::{DragValue, RichText, Ui};
use renderer::PathView;

use crate::viewer::keys::shortcuts::{Action, hint};
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

pub fn show(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    if session.playback.count() < 2 {
        let text =
            "A run of one frame has no path. Pictures of it from all sides: sphcast render --turntable N";
        ui.label(RichText::new(text).color(theme::colours().faint));
        if !session.view.path.is_empty() {
            ui.label("The view has a path nevertheless, which is saved with it.");
            if ui.button("Remove").accessible_name("Remove path").clicked() {
                session.view.path = PathView::default();
            }
        }
        return;
    }
    keyframes(ui, session, actions);
    widgets::row(ui, "Turntable", |ui| {
        let most = PathView::MAX_REVOLUTIONS;
        let field = DragValue::new(&mut session.view.path.revolutions).range(-most..=most).speed(0.05);
        let hint = "Turns around the target from the first frame to the last, beside the keyframes; \
                    below zero, clockwise as seen from above";
        ui.add(field.max_decimals(3)).accessible_name("Revolutions").on_hover_text(hint);
        ui.label("turns over the run");
    });
    let empty = session.view.path.is_empty();
    ui.add_enabled_ui(!empty, |ui| {
        let mut follows = session.follows_path() && !empty;
        let hint = "While frames go by, the camera goes where the path has it";
        let hint = if empty { "Set keyframes or turns first" } else { hint };
        if ui.checkbox(&mut follows, "Follow path").on_hover_text(hint).changed() {
            session.set_following(follows);
        }
    });
    if !empty {
        let text = "The path is saved with the view, and render --view follows it.";
        ui.label(RichText::new(text).small().color(theme::colours().faint));
    }
}

fn keyframes(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    let (here, count) = (session.keyframe_here(), session.view.path.keyframes.len());
    let frame = session.playback.index();
    widgets::row(ui, "Keyframes", |ui| {
        let text = match (here, count) {
            (_, 0) => "none".to_owned(),
            (Some(place), _) => format!("{} of {count}, at frame {frame}", place + 1),
            (None, _) => format!("{count}, none at frame {frame}"),
        };
        ui.label(text);
    });
    ui.horizontal(|ui| {
        let width = 0.5 * (ui.available_width() - ui.spacing().item_spacing.x);
        ui.add_enabled_ui(session.camera.is_some(), |ui| {
            let label = if here.is_some() { "Remove keyframe" } else { "Set keyframe" };
            let toggle = widgets::wide_button(ui, label, width);
            if toggle.on_hover_text(hint(ui.ctx(), Action::Keyframe)).clicked() {
                actions.push(Action::Keyframe);
            }
            ui.add_enabled_ui(here.is_some(), |ui| {
                let update = widgets::wide_button(ui, "Update keyframe", width);
                if update.on_hover_text("Takes the present camera in its place").clicked() {
                    session.set_keyframe();
                }
            });
        });
    });
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
        let at = |forwards: bool| {
            let mut frames = session.view.path.keyframes.iter().map(|key| key.frame.round() as usize);
            match forwards {
                true => frames.find(|key| *key > frame),
                false => frames.rfind(|key| *key < frame),
            }
        };
        for (label, target) in [("Previous", at(false)), ("Next", at(true))] {
            ui.add_enabled_ui(target.is_some(), |ui| {
                let button =
                    widgets::wide_button(ui, label, width).accessible_name(format!("{label} keyframe"));
                if let Some(target) = target.filter(|_| button.clicked()) {
                    session.playback.pause();
                    session.jump(target);
                }
            });
        }
        ui.add_enabled_ui(count > 0, |ui| {
            let clear = widgets::wide_button(ui, "Remove all", width).accessible_name("Remove all keyframes");
            if clear.clicked() {
                session.view.path.keyframes.clear();
            }
        });
    });
}
