use egui_kittest::kittest::Queryable;

use super::{assert_written, fluid, panel};
use crate::viewer::panels::messages;

#[test]
fn messages_are_counted_and_dismissed_one_by_one() {
    let mut session = fluid();
    session.complain("the first");
    session.complain("the second");
    session.complain("the first");
    let mut harness = panel(session, |ui, session| messages::show(ui, session, ui.max_rect()));
    assert_written(&harness, &["the first  (×2)", "the second"]);
    harness.get_all_by_label("Dismiss").next().unwrap().click();
    harness.run();
    let left: Vec<&str> =
        harness.state().messages.list().iter().map(|message| message.text.as_str()).collect();
    assert_eq!(left, ["the second"]);
}

#[test]
fn errors_that_do_not_fit_are_counted_and_come_back() {
    let mut session = fluid();
    (0..8).for_each(|number| session.complain(format!("error {number}")));
    let mut harness = panel(session, |ui, session| messages::show(ui, session, ui.max_rect()));
    assert_written(&harness, &["error 2", "error 7", "and 2 earlier"]);
    for _ in 0..2 {
        harness.get_all_by_label("Dismiss").last().unwrap().click();
        harness.run();
    }
    assert_written(&harness, &["error 0", "error 5"]);
}
