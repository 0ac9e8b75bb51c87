//! What a click in each panel changes in the session, and how the panels look.

mod quantity;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Ui;
use egui_kittest::Harness;
use renderer::View;

use super::run::Run;
use super::session::Session;
use super::{Wake, theme};
use crate::frames::Sequence;

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
    session(path.to_str().unwrap())
}

fn lattice(side: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..side.pow(3)).map(move |i| [i % side, i / side % side, i / side / side])
}

/// A session whose first frame, and what is counted of it, are there.
fn session(run: &str) -> Session {
    let wake: Wake = Arc::new(|| {});
    let mut session = Session::new(View::default());
    session.open(Run::new(&Sequence::open(&[PathBuf::from(run)]).unwrap(), &wake));
    let limit = Instant::now() + Duration::from_secs(20);
    while session.frame().is_none() {
        assert!(Instant::now() < limit, "the frame did not come");
        session.poll(Instant::now());
        std::thread::sleep(Duration::from_millis(2));
    }
    count(&mut session);
    session
}

/// Counts what the session asks for, as the window does in the background.
fn count(session: &mut Session) {
    while let Some(question) = session.question() {
        session.answer(question.answer());
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
