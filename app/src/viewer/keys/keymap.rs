//! Which keys call which action: those that the program comes with, and what the user has changed.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{Key, KeyboardShortcut, Modifiers};
use serde::{Deserialize, Serialize};

use crate::viewer::keys::shortcuts::{Action, SHORTCUTS};

/// The keys of every action.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keymap {
    changed: BTreeMap<Action, Vec<KeyboardShortcut>>,
}

/// An action with other keys than the program's own, as settings hold it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Binding {
    pub action: Action,
    /// `Ctrl+Shift+E`; Ctrl is the command key on a Mac.
    pub keys: Vec<String>,
}

impl Keymap {
    /// The keys that are in force in the window of `context`.
    pub fn of(context: &egui::Context) -> Arc<Keymap> {
        context.data_mut(|data| Arc::clone(data.get_temp_mut_or_default::<Arc<Keymap>>(Self::id())))
    }

    /// Puts these keys in force.
    pub fn install(&self, context: &egui::Context) {
        context.data_mut(|data| data.insert_temp(Self::id(), Arc::new(self.clone())));
    }

    fn id() -> egui::Id {
        egui::Id::unique("keymap")
    }

    pub fn keys(&self, action: Action) -> Vec<KeyboardShortcut> {
        self.changed.get(&action).cloned().unwrap_or_else(|| own_keys(action))
    }

    /// All keys with their actions. Those with more modifiers come first: a key with Ctrl is also that key.
    pub fn bindings(&self) -> Vec<(KeyboardShortcut, Action)> {
        let mut all: Vec<_> = actions()
            .flat_map(|action| self.keys(action).into_iter().map(move |keys| (keys, action)))
            .collect();
        all.sort_by_key(|(keys, _)| {
            let Modifiers { command, shift, alt, .. } = keys.modifiers;
            Reverse(u8::from(command) + u8::from(shift) + u8::from(alt))
        });
        all
    }

    /// The action that `keys` call.
    pub fn action(&self, keys: &KeyboardShortcut) -> Option<Action> {
        self.bindings().into_iter().find(|(known, _)| known == keys).map(|(_, action)| action)
    }

    /// Calls `action` by `keys` alone, and no other action by them.
    pub fn assign(&mut self, action: Action, keys: KeyboardShortcut) {
        while let Some(other) = self.action(&keys).filter(|other| *other != action) {
            let left = self.keys(other).into_iter().filter(|known| *known != keys).collect();
            self.change(other, left);
        }
        self.change(action, vec![keys]);
    }

    /// Leaves `action` without keys.
    pub fn clear(&mut self, action: Action) {
        self.change(action, Vec::new());
    }

    /// Gives `action` the program's own keys again, unless another action has them now.
    pub fn reset(&mut self, action: Action) {
        self.changed.remove(&action);
        let free = |keys: &KeyboardShortcut| {
            self.bindings().into_iter().all(|(known, other)| known != *keys || other == action)
        };
        let left: Vec<_> = own_keys(action).into_iter().filter(free).collect();
        self.change(action, left);
    }

    pub fn is_changed(&self, action: Action) -> bool {
        self.changed.contains_key(&action)
    }

    fn change(&mut self, action: Action, keys: Vec<KeyboardShortcut>) {
        match keys == own_keys(action) {
            true => self.changed.remove(&action),
            false => self.changed.insert(action, keys),
        };
    }

    /// What the user has changed, for settings.
    pub fn to_bindings(&self) -> Vec<Binding> {
        let text = |keys: &Vec<KeyboardShortcut>| keys.iter().map(to_text).collect();
        self.changed.iter().map(|(action, keys)| Binding { action: *action, keys: text(keys) }).collect()
    }

    /// From settings. Keys that this program does not know are left out.
    pub fn from_bindings(bindings: &[Binding]) -> Keymap {
        let mut keymap = Keymap::default();
        for Binding { action, keys } in bindings {
            keymap.change(*action, keys.iter().filter_map(|text| from_text(text)).collect());
        }
        keymap
    }
}

/// Every action that keys may call, once.
pub fn actions() -> impl Iterator<Item = Action> {
    SHORTCUTS.iter().filter(|shortcut| !shortcut.meaning.is_empty()).map(|shortcut| shortcut.action)
}

fn own_keys(action: Action) -> Vec<KeyboardShortcut> {
    SHORTCUTS
        .iter()
        .filter(|shortcut| shortcut.action == action)
        .filter_map(|shortcut| shortcut.keys)
        .collect()
}

fn to_text(keys: &KeyboardShortcut) -> String {
    let Modifiers { command, shift, alt, .. } = keys.modifiers;
    let held = [(command, "Ctrl+"), (shift, "Shift+"), (alt, "Alt+")];
    let held: String = held.into_iter().filter(|(is_held, _)| *is_held).map(|(_, name)| name).collect();
    held + keys.logical_key.name()
}

fn from_text(text: &str) -> Option<KeyboardShortcut> {
    let mut modifiers = Modifiers::NONE;
    let mut rest = text;
    while let Some((held, after)) = rest.split_once('+').filter(|(_, after)| !after.is_empty()) {
        match held {
            "Ctrl" => modifiers.command = true,
            "Shift" => modifiers.shift = true,
            "Alt" => modifiers.alt = true,
            _ => return None,
        }
        rest = after;
    }
    Key::from_name(rest).map(|key| KeyboardShortcut::new(modifiers, key))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CTRL_J: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::J);

    #[test]
    fn every_action_has_a_name_and_no_two_have_the_same_keys() {
        let bindings = Keymap::default().bindings();
        for (index, (keys, action)) in bindings.iter().enumerate() {
            assert!(!crate::viewer::keys::shortcuts::meaning(*action).is_empty(), "{action:?}");
            let same = bindings[..index].iter().find(|(other, _)| other == keys);
            assert!(same.is_none(), "{keys:?} call {action:?} and {same:?}");
        }
    }

    #[test]
    fn keys_have_one_action_at_a_time() {
        let mut keymap = Keymap::default();
        let taken = keymap.keys(Action::Help);
        assert!(taken.len() > 1, "further keys of an action");
        keymap.assign(Action::Fly, taken[0]);
        assert_eq!(keymap.action(&taken[0]), Some(Action::Fly));
        assert_eq!(keymap.keys(Action::Help), taken[1..]);
        keymap.reset(Action::Help);
        assert_eq!(keymap.keys(Action::Help), taken[1..], "they are another's now");
        keymap.reset(Action::Fly);
        keymap.reset(Action::Help);
        assert_eq!(keymap, Keymap::default());
    }

    #[test]
    fn what_was_changed_outlives_the_program() {
        let mut keymap = Keymap::default();
        keymap.assign(Action::Look(crate::viewer::orbit_camera::Side::NegX), CTRL_J);
        keymap.clear(Action::Quit);
        let text = serde_json::to_string(&keymap.to_bindings()).unwrap();
        assert!(text.contains("Ctrl+J"), "{text}");
        let bindings: Vec<Binding> = serde_json::from_str(&text).unwrap();
        assert_eq!(Keymap::from_bindings(&bindings), keymap);
    }

    #[test]
    fn keys_are_written_as_they_are_read() {
        for (keys, _) in Keymap::default().bindings() {
            assert_eq!(from_text(&to_text(&keys)), Some(keys), "{}", to_text(&keys));
        }
        assert_eq!(from_text("Hyper+X"), None);
        assert_eq!(from_text("Ctrl+"), None);
    }
}
