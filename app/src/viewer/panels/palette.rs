//! The command palette: every command, found by typing a part of its name.

use egui::{Align2, Key, RichText, Ui, vec2};

use crate::viewer::keys::keymap::actions;
use crate::viewer::keys::shortcuts::{Action, SHORTCUTS, keys, meaning};
use crate::viewer::widgets::Areas;
use crate::viewer::{accessible, theme};

/// An open palette.
#[derive(Default)]
pub struct Palette {
    query: String,
    /// Which of the commands found is called by Enter.
    chosen: usize,
}

const WIDTH: f32 = 440.0;
const LINE_HEIGHT: f32 = 28.0;
const LINES: f32 = 11.0;

impl Palette {
    /// Shows the palette while it is open, and calls the command that is chosen.
    pub fn show(open: &mut Option<Palette>, ui: &Ui, called: &mut Vec<Action>) {
        let Some(palette) = open else { return };
        let area = egui::Modal::default_area(egui::Id::unique("palette"))
            .anchor(Align2::CENTER_TOP, vec2(0.0, 72.0));
        let modal = egui::Modal::new(egui::Id::unique("palette")).area(area);
        let frame = egui::Frame::window(ui.style()).inner_margin(10);
        let response = modal.frame(frame).show(ui.ctx(), |ui| {
            ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 60.0));
            palette.contents(ui)
        });
        if let Some(action) = response.inner {
            called.push(action);
            *open = None;
        } else if response.should_close() {
            *open = None;
        }
    }

    fn contents(&mut self, ui: &mut Ui) -> Option<Action> {
        // Before the text field, which would take them for its own.
        let (down, up, enter) = ui.input_mut(|input| {
            let mut pressed = |key| input.count_and_consume_key(egui::Modifiers::NONE, key);
            (pressed(Key::ArrowDown), pressed(Key::ArrowUp), pressed(Key::Enter) > 0)
        });
        let field = egui::TextEdit::singleline(&mut self.query).hint_text("What do you want to do?");
        let field = ui.add(field.desired_width(f32::INFINITY).margin(vec2(8.0, 6.0)));
        let field = field.accessible_name("Find a command");
        Areas::mark(ui, "palette", field.rect);
        field.request_focus();
        if field.changed() {
            self.chosen = 0;
        }
        let found = find(&self.query);
        self.chosen = (self.chosen + down).saturating_sub(up).min(found.len().saturating_sub(1));
        ui.add_space(4.0);
        let mut called = found.get(self.chosen).copied().filter(|_| enter);
        if found.is_empty() {
            ui.label(RichText::new("There is no such command.").color(theme::colours().muted));
        }
        egui::ScrollArea::vertical().max_height(LINES * LINE_HEIGHT).auto_shrink([false, true]).show(
            ui,
            |ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                for (place, action) in found.into_iter().enumerate() {
                    let response = line(ui, action, place == self.chosen);
                    if place == self.chosen && up + down > 0 {
                        response.scroll_to_me(None);
                    }
                    if response.clicked() {
                        called = Some(action);
                    }
                }
            },
        );
        called
    }
}

/// A command with its group before it and its keys at the right edge.
fn line(ui: &mut Ui, action: Action, chosen: bool) -> egui::Response {
    let size = vec2(ui.available_width(), LINE_HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click());
    if chosen || response.hovered() {
        let fill = if chosen { theme::colours().accent_deep } else { theme::colours().raised };
        ui.painter().rect_filled(rect, 4, fill);
    }
    let font = egui::TextStyle::Body.resolve(ui.style());
    let left = rect.left_center() + vec2(8.0, 0.0);
    ui.painter().text(left, Align2::LEFT_CENTER, group(action), font.clone(), theme::colours().muted);
    let name = left + vec2(64.0, 0.0);
    ui.painter().text(name, Align2::LEFT_CENTER, meaning(action), font, theme::colours().text);
    let right = rect.right_center() - vec2(8.0, 0.0);
    let keys = keys(ui.ctx(), action);
    ui.painter().text(right, Align2::RIGHT_CENTER, keys, theme::small_font(), theme::colours().muted);
    accessible::switch(ui, &response, meaning(action), chosen);
    response
}

/// Commands in whose group or name every word of `query` begins a word; those that have them in the name,
/// and sooner, come first.
fn find(query: &str) -> Vec<Action> {
    let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    let mut found: Vec<(usize, Action)> = actions()
        .filter(|action| *action != Action::Palette)
        .filter_map(|action| {
            let name = meaning(action).to_lowercase();
            let whole = format!("{name} {}", group(action).to_lowercase());
            let places: Option<usize> = words.iter().map(|word| begins_word(&whole, word)).sum();
            Some((places?, action))
        })
        .collect();
    found.sort_by_key(|(place, _)| *place);
    found.into_iter().map(|(_, action)| action).collect()
}

/// Where in `text` a word begins with `part`.
fn begins_word(text: &str, part: &str) -> Option<usize> {
    let begins = |place: &usize| text[..*place].chars().next_back().is_none_or(|c| !c.is_alphanumeric());
    text.match_indices(part).map(|(place, _)| place).find(begins)
}

fn group(action: Action) -> &'static str {
    SHORTCUTS.iter().find(|shortcut| shortcut.action == action).map_or("", |shortcut| shortcut.group)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::orbit_camera::Side;

    #[test]
    fn commands_are_found_by_the_beginnings_of_their_words() {
        assert_eq!(find("zo in").first(), Some(&Action::ZoomIn));
        assert_eq!(find("LOOK +y").first(), Some(&Action::Look(Side::PosY)));
        assert!(find("oom").is_empty(), "the middle of a word");
        assert_eq!(find("").len(), actions().count() - 1);
    }

    #[test]
    fn a_group_finds_its_commands_behind_those_of_that_name() {
        let found = find("fi");
        assert_eq!(found.first(), Some(&Action::First), "First frame");
        assert!(found.contains(&Action::SaveView) && !found.contains(&Action::Fly));
    }
}
