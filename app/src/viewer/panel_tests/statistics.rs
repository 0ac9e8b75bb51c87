use egui_kittest::kittest::Queryable;
use renderer::Filter;

use super::{assert_written, fluid, panel};
use crate::viewer::panels::statistics;
use crate::viewer::session::Session;

/// Counts what the session asks for, as the window does in the background.
fn counted(session: &mut Session) {
    while let Some(question) = session.statistics_question() {
        session.statistics = Some(question.answer());
    }
}

#[test]
fn the_numbers_follow_the_filter() {
    let mut session = fluid();
    session.view.quantity.name = Some("density".into());
    let mut harness = panel(session, |ui, session| {
        counted(session);
        statistics::show(ui, session);
    });
    assert_written(&harness, &["64", "0 … 3", "density", "1000", "1030", "1015"]);
    let upper = Filter { field: "density".into(), range: [1015.0, 2000.0], invert: false, on: true };
    harness.state_mut().view.select.filters.push(upper);
    harness.run();
    assert_written(&harness, &["32 of 64", "2 … 3", "1020", "1025"]);
}

#[test]
fn the_numbers_are_copied() {
    let mut harness = panel(fluid(), |ui, session| {
        statistics::show(ui, session);
        counted(session);
    });
    harness.get_by_label("Copy as CSV").click();
    harness.step();
    let copied = harness.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    assert!(copied.is_some_and(|text| text.starts_with("frame,particles,of,")));
}

#[test]
fn a_filter_by_a_field_that_is_not_there_is_told() {
    let mut session = fluid();
    let filter = Filter { field: "dye".into(), range: [0.0, 1.0], invert: false, on: true };
    session.view.select.filters.push(filter);
    let harness = panel(session, |ui, session| {
        counted(session);
        statistics::show(ui, session);
    });
    let why = "select.filters: filter 0: there is no field `dye`; there are: velocity, density";
    assert_written(&harness, &[why]);
}
