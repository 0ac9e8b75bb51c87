//! Runs that grow on the disk while they are shown.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use renderer::View;

use super::super::Session;
use crate::frames::{FrameState, Sequence, Watcher};
use crate::viewer::Wake;
use crate::viewer::run::Run;

fn write(folder: &Path, number: usize, particles: usize) {
    let rows: String = (0..particles).map(|i| format!("{i},0,0\n")).collect();
    std::fs::write(folder.join(format!("a_{number}.csv")), format!("x,y,z\n{rows}")).unwrap();
}

fn session(folder: &Path) -> (Session, Vec<PathBuf>, Wake) {
    let (paths, wake): (_, Wake) = (vec![folder.to_owned()], Arc::new(|| {}));
    let mut session = Session::new(View::default());
    session.open(Run::new(&Sequence::open(&paths).unwrap(), 1 << 20, &wake));
    (session, paths, wake)
}

fn until(session: &mut Session, what: &str, holds: impl Fn(&Session) -> bool) {
    let start = Instant::now();
    while !holds(session) {
        assert!(start.elapsed() < Duration::from_secs(30), "{what} did not come about");
        session.poll(Instant::now());
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn particles_in_view(session: &Session) -> Option<(usize, usize)> {
    session.frame().map(|(index, frame)| (*index, frame.len()))
}

#[test]
fn new_frames_lengthen_the_run_and_are_followed() {
    let folder = tempfile::tempdir().unwrap();
    (1..3).for_each(|number| write(folder.path(), number, number));
    let (mut session, paths, _) = session(folder.path());
    let mut watcher = Watcher::new(paths.clone(), &Sequence::open(&paths).unwrap());
    let later = SystemTime::now() + Duration::from_secs(3600);
    let mut look = |session: &mut Session| (0..2).for_each(|_| session.take_change(&watcher.look(later)));
    look(&mut session);
    write(folder.path(), 3, 7);
    look(&mut session);
    assert_eq!((session.playback.count(), session.playback.index()), (3, 0), "who does not follow stays");
    session.follow(true);
    until(&mut session, "the newest frame", |session| particles_in_view(session) == Some((2, 7)));
    write(folder.path(), 4, 8);
    look(&mut session);
    until(&mut session, "the next one", |session| particles_in_view(session) == Some((3, 8)));
    session.jump(1);
    write(folder.path(), 5, 9);
    look(&mut session);
    assert_eq!((session.playback.count(), session.playback.index()), (5, 1), "pointing at a frame ends it");

    until(&mut session, "frame 1", |session| particles_in_view(session) == Some((1, 2)));
    write(folder.path(), 2, 20);
    look(&mut session);
    look(&mut session);
    until(&mut session, "its new content", |session| particles_in_view(session) == Some((1, 20)));
    std::fs::remove_file(folder.path().join("a_2.csv")).unwrap();
    look(&mut session);
    let told = session.messages.list().last().unwrap().text.clone();
    assert!(told.starts_with("a_2.csv: gone from the disk"), "{told}");
    assert_eq!(particles_in_view(&session), Some((1, 20)), "what is in memory stays in view");
}

#[test]
fn what_is_about_a_frame_stays_with_it_when_another_comes_before() {
    let folder = tempfile::tempdir().unwrap();
    [2, 4, 6].iter().for_each(|number| write(folder.path(), *number, *number));
    let (mut session, paths, _) = session(folder.path());
    let mut watcher = Watcher::new(paths.clone(), &Sequence::open(&paths).unwrap());
    let later = SystemTime::now() + Duration::from_secs(3600);
    let mut look = |session: &mut Session| (0..2).for_each(|_| session.take_change(&watcher.look(later)));
    look(&mut session);
    session.jump(1);
    until(&mut session, "frame 1", |session| particles_in_view(session) == Some((1, 4)));
    session.camera = Some(crate::viewer::orbit_camera::OrbitCamera::overview(None, 1.0, 1.0));
    let now = Instant::now();
    session.remember(now, false);
    session.set_keyframe();
    session.remember(now + Duration::from_secs(1), false);
    session.remember(now + Duration::from_secs(2), false);
    session.told.insert(2);
    session.without_picture = Some(1);
    let asked = session.numbering();
    while let Some(question) = session.question() {
        session.answer(question.answer());
    }
    let frame = Arc::clone(&session.frame().unwrap().1);

    // Before, between and behind those that are known.
    [1, 3, 5, 7].iter().for_each(|number| write(folder.path(), *number, *number));
    look(&mut session);
    let name = |session: &Session| session.run().unwrap().name(session.playback.index()).to_owned();
    assert_eq!((session.playback.count(), session.playback.index()), (7, 3));
    assert_eq!(name(&session), "a_4.csv");
    assert!(matches!(session.frame(), Some((3, here)) if Arc::ptr_eq(here, &frame)), "it is not read again");
    assert_eq!(session.run().unwrap().stream.cached().len(), 7);
    assert_eq!(session.view.path.keyframes[0].frame, 3.0);
    assert_eq!(session.told.iter().copied().collect::<Vec<_>>(), [5]);
    assert_eq!(session.without_picture, Some(3));
    assert!(session.question().is_none(), "what is known of the frame is known");
    let (mut before, mut now_numbered) = ([2], [2]);
    assert!(session.bring_up_to_date(asked, &mut before));
    assert!(session.bring_up_to_date(session.numbering(), &mut now_numbered));
    assert_eq!((before, now_numbered), ([5], [2]));
    session.remember(now + Duration::from_secs(3), false);
    assert!(session.can_undo(), "the keyframe is a step, to be numbered anew is none");
    session.undo();
    assert!(session.view.path.keyframes.is_empty());
    session.redo();
    assert_eq!(session.view.path.keyframes[0].frame, 3.0, "the steps back and forth count alike");
    for (index, particles) in [(0, 1), (6, 7), (2, 3), (5, 6)] {
        session.jump(index);
        until(&mut session, "the frame", |session| particles_in_view(session) == Some((index, particles)));
    }
}

#[test]
fn the_first_frame_is_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let (paths, wake): (_, Wake) = (vec![folder.path().to_owned()], Arc::new(|| {}));
    let found = crate::viewer::run::find(&paths).unwrap();
    let mut watcher = Watcher::new(paths.clone(), &found);
    let mut run = Run::new(&found, 1 << 20, &wake);
    run.watch(&paths, &wake);
    assert_eq!(run.title, folder.path().file_name().unwrap().to_string_lossy());
    let mut session = Session::new(View::default());
    session.open(run);
    session.follow(true);
    session.toggle_playing();
    session.step(true);
    session.poll(Instant::now());
    assert_eq!(session.waits_in(), Some(folder.path().to_str().unwrap()));
    assert!(!session.waiting() && session.may_grow() && session.messages.list().is_empty());
    write(folder.path(), 1, 5);
    let later = SystemTime::now() + Duration::from_secs(3600);
    session.follow(true);
    (0..3).for_each(|_| session.take_change(&watcher.look(later)));
    assert_eq!(session.waits_in(), None);
    until(&mut session, "the first frame", |session| particles_in_view(session) == Some((0, 5)));
    write(folder.path(), 0, 3);
    (0..3).for_each(|_| session.take_change(&watcher.look(later)));
    until(&mut session, "it is still the newest", |session| particles_in_view(session) == Some((1, 5)));
    assert_eq!(session.range_source, crate::viewer::session::RangeSource::Seen);
}

#[test]
fn a_half_written_frame_is_waited_for_and_not_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a_1.csv"), "x,y,z\n0,0").unwrap();
    let (mut session, paths, wake) = session(folder.path());
    let mut run = Run::new(&Sequence::open(&paths).unwrap(), 1 << 20, &wake);
    run.watch(&paths, &wake);
    session.open(run);
    until(&mut session, "the failure", |session| {
        matches!(session.run().unwrap().stream.get(0), FrameState::Failed(_))
    });
    session.poll(Instant::now());
    assert!(session.messages.list().is_empty() && session.trouble().is_none() && session.waiting());
    write(folder.path(), 1, 5);
    until(&mut session, "the whole frame", |session| particles_in_view(session) == Some((0, 5)));
    assert!(session.messages.list().is_empty());
}

#[test]
fn a_frame_that_stays_bad_is_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a_1.csv"), "x,y,z\n0,0").unwrap();
    let (mut session, paths, wake) = session(folder.path());
    let mut run = Run::new(&Sequence::open(&paths).unwrap(), 1 << 20, &wake);
    run.watch(&paths, &wake);
    session.open(run);
    until(&mut session, "the message", |session| !session.messages.list().is_empty());
    assert!(session.trouble().is_some());
}

#[test]
fn a_frame_that_is_written_anew_is_counted_anew() {
    let folder = tempfile::tempdir().unwrap();
    let write = |number: usize, heat: [f64; 2]| {
        let text = format!("x,y,z,heat\n0,0,0,{}\n1,0,0,{}\n", heat[0], heat[1]);
        std::fs::write(folder.path().join(format!("a_{number}.csv")), text).unwrap();
    };
    write(1, [1.0, 2.0]);
    write(2, [0.0, 900.5]);
    let (mut session, paths, _) = session(folder.path());
    session.view.quantity.name = Some("heat".into());
    let mut watcher = Watcher::new(paths.clone(), &Sequence::open(&paths).unwrap());
    let later = SystemTime::now() + Duration::from_secs(3600);
    let mut look = |session: &mut Session| (0..2).for_each(|_| session.take_change(&watcher.look(later)));
    look(&mut session);
    let count = |session: &mut Session, index, heat: f64| {
        session.jump(index);
        until(session, "the frame", |session| {
            let frame = session.frame().filter(|(here, _)| *here == index);
            let heat_of = |frame: &crate::frames::Frame| frame.field("heat").unwrap().column.get(1, 0);
            frame.is_some_and(|(_, frame)| heat_of(frame) == heat)
        });
        let question = session.question().expect("what is in it is not known");
        session.answer(question.answer());
    };
    count(&mut session, 0, 2.0);
    count(&mut session, 1, 900.5);
    assert_eq!(session.range(), Some([0.0, 900.5]));
    write(2, [3.0, 4.25]);
    look(&mut session);
    count(&mut session, 1, 4.25);
    assert_eq!(session.range(), Some([1.0, 4.25]), "what was half written is no longer seen");
    let found = session.distribution(crate::viewer::session::Role::Colour).unwrap();
    assert_eq!(found.extremes, Some([3.0, 4.25]));
}
