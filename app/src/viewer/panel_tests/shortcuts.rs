use egui::{Event, Key, KeyboardShortcut, Modifiers, RawInput};
use egui_kittest::kittest::Queryable;

use super::panel;
use crate::viewer::keys::keymap::Keymap;
use crate::viewer::keys::shortcuts::{Action, pressed, with_keys};

fn key(key: Key, modifiers: Modifiers) -> Event {
    Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
}

#[test]
fn keys_of_one_frame_act_in_their_order() {
    let context = egui::Context::default();
    let save = Modifiers { shift: true, ctrl: true, ..Modifiers::COMMAND };
    let events = vec![key(Key::B, Modifiers::NONE), key(Key::E, save), key(Key::ArrowRight, Modifiers::NONE)];
    let mut actions = Vec::new();
    let mut output = context.run_ui(RawInput { events, ..RawInput::default() }, |ui| {
        actions.extend(pressed(ui.ctx()));
        assert!(ui.input(|input| input.events.is_empty()), "nobody else takes them, too");
    });
    output.textures_delta.clear();
    assert_eq!(actions, [Action::Bookmark, Action::QuickSave, Action::StepForward]);
}

/// What Ctrl+K, Space and the right arrow call while the widget of this label has the focus.
fn with_focus(label: &str) -> Vec<Action> {
    let state = (Vec::new(), String::new());
    let mut harness = panel(state, |ui, (actions, text)| {
        actions.extend(pressed(ui.ctx()));
        let _ = ui.button("Button");
        let _ = ui.text_edit_singleline(text).accessible_name("Text");
    });
    harness.get_by_label(label).focus();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::K);
    harness.key_press(Key::Space);
    harness.key_press(Key::ArrowRight);
    harness.run();
    harness.state().0.clone()
}

#[test]
fn a_button_with_the_focus_keeps_only_its_own_keys() {
    assert_eq!(with_focus("Button"), [Action::Palette]);
    assert_eq!(with_focus("Text"), []);
}

#[test]
fn tooltips_tell_the_keys_that_there_are() {
    let context = egui::Context::default();
    let play = || with_keys(&context, "Play", Action::PlayPause);
    assert_eq!(play(), "Play  (Space)");
    let mut keymap = Keymap::default();
    keymap.assign(Action::PlayPause, KeyboardShortcut::new(Modifiers::NONE, Key::J));
    keymap.clone().install(&context);
    assert_eq!(play(), "Play  (J)");
    keymap.clear(Action::PlayPause);
    keymap.install(&context);
    assert_eq!(play(), "Play");
    assert_eq!(with_keys(&context, "Go", Action::GoTo(10)), "Go");
}
