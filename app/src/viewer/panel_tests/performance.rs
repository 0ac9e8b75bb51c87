use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{Evaluations, Milliseconds, Stats};

use super::{assert_written, fluid, panel, pictured, shown, texts};
use crate::difference::Difference;
use crate::viewer::inspect::measurement::{Measured, SpeedUp, State};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::panels::{budget, hud::Hud, performance};
use crate::viewer::render_thread::{Drawn, Report};
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

fn stats() -> Stats {
    Stats {
        slices: 1232,
        evaluations: Evaluations { done: 5_000_000, bounds: 1, ..Evaluations::default() },
        predicted_error: 0.003,
        milliseconds: Milliseconds { grid: 2.5, ray_cast: 10.25, total: 12.75, ..Milliseconds::default() },
        gpu_bytes: 3 << 20,
        ..Stats::default()
    }
}

/// A session with a picture of 20 ms at half the resolution, and one of 40 ms in full.
fn drawn() -> Session {
    let mut session = fluid();
    for (divisor, milliseconds) in [(2, 20.0), (1, 40.0)] {
        let mut shown = shown(&session, stats());
        shown.divisor = divisor;
        shown.drawn = Some(Drawn { moving: divisor > 1, preparing: 1.0, milliseconds });
        session.note(&Report::Picture(Box::new(shown)));
    }
    session
}

#[test]
fn the_panel_tells_the_stages_of_the_last_picture_and_the_memory_that_is_held() {
    let harness = panel((pictured(fluid(), stats()), Vec::new()), |ui, (session, actions)| {
        performance::show(ui, session, false, actions);
    });
    assert_written(&harness, &["Grid", "2.50 ms", "10.25 ms", "12.75 ms", "1\u{202f}232", "3.0 MiB"]);
    assert!(!texts(&harness).iter().any(|text| text == "Analysis"), "there was none");
    let stream = &harness.state().0.run().unwrap().stream;
    let [held, limit] = [stream.bytes(), stream.budget()].map(|bytes| widgets::bytes(bytes as u64));
    assert_written(&harness, &[&format!("{held} of {limit}")]);
}

#[test]
fn the_panel_turns_the_display_over_the_picture_on() {
    let mut harness = panel((fluid(), Vec::new()), |ui, (session, actions)| {
        performance::show(ui, session, false, actions);
    });
    harness.get_by_label("Show over the picture").click();
    harness.run();
    assert_eq!(harness.state().1, [Action::Performance]);
}

/// The display over a picture that fills the window.
pub(super) fn over(ui: &mut egui::Ui, (session, hud): &mut (Session, Hud)) {
    hud.show(ui, session, None, ui.max_rect());
}

/// The open display of a session in which something moved for a while: coarser, with larger tolerances, and
/// at last at rest.
pub(super) fn drawn_for_a_while() -> (Session, Hud) {
    let mut session = fluid();
    session.budget.on = true;
    for number in 0..80_u32 {
        let mut shown = shown(&session, stats());
        let moving = number < 78;
        let wave = 0.5 - 0.5 * f64::from(number % 40) / 40.0;
        let times = &mut shown.stats.milliseconds;
        (times.analysis, times.ray_cast) = (4.0 + 10.0 * wave, 10.25 + 16.0 * wave);
        shown.divisor = if moving { 1 + number / 20 } else { 1 };
        if moving && number >= 12 {
            shown.sampling.tolerance = Some(0.004 + 0.0005 * f64::from(number - 12).min(16.0));
        }
        shown.drawn = Some(Drawn { moving, preparing: 1.5, milliseconds: 22.0 + 28.0 * wave });
        session.note(&Report::Picture(Box::new(shown)));
    }
    (session, open())
}

fn open() -> Hud {
    let mut hud = Hud::default();
    hud.open = true;
    hud
}

fn over_picture(session: Session) -> Harness<'static, (Session, Hud)> {
    let mut harness = Harness::builder().with_size(egui::vec2(960.0, 700.0)).build_ui_state(
        |ui, state: &mut (Session, Hud)| {
            theme::apply(ui.ctx());
            over(ui, state);
        },
        (session, open()),
    );
    harness.run();
    harness
}

#[test]
fn the_display_tells_the_last_picture_and_the_one_under_the_mouse() {
    let mut harness = over_picture(drawn());
    assert_written(&harness, &["40.0 ms", "full", "0.004", "10.2 ms", "26.2 ms", "0.003 of 0.004", "5.00 M"]);
    // The last but one is three points from the right end of its bars.
    let bars = harness.get_by_label("Times of the last pictures").rect();
    harness.hover_at(bars.right_top() + egui::vec2(-4.0, 20.0));
    harness.run();
    assert_written(&harness, &["1 before, frame 0", "20.0 ms", "1/2", "6.2 ms"]);
}

#[test]
fn the_share_of_full_sampling_is_told_where_it_is_known() {
    let measured = Measured {
        tolerance: 0.004,
        error: Difference { max: 0.002, place: [0, 0], mean: 0.0, above: 0.0 },
        errors: Vec::new(),
        size: [1, 1],
        speed_up: SpeedUp { time: 1.5, evaluations: 4.0, milliseconds: [20.0, 30.0] },
    };
    let measured = State::Done(Box::new(measured));
    let harness = panel((drawn(), open()), move |ui, (session, hud)| {
        hud.show(ui, session, Some(&measured), ui.max_rect());
    });
    assert_written(&harness, &["5.00 M, 25.0 % of full"]);
    let mut session = fluid();
    let mut in_full = shown(&session, Stats::default());
    in_full.drawn = Some(Drawn { moving: false, preparing: 0.0, milliseconds: 1.0 });
    session.note(&Report::Picture(Box::new(in_full)));
    assert_written(&over_picture(session), &["0, all", "0, in full"]);
}

#[test]
fn the_display_is_copied_as_a_table_and_closed() {
    let mut harness = over_picture(drawn());
    // The command is that of one frame: the one in which the button is let go of.
    harness.get_by_label("Copy as CSV").click_accesskit();
    harness.step();
    let copied = harness.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    assert_eq!(copied.map(|text| text.lines().count()), Some(3));
    harness.get_by_label("Close").click();
    harness.run();
    assert!(!harness.state().1.open && texts(&harness).is_empty());
}

#[test]
fn before_the_first_picture_there_is_nothing_to_tell() {
    assert_written(&over_picture(fluid()), &["No picture yet."]);
}

#[test]
fn a_time_for_moving_pictures_is_asked_for_and_the_tolerance_in_force_told() {
    let mut session = fluid();
    let mut raised = shown(&session, stats());
    raised.sampling.tolerance = Some(0.012);
    session.note(&Report::Picture(Box::new(raised)));
    let mut harness = panel(session, budget::show);
    assert!(harness.query_by_label("Largest tolerance while moving").is_none());
    harness.get_by_label("below").click();
    harness.run();
    assert!(harness.state().budget.on);
    assert_written(&harness, &["The picture has a tolerance of 0.012; yours is 0.004"]);
    harness.get_by_label("Milliseconds of a moving picture").set_value_accesskit(1.0);
    harness.run();
    harness.get_by_label("Largest tolerance while moving").set_value_accesskit(0.02);
    harness.run();
    let budget = harness.state().budget;
    assert_eq!((budget.milliseconds, budget.most), (5.0, 0.02), "no picture takes a millisecond");
    assert_eq!(
        harness.state().complete_view().sampling.tolerance,
        Some(0.004),
        "what is saved is the user's"
    );

    harness.state_mut().view.sampling.tolerance = None;
    harness.run();
    assert_written(&harness, &["Full sampling stays full: only fewer pixels are drawn"]);
}

#[test]
fn the_display_tells_a_raised_tolerance() {
    let mut session = drawn();
    let mut raised = shown(&session, stats());
    raised.sampling.tolerance = Some(0.012);
    raised.drawn = Some(Drawn { moving: true, preparing: 1.0, milliseconds: 35.0 });
    session.note(&Report::Picture(Box::new(raised)));
    assert_written(&over_picture(session), &["Tolerance, yours 0.004", "0.012", "0.003 of 0.012"]);
}
