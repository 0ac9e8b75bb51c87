//! What adaptive sampling brought for the picture in view: its predicted error, and its samples.

use egui::Ui;

use crate::viewer::session::Session;
use crate::viewer::widgets;

use super::sampling::plain;

pub fn show(ui: &mut Ui, session: &Session) {
    let Some(picture) = &session.picture else { return };
    let stats = &picture.stats;
    ui.scope(|ui| {
        let evaluations = &stats.evaluations;
        let in_full = stats.is_in_full();
        let predicted = match picture.sampling.tolerance {
            Some(tolerance) if !in_full => format!("{} of {tolerance}", plain(stats.predicted_error)),
            _ => "0, sampled in full".into(),
        };
        let hint = match picture.sampling.tolerance {
            Some(_) if in_full => "To find out what may be left out would take longer here than it saves",
            _ => "The largest that any pixel may have, of the tolerance that it may use up",
        };
        widgets::fact(ui, "Predicted error", predicted).on_hover_text(hint);
        widgets::fact(ui, "Evaluations", widgets::large(evaluations.done)).on_hover_text(format!(
            "Kernel weights computed for one particle at one place; {} of them to find out what may be left \
             out",
            widgets::large(evaluations.bounds)
        ));
    });
}
