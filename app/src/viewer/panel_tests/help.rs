use std::collections::HashSet;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use super::texts;
use crate::viewer::keys::shortcuts::{Action, GESTURES, SHORTCUTS};
use crate::viewer::panels::help;
use crate::viewer::theme;

fn opened() -> Harness<'static, bool> {
    let mut harness = Harness::builder().with_size(egui::vec2(1280.0, 800.0)).build_ui_state(
        |ui, open: &mut bool| {
            theme::apply(ui.ctx());
            help::show(ui, open);
        },
        true,
    );
    // It takes some frames until it is known how large the list is, and where it belongs.
    harness.run_steps(8);
    harness
}

#[test]
fn every_shortcut_and_gesture_is_told() {
    let harness = opened();
    let written: HashSet<String> = texts(&harness).into_iter().collect();
    // One line for each series of keys.
    let alone = |action: &Action| !matches!(action, Action::Look(_) | Action::GoTo(_));
    let told = SHORTCUTS.iter().filter(|shortcut| shortcut.keys.is_some() && alone(&shortcut.action));
    let meanings = told.map(|shortcut| shortcut.meaning).filter(|meaning| !meaning.is_empty());
    for text in meanings.chain(GESTURES.iter().map(|(_, meaning)| *meaning)) {
        assert!(written.contains(text), "`{text}` is missing");
    }
    for keys in ["Ctrl+Shift+O", "1 … 6", "Ctrl+1 … Ctrl+9"] {
        assert!(written.contains(keys), "{keys}");
    }
}

#[test]
fn it_closes_by_its_button_and_by_escape() {
    let mut harness = opened();
    harness.get_by_label("Close").click_accesskit();
    harness.run();
    assert!(!harness.state());
    let mut harness = opened();
    harness.key_press(egui::Key::Escape);
    harness.run();
    assert!(!harness.state());
}
