use egui::Key;
use egui_kittest::kittest::Queryable;

use super::panel;
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::panels::palette::Palette;

/// An open palette, and what it called.
fn palette() -> egui_kittest::Harness<'static, (Option<Palette>, Vec<Action>)> {
    let state = (Some(Palette::default()), Vec::new());
    panel(state, |ui, (palette, called)| Palette::show(palette, ui, called))
}

#[test]
fn what_is_typed_is_found_and_called_by_enter() {
    let mut harness = palette();
    harness.get_by_label("Find a command").type_text("zoom");
    harness.run();
    harness.key_press(Key::ArrowDown);
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state().1, [Action::ZoomOut]);
    assert!(harness.state().0.is_none(), "it closes");
}

#[test]
fn a_click_calls_a_command_and_escape_calls_none() {
    let mut harness = palette();
    harness.get_by_label("Save the view").click();
    harness.run();
    assert_eq!(harness.state().1, [Action::SaveView]);

    let mut harness = palette();
    harness.key_press(Key::Escape);
    harness.run();
    assert!(harness.state().0.is_none() && harness.state().1.is_empty());
}
