//! What the last picture cost, stage by stage.

use egui::{Align2, RichText, Sense, Ui, vec2};

use crate::viewer::keys::shortcuts::{Action, hint};
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

use super::budget;

/// `hud` says whether the times of the last pictures are shown over the picture.
pub fn show(ui: &mut Ui, session: &mut Session, hud: bool, actions: &mut Vec<Action>) {
    budget::show(ui, session);
    let mut shown = hud;
    let switch = ui.checkbox(&mut shown, "Show over the picture");
    if switch.on_hover_text(hint(ui.ctx(), Action::Performance)).changed() {
        actions.push(Action::Performance);
    }
    let Some(picture) = &session.picture else {
        ui.label(RichText::new("No picture yet.").color(theme::colours().faint));
        return;
    };
    let stats = &picture.stats;
    let times = &stats.milliseconds;
    let stages = [
        ("Upload", times.upload),
        ("Grid", times.grid),
        ("Analysis", times.analysis),
        ("Merge", times.merge),
        ("Ray cast", times.ray_cast),
    ];
    let longest = stages.iter().map(|(_, ms)| *ms).fold(f64::MIN_POSITIVE, f64::max);
    // A stage that is not part of this picture has no line.
    for (name, ms) in stages.into_iter().filter(|(_, ms)| *ms > 0.0) {
        bar(ui, name, ms, ms / longest);
    }
    bar(ui, "Total", times.total, 0.0);
    ui.add_space(2.0);
    let [width, height] = picture.full;
    let share = if picture.divisor == 1 { String::new() } else { format!("  at 1/{}", picture.divisor) };
    widgets::fact(ui, "Picture", format!("{width} × {height}{share}"));
    widgets::fact(ui, "Slices", widgets::count(stats.slices));
    widgets::fact(ui, "Cells", widgets::count(stats.cells));
    widgets::fact(ui, "Pairs", widgets::count(stats.pairs));
    widgets::fact(ui, "Device memory", widgets::bytes(stats.gpu_bytes))
        .on_hover_text("The most that the renderer held at a time for this picture");
    if let Some(run) = session.run() {
        let [held, limit] =
            [run.stream.bytes(), run.stream.budget()].map(|bytes| widgets::bytes(bytes as u64));
        widgets::fact(ui, "Frames in memory", format!("{held} of {limit}"))
            .on_hover_text("Frames read ahead and kept, of what they may take beside the current one");
    }
    let software = session.adapter.as_ref().is_some_and(|(_, software)| *software);
    widgets::fact(
        ui,
        "Backend",
        if software { format!("{}, on the CPU", stats.backend) } else { stats.backend.clone() },
    );
    ui.horizontal(|ui| {
        ui.label(RichText::new("Adapter").color(theme::colours().muted));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add(egui::Label::new(RichText::new(&stats.adapter).small()).truncate())
                .on_hover_text(&stats.adapter);
        });
    });
}

/// A stage's time as a number and as a bar.
fn bar(ui: &mut Ui, name: &str, ms: f64, share: f64) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 18.0), Sense::hover());
    let font = egui::TextStyle::Body.resolve(ui.style());
    let painter = ui.painter();
    painter.text(rect.left_center(), Align2::LEFT_CENTER, name, font, theme::colours().muted);
    let text = if ms < 100.0 { format!("{ms:.2} ms") } else { format!("{ms:.0} ms") };
    painter.text(
        rect.right_center(),
        Align2::RIGHT_CENTER,
        text,
        theme::number_font(),
        theme::colours().text,
    );
    let mut track = rect.shrink2(vec2(0.0, 6.0));
    track.set_left(rect.left() + theme::LABEL_WIDTH);
    track.set_right(rect.right() - 86.0);
    track.set_width(track.width() * share.clamp(0.0, 1.0) as f32);
    painter.rect_filled(track, 2, theme::colours().accent);
}
