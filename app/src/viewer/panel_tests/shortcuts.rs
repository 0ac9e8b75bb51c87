use egui::{Event, Key, Modifiers, RawInput};

use crate::viewer::keys::shortcuts::{Action, pressed};

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
