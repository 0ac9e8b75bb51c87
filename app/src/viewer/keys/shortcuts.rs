//! What the program can be told to do, and by which keys: one table for the keyboard, the command
//! palette, the settings and the help.

use egui::{Key, KeyboardShortcut, Modifiers};
use serde::{Deserialize, Serialize};

use crate::viewer::keys::keymap::Keymap;
use crate::viewer::orbit_camera::Side;

/// A command to the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    OpenFiles,
    OpenFolder,
    OpenDemo,
    LoadView,
    SaveView,
    SavePicture,
    QuickSave,
    Export,
    MeasureError,
    Undo,
    Redo,
    PlayPause,
    StepForward,
    StepBack,
    First,
    Last,
    Reset,
    Look(Side),
    ZoomIn,
    ZoomOut,
    Fly,
    Walk,
    CopyCamera,
    PasteCamera,
    Bookmark,
    GoTo(u8),
    Keyframe,
    FollowPath,
    Inspect,
    Pick,
    Measure,
    CellClasses,
    Palette,
    Settings,
    Start,
    Panels,
    Performance,
    FullScreen,
    Help,
    Quit,
}

/// A command, what it is called in menus and help, and the keys that call it unless the user has others.
pub struct Shortcut {
    pub group: &'static str,
    /// `None` where no key calls it.
    pub keys: Option<KeyboardShortcut>,
    pub action: Action,
    /// Empty for further keys of an action that stands above.
    pub meaning: &'static str,
}

const NONE: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

const fn key(
    group: &'static str,
    modifiers: Modifiers,
    key: Key,
    action: Action,
    meaning: &'static str,
) -> Shortcut {
    Shortcut { group, keys: Some(KeyboardShortcut::new(modifiers, key)), action, meaning }
}

/// A command without keys.
const fn command(group: &'static str, action: Action, meaning: &'static str) -> Shortcut {
    Shortcut { group, keys: None, action, meaning }
}

/// Every command, with the keys that the program comes with.
pub const SHORTCUTS: &[Shortcut] = &[
    key("Files", CTRL, Key::O, Action::OpenFiles, "Open files"),
    key("Files", CTRL_SHIFT, Key::O, Action::OpenFolder, "Open a folder as a sequence"),
    command("Files", Action::OpenDemo, "Open the demo run"),
    key("Files", CTRL, Key::L, Action::LoadView, "Load a view"),
    key("Files", CTRL, Key::S, Action::SaveView, "Save the view"),
    key("Files", CTRL, Key::E, Action::SavePicture, "Save the picture"),
    key("Files", CTRL_SHIFT, Key::E, Action::QuickSave, "Save both in this folder"),
    key("Files", CTRL_SHIFT, Key::S, Action::Export, "Export pictures or a video"),
    key("Files", CTRL, Key::Q, Action::Quit, "Quit"),
    key("Picture", CTRL, Key::Z, Action::Undo, "Undo a change of settings or camera"),
    key("Picture", CTRL_SHIFT, Key::Z, Action::Redo, "Redo what was undone"),
    key("Picture", CTRL, Key::Y, Action::Redo, ""),
    key("Time", NONE, Key::Space, Action::PlayPause, "Play or pause"),
    key("Time", NONE, Key::ArrowRight, Action::StepForward, "Next frame"),
    key("Time", NONE, Key::ArrowLeft, Action::StepBack, "Previous frame"),
    key("Time", CTRL, Key::ArrowLeft, Action::First, "First frame"),
    key("Time", CTRL, Key::ArrowRight, Action::Last, "Last frame"),
    key("Camera", NONE, Key::Home, Action::Reset, "Whole scene in view"),
    key("Camera", NONE, Key::Num1, Action::Look(Side::PosX), "Look from +X"),
    key("Camera", NONE, Key::Num2, Action::Look(Side::NegX), "Look from −X"),
    key("Camera", NONE, Key::Num3, Action::Look(Side::PosY), "Look from +Y"),
    key("Camera", NONE, Key::Num4, Action::Look(Side::NegY), "Look from −Y"),
    key("Camera", NONE, Key::Num5, Action::Look(Side::PosZ), "Look from +Z"),
    key("Camera", NONE, Key::Num6, Action::Look(Side::NegZ), "Look from −Z"),
    key("Camera", NONE, Key::Plus, Action::ZoomIn, "Zoom in"),
    key("Camera", NONE, Key::Equals, Action::ZoomIn, ""),
    key("Camera", NONE, Key::Minus, Action::ZoomOut, "Zoom out"),
    key("Camera", NONE, Key::F, Action::Fly, "Fly mode on or off"),
    key("Camera", NONE, Key::G, Action::Walk, "Walk mode on or off"),
    key("Camera", CTRL_SHIFT, Key::C, Action::CopyCamera, "Copy the camera as text"),
    key("Camera", CTRL_SHIFT, Key::V, Action::PasteCamera, "Paste a camera, or that of a view"),
    key("Camera", NONE, Key::B, Action::Bookmark, "Bookmark the camera"),
    key("Camera", CTRL, Key::Num1, Action::GoTo(1), "Go to bookmark 1"),
    key("Camera", CTRL, Key::Num2, Action::GoTo(2), "Go to bookmark 2"),
    key("Camera", CTRL, Key::Num3, Action::GoTo(3), "Go to bookmark 3"),
    key("Camera", CTRL, Key::Num4, Action::GoTo(4), "Go to bookmark 4"),
    key("Camera", CTRL, Key::Num5, Action::GoTo(5), "Go to bookmark 5"),
    key("Camera", CTRL, Key::Num6, Action::GoTo(6), "Go to bookmark 6"),
    key("Camera", CTRL, Key::Num7, Action::GoTo(7), "Go to bookmark 7"),
    key("Camera", CTRL, Key::Num8, Action::GoTo(8), "Go to bookmark 8"),
    key("Camera", CTRL, Key::Num9, Action::GoTo(9), "Go to bookmark 9"),
    key("Camera", SHIFT, Key::K, Action::Keyframe, "Set or remove a keyframe here"),
    command("Camera", Action::FollowPath, "Follow the camera path, or no longer"),
    key("Picture", NONE, Key::C, Action::CellClasses, "Classes of the cells on or off"),
    key("Picture", NONE, Key::I, Action::Inspect, "Inspect: a click looks into a pixel"),
    command("Picture", Action::MeasureError, "Measure the error against full sampling"),
    key("Window", CTRL, Key::K, Action::Palette, "Command palette"),
    key("Window", CTRL, Key::Comma, Action::Settings, "Settings"),
    key("Window", CTRL, Key::H, Action::Start, "Start page: recent runs"),
    key("Picture", NONE, Key::K, Action::Pick, "Pick: a click picks a particle"),
    key("Picture", NONE, Key::M, Action::Measure, "Measure: two clicks, and how far apart they are"),
    key("Window", NONE, Key::P, Action::Panels, "Side panel on or off"),
    key("Window", NONE, Key::F9, Action::Performance, "Times of the last pictures on or off"),
    key("Window", NONE, Key::F11, Action::FullScreen, "Full screen on or off"),
    key("Window", NONE, Key::H, Action::Help, "This help"),
    key("Window", NONE, Key::F1, Action::Help, ""),
    key("Window", NONE, Key::Questionmark, Action::Help, ""),
];

/// What the mouse does over the picture, and the keys that act as long as they are held.
pub const GESTURES: [(&str, &str); 12] = [
    ("Left drag", "Orbit"),
    ("Right drag, Shift + drag", "Pan"),
    ("Wheel, pinch", "Zoom to the cursor"),
    ("Ctrl + left drag", "Zoom to the centre"),
    ("Ctrl + Shift + left drag", "Roll"),
    ("Double click", "Turn around this point"),
    ("Click", "With Inspect: look into this pixel"),
    ("Click", "With Pick, Measure: the particle seen here"),
    ("Escape", "Close what a tool opened; put it away"),
    ("W A S D, Q E", "When flying or walking: move, sink, rise"),
    ("Left drag, wheel", "Flying or walking: look around, speed"),
    ("Shift", "Flying or walking: faster"),
];

/// Keys that act on the button or slider that has the focus, or move it on.
const OF_WIDGETS: [Key; 8] = [
    Key::Space,
    Key::Enter,
    Key::Tab,
    Key::Escape,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
];

/// Takes the actions out of the keyboard input; none while a text is written.
pub fn pressed(context: &egui::Context) -> Vec<Action> {
    if context.text_edit_focused() {
        return Vec::new();
    }
    let focused = context.egui_wants_keyboard_input();
    let bindings = Keymap::of(context).bindings();
    let called = |event: &egui::Event| match event {
        egui::Event::Key { key, pressed: true, .. } if focused && OF_WIDGETS.contains(key) => None,
        egui::Event::Key { key, modifiers, pressed: true, .. } => bindings
            .iter()
            .find(|(keys, _)| keys.logical_key == *key && modifiers.matches_logically(keys.modifiers)),
        _ => None,
    };
    // In the order in which they were pressed: several may come in one frame of a busy window.
    context.input_mut(|input| {
        let mut actions = Vec::new();
        input.events.retain(|event| match called(event) {
            Some((_, action)) => {
                actions.push(*action);
                false
            }
            None => true,
        });
        actions
    })
}

/// What an action is called.
pub fn meaning(action: Action) -> &'static str {
    SHORTCUTS.iter().find(|shortcut| shortcut.action == action).map_or("", |shortcut| shortcut.meaning)
}

/// What a tooltip says of an action: its meaning and its keys.
pub fn hint(context: &egui::Context, action: Action) -> String {
    with_keys(context, meaning(action), action)
}

/// A text, and the keys of an action after it.
pub fn with_keys(context: &egui::Context, text: &str, action: Action) -> String {
    match keys(context, action) {
        keys if keys.is_empty() => text.to_owned(),
        keys => format!("{text}  ({keys})"),
    }
}

/// The keys that call an action, in words; empty where there are none.
pub fn keys(context: &egui::Context, action: Action) -> String {
    let keys = Keymap::of(context).keys(action);
    keys.first().map_or_else(String::new, |keys| context.format_shortcut(keys))
}
