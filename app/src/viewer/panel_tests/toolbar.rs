use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use renderer::Stats;

use super::{fluid, pictured};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::orbit_camera::Side;
use crate::viewer::panels::toolbar::{self, Modes};
use crate::viewer::session::Session;
use crate::viewer::theme;

type Bar = (Session, Vec<Action>);

/// The bar in a window of the size that it has at first.
fn bar(session: Session) -> Harness<'static, Bar> {
    let mut harness = Harness::builder().with_size(egui::vec2(1280.0, 300.0)).build_ui_state(
        |ui, (session, actions): &mut Bar| {
            theme::apply(ui.ctx());
            let modes = Modes { flying: false, tool: None, panels: true };
            ui.allocate_ui(egui::vec2(ui.available_width(), 40.0), |ui| {
                toolbar::show(ui, session, modes, actions);
            });
        },
        (session, Vec::new()),
    );
    harness.run();
    harness
}

fn called(harness: &mut Harness<'_, Bar>, labels: &[&str]) -> Vec<Action> {
    for label in labels {
        harness.get_by_label(label).click();
        harness.run();
    }
    std::mem::take(&mut harness.state_mut().1)
}

#[test]
fn a_click_calls_the_action_that_the_button_is_named_after() {
    let mut harness = bar(pictured(fluid(), Stats::default()));
    for (labels, action) in [
        (&["Open", "Folder…"][..], Action::OpenFolder),
        (&["View", "Save view…"], Action::SaveView),
        (&["Picture", "Save picture…"], Action::SavePicture),
        (&["Reset"], Action::Reset),
        (&["+X"], Action::Look(Side::PosX)),
        (&["Fly"], Action::Fly),
        (&["Inspect"], Action::Inspect),
        (&["Panels"], Action::Panels),
        (&["Help"], Action::Help),
    ] {
        assert_eq!(called(&mut harness, labels), [action], "{labels:?}");
    }
}

#[test]
fn without_a_scene_there_is_no_camera_to_move() {
    let mut harness = bar(fluid());
    assert!(harness.get_by_label("Reset").accesskit_node().is_disabled());
    assert!(called(&mut harness, &["Reset", "+X", "Fly"]).is_empty());
    assert_eq!(called(&mut harness, &["Help"]), [Action::Help]);
}

#[test]
fn undo_can_be_pressed_when_there_is_something_to_undo() {
    let mut harness = bar(fluid());
    let (session, _) = harness.state_mut();
    let now = Instant::now();
    session.remember(now, false);
    session.view.sampling.rate = 2.0;
    session.remember(now, false);
    session.remember(now + Duration::from_secs(1), false);
    harness.run();
    assert_eq!(called(&mut harness, &["Undo"]), [Action::Undo]);
}
