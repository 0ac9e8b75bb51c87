//! The exports, how far they are, and what can be done with each.

use std::time::{Duration, Instant};

use egui::{Align, Layout, ProgressBar, RichText, Ui};

use crate::export::Stage;
use crate::viewer::exports::{Export, Exports, Progress, State};
use crate::viewer::{theme, widgets};

/// What a button asks for.
enum Wish {
    Cancel,
    Resume,
    Remove,
}

pub fn show(ui: &mut Ui, exports: &mut Exports) {
    if exports.list.is_empty() {
        return;
    }
    ui.add_space(6.0);
    ui.separator();
    let mut wish = None;
    egui::ScrollArea::vertical().max_height(220.0).show(ui, |ui| {
        for (index, export) in exports.list.iter().enumerate() {
            if let Some(wanted) = ui.push_id(index, |ui| line(ui, export)).inner {
                wish = Some((index, wanted));
            }
        }
    });
    match wish {
        Some((index, Wish::Cancel)) => exports.list[index].cancel(),
        Some((index, Wish::Resume)) => exports.resume(index),
        Some((index, Wish::Remove)) => exports.remove(index),
        None => {}
    }
}

fn line(ui: &mut Ui, export: &Export) -> Option<Wish> {
    let mut wish = None;
    let name = export.plan.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    ui.horizontal(|ui| {
        ui.set_min_height(theme::ROW_HEIGHT);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            wish = buttons(ui, export, &name);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let label = ui.add(egui::Label::new(&name).truncate());
                label.on_hover_text(export.plan.path.display().to_string());
            });
        });
    });
    let (text, colour) = words(export);
    if matches!(export.state, State::Running) {
        let bar =
            ProgressBar::new(export.progress().whole()).desired_height(6.0).fill(theme::colours().accent);
        ui.add(bar);
    }
    ui.add(egui::Label::new(RichText::new(text).small().color(colour)).wrap());
    wish
}

fn buttons(ui: &mut Ui, export: &Export, name: &str) -> Option<Wish> {
    if export.is_pending() {
        let cancel = ui.small_button("Cancel").accessible_name(format!("Cancel {name}"));
        return cancel.clicked().then_some(Wish::Cancel);
    }
    let remove = ui.small_button("Remove").accessible_name(format!("Remove {name}"));
    if remove.on_hover_text("From this list; files stay").clicked() {
        return Some(Wish::Remove);
    }
    if let State::Cancelled | State::Failed(_) = export.state {
        let resume = ui.small_button("Resume").accessible_name(format!("Resume {name}"));
        let hint = "Goes on with the pictures that are not done; a video begins anew";
        return resume.on_hover_text(hint).clicked().then_some(Wish::Resume);
    }
    None
}

/// How it stands with an export.
fn words(export: &Export) -> (String, egui::Color32) {
    match &export.state {
        State::Waiting => ("Waits for the one before it".into(), theme::colours().muted),
        State::Running => (running(&export.progress(), Instant::now()), theme::colours().muted),
        State::Cancelled => ("Cancelled; what is done stays".into(), theme::colours().warning),
        State::Failed(why) => (why.clone(), theme::colours().error),
        State::Done(summary) => {
            let made = summary.frames - summary.kept - summary.failed.len();
            let mut text = match made {
                1 => "Done: 1 frame".to_owned(),
                made => format!("Done: {made} frames"),
            };
            if summary.kept > 0 {
                text += &format!(", {} kept", summary.kept);
            }
            match summary.failed.len() {
                0 => (text, theme::colours().muted),
                failed => (format!("{text}, {failed} could not be drawn"), theme::colours().warning),
            }
        }
    }
}

fn running(progress: &Progress, now: Instant) -> String {
    let Progress { stage, index, share, count, .. } = *progress;
    let number = (index + 1).min(count);
    match stage {
        // Without any word from the work so far.
        Stage::Survey if index == 0 && share == 0.0 => "Preparing the graphics device…".into(),
        Stage::Survey => format!("Looking through the frames, {number} of {count}"),
        Stage::Pictures => {
            let left =
                progress.left(now).map_or(String::new(), |left| format!("  ·  {} left", duration(left)));
            format!("Frame {number} of {count}, {}{left}", widgets::percent(f64::from(share)))
        }
    }
}

/// `8 s`, `3 min`, `2 h 5 min`.
fn duration(time: Duration) -> String {
    match time.as_secs() {
        seconds if seconds < 60 => format!("{} s", seconds.max(1)),
        seconds if seconds < 3600 => format!("{} min", seconds.div_ceil(60)),
        seconds => format!("{} h {} min", seconds / 3600, seconds % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_as_exact_as_a_guess_can_be() {
        let text = |seconds| duration(Duration::from_secs(seconds));
        assert_eq!([0, 59, 61, 3599, 7500].map(text), ["1 s", "59 s", "2 min", "60 min", "2 h 5 min"]);
    }
}
