//! What a click in each panel changes in the session, and how the panels look.

mod annotations;
mod bookmarks;
mod camera;
mod camera_path;
mod cells;
mod export;
mod handles;
mod help;
mod inspector;
mod looking;
mod measured_error;
mod messages;
mod overlay_legend;
mod palette;
mod particles;
mod performance;
mod preferences;
mod quantity;
mod sampling;
mod saved;
mod selection;
mod shortcuts;
mod snapshots;
mod statistics;
mod timeline;
mod toolbar;
mod transfer;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Shape, Ui};
use egui_kittest::Harness;
use renderer::{Stats, View};

use super::render_thread::{Report, Shown};
use super::run::Run;
use super::session::Session;
use super::{Wake, theme};
use crate::frames::Sequence;
use crate::viewer::render_thread::prepare::Preparation;

/// A session over a block of fluid: 4 × 4 × 4 particles with a density and a velocity.
fn fluid() -> Session {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fluid.csv");
    let mut text = String::from("x,y,z,density,vx,vy,vz\n");
    for [x, y, z] in lattice(4) {
        let speed = 0.25 * f64::from(z);
        text += &format!("{x},{y},{z},{},{speed},0,{}\n", 1000 + 10 * y, -speed);
    }
    std::fs::write(&path, text).unwrap();
    session_over(&[path.to_str().unwrap()])
}

fn lattice(side: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..side.pow(3)).map(move |i| [i % side, i / side % side, i / side / side])
}

/// A session whose first frame, and what is counted of it, are there.
fn session_over(frames: &[&str]) -> Session {
    let wake: Wake = Arc::new(|| {});
    let mut session = Session::new(View::default());
    let paths: Vec<PathBuf> = frames.iter().map(PathBuf::from).collect();
    session.open(Run::new(&Sequence::open(&paths).unwrap(), 1 << 20, &wake));
    frame_arrives(&mut session);
    count(&mut session);
    session
}

/// Waits for the frame at the playhead.
fn frame_arrives(session: &mut Session) {
    let limit = Instant::now() + Duration::from_secs(20);
    while session.frame().map(|(index, _)| *index) != Some(session.playback.index()) {
        assert!(Instant::now() < limit, "the frame did not come");
        session.poll(Instant::now());
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Counts what the session asks for, as the window does in the background.
fn count(session: &mut Session) {
    while let Some(question) = session.question() {
        session.answer(question.answer());
    }
}

/// What the renderer reports of the frame in view: a picture of one grey pixel that cost `stats`.
fn shown(session: &Session, stats: Stats) -> Shown {
    let (index, frame) = session.frame().unwrap();
    let (_, facts) = Preparation::default().scene(frame, &session.complete_view()).unwrap();
    Shown {
        index: *index,
        numbering: session.numbering(),
        width: 1,
        height: 1,
        pixels: vec![[128, 128, 128, 255]],
        full: [640, 400],
        divisor: 1,
        sampling: session.view.sampling,
        wished: session.view.sampling.tolerance,
        stats,
        facts,
        drawn: None,
        cells: None,
        probed: None,
        shot: None,
    }
}

/// The same session with that picture in view.
fn pictured(mut session: Session, stats: Stats) -> Session {
    let shown = shown(&session, stats);
    session.note(&Report::Picture(Box::new(shown)));
    session
}

/// All that is written, by labels and by painters, from the back to the front.
fn texts<S>(harness: &Harness<'_, S>) -> Vec<String> {
    fn collect(shape: &Shape, texts: &mut Vec<String>) {
        match shape {
            Shape::Text(text) => texts.push(text.galley.text().to_owned()),
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect(shape, texts)),
            _ => {}
        }
    }
    let mut texts = Vec::new();
    harness.output().shapes.iter().for_each(|clipped| collect(&clipped.shape, &mut texts));
    texts
}

/// Fails unless all of these are written somewhere.
#[track_caller]
fn assert_written<S>(harness: &Harness<'_, S>, wanted: &[&str]) {
    let texts = texts(harness);
    for wanted in wanted {
        assert!(texts.iter().any(|text| text == wanted), "`{wanted}` is not among {texts:?}");
    }
}

/// A panel over `state`, as wide as the side panel and in the program's look.
fn panel<'a, S: 'a>(state: S, mut show: impl FnMut(&mut Ui, &mut S) + 'a) -> Harness<'a, S> {
    let mut harness = Harness::builder()
        .with_size(egui::vec2(theme::SIDE_WIDTH - 2.0 * f32::from(theme::MARGIN), 600.0))
        .build_ui_state(
            move |ui, state| {
                theme::apply(ui.ctx());
                show(ui, state);
            },
            state,
        );
    harness.run();
    harness
}
