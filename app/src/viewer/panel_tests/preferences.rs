use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;

use super::panel;
use crate::viewer::kept::Settings;
use crate::viewer::keys::keymap::Binding;
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::panels::preferences::Preferences;

fn keys() -> egui_kittest::Harness<'static, (Preferences, Settings)> {
    let state = (Preferences::default(), Settings::default());
    panel(state, |ui, (preferences, settings)| preferences.keys(ui, settings))
}

#[test]
fn a_command_gets_the_keys_that_are_pressed() {
    let mut harness = keys();
    harness.get_by_label("Keys of: Open files").click();
    harness.run();
    harness.get_by_label("Keys of: Open files").click();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::J);
    harness.run();
    assert!(harness.state().1.keys.is_empty(), "a second click is a change of mind");

    harness.get_by_label("Keys of: Open files").click();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::J);
    harness.run();
    let expected = [Binding { action: Action::OpenFiles, keys: vec!["Ctrl+J".into()] }];
    assert_eq!(harness.state().1.keys, expected);
    harness.get_by_label("Reset the keys of: Open files").click();
    harness.run();
    assert!(harness.state().1.keys.is_empty());
}

#[test]
fn backspace_takes_keys_away_and_escape_leaves_them() {
    let mut harness = keys();
    for (key, left) in [(Key::Escape, None), (Key::Backspace, Some(vec![]))] {
        harness.get_by_label("Keys of: Open files").click();
        harness.run();
        harness.key_press(key);
        harness.run();
        assert_eq!(harness.state().1.keys.first().map(|binding| binding.keys.clone()), left);
    }
}

#[test]
fn an_adapter_is_chosen_from_those_that_there_are() {
    let mut preferences = Preferences::default();
    preferences.adapters = Some(vec!["Card A".into(), "Card B".into()]);
    let mut harness = panel(Settings::default(), move |ui, settings| preferences.program(ui, settings));
    harness.get_by_label("Adapter").click();
    harness.run();
    harness.get_by_label("Card B").click();
    harness.run();
    assert_eq!(harness.state().adapter.as_deref(), Some("Card B"));
    harness.get_by_label("Limit").click();
    harness.run();
    assert_eq!(harness.state().device_memory_mib, Some(1024));
}

#[test]
fn a_memory_that_is_typed_counts_when_it_is_whole() {
    let settings = Settings { device_memory_mib: Some(1024), ..Settings::default() };
    let preferences = Preferences::default();
    let mut harness = panel(settings, move |ui, settings| preferences.program(ui, settings));
    let memory = |settings: &Settings| (settings.frame_cache_mib, settings.device_memory_mib);
    for (label, whole) in [("Frame memory", (512, Some(1024))), ("Device memory", (512, Some(512)))] {
        let before = memory(harness.state());
        harness.get_by_label(label).focus();
        harness.run();
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.get_by_label(label).type_text("512");
        harness.run();
        assert_eq!(memory(harness.state()), before);
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(memory(harness.state()), whole);
    }
}
