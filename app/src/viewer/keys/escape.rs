//! Whom the Escape key is for.

use egui::{Context, Key, Popup};

/// Tells an Escape that is for the picture from one that leaves a field or closes a menu.
#[derive(Default)]
pub struct Escape {
    /// Whether something had the focus at the end of the last frame.
    focused: bool,
}

impl Escape {
    /// Whether Escape was pressed, and nothing else is there for it to leave or to close. To be asked before
    /// the layout, during which menus close; the focus is gone even then.
    pub fn pressed(&self, context: &Context) -> bool {
        let elsewhere = self.focused || Popup::is_any_open(context);
        !elsewhere && context.input(|input| input.key_pressed(Key::Escape))
    }

    /// Takes note of the focus, at the end of a frame.
    pub fn remember(&mut self, context: &Context) {
        self.focused = context.egui_wants_keyboard_input();
    }
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;

    struct State {
        escape: Escape,
        text: String,
        pressed: u32,
    }

    fn window() -> Harness<'static, State> {
        let state = State { escape: Escape::default(), text: String::new(), pressed: 0 };
        let show = |ui: &mut egui::Ui, state: &mut State| {
            state.pressed += u32::from(state.escape.pressed(ui.ctx()));
            ui.menu_button("Menu", |ui| ui.label("Entry"));
            let _ = ui.text_edit_singleline(&mut state.text).accessible_name("Text");
            state.escape.remember(ui.ctx());
        };
        Harness::new_ui_state(show, state)
    }

    #[test]
    fn an_escape_that_closes_a_menu_or_leaves_a_field_is_for_nothing_else() {
        let mut harness = window();
        for focused in [false, true] {
            match focused {
                false => harness.get_by_label("Menu").click(),
                true => harness.get_by_label("Text").focus(),
            }
            harness.run();
            harness.key_press(Key::Escape);
            harness.run();
            assert_eq!(harness.state().pressed, u32::from(focused), "focused: {focused}");
            assert!(harness.query_by_label("Entry").is_none() && !harness.ctx.egui_wants_keyboard_input());
            harness.key_press(Key::Escape);
            harness.run();
            assert_eq!(harness.state().pressed, 1 + u32::from(focused));
        }
    }
}
