//! What a moving picture may take, and how much larger its error may be for that.

use egui::{DragValue, RichText, Ui};

use crate::viewer::render_thread::budget::Budget;
use crate::viewer::session::Session;
use crate::viewer::theme;
use crate::viewer::widgets::{self, Areas};

use super::sampling::{in_steps, plain};

pub fn show(ui: &mut Ui, session: &mut Session) {
    let budget = &mut session.budget;
    widgets::row(ui, "While moving", |ui| {
        let hint = "While something moves, the tolerance rises until a picture of full size takes no longer than \
                    this. Where that is not enough, or brings nothing, fewer pixels are drawn. At rest, and in \
                    saved pictures and views, the tolerance is your own. Without it, only fewer pixels are drawn.";
        let switch = ui.checkbox(&mut budget.on, "below").on_hover_text(hint);
        Areas::mark(ui, "budget", switch.rect);
        let field = DragValue::new(&mut budget.milliseconds).range(Budget::MILLISECONDS).max_decimals(0);
        ui.add_enabled(budget.on, field.suffix(" ms"))
            .accessible_name("Milliseconds of a moving picture")
            .on_hover_text(hint);
    });
    if !budget.on {
        return;
    }
    widgets::row(ui, "Tolerance to", |ui| {
        let hint = "The largest tolerance while something moves";
        let field = widgets::number(&mut budget.most, 0.0).range(Budget::MOST);
        ui.add(field).accessible_name("Largest tolerance while moving").on_hover_text(hint);
        ui.label(RichText::new(in_steps(budget.most)).small().color(theme::colours().muted));
    });
    let (text, colour) = in_force(session);
    ui.label(RichText::new(text).small().color(colour));
    ui.add_space(4.0);
}

/// Which tolerance the picture in view has, and why.
fn in_force(session: &Session) -> (String, egui::Color32) {
    let raised = session.picture.as_ref().and_then(|picture| picture.raised());
    match (session.view.sampling.tolerance, raised) {
        (Some(own), Some(raised)) => (
            format!("The picture has a tolerance of {}; yours is {own}", plain(raised)),
            theme::colours().warning,
        ),
        (Some(own), None) if own >= session.budget.most => {
            ("Your tolerance is no smaller: only fewer pixels are drawn".into(), theme::colours().muted)
        }
        (Some(own), None) => (format!("The picture has your tolerance of {own}"), theme::colours().muted),
        (None, _) => ("Full sampling stays full: only fewer pixels are drawn".into(), theme::colours().muted),
    }
}
