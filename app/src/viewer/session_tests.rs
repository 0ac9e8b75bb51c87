use std::path::PathBuf;

use renderer::{CameraView, ControlPoint, Stats};

use super::*;
use crate::frames::Sequence;
use crate::viewer::Wake;
use crate::viewer::orbit_camera::Side;
use crate::viewer::playback::Arrival;
use crate::viewer::render_thread::prepare::Preparation;
use crate::viewer::render_thread::{Report, Shown};

pub(super) const ROOM: [u32; 2] = [640, 400];

pub(super) fn open(frames: &[&str]) -> Session {
    let mut session = Session::new(View::default());
    session.open(run(frames));
    session
}

pub(super) fn run(frames: &[&str]) -> Run {
    let paths: Vec<PathBuf> = frames.iter().map(PathBuf::from).collect();
    let wake: Wake = Arc::new(|| {});
    Run::new(&Sequence::open(&paths).unwrap(), 1 << 20, &wake)
}

/// Polls until the frame at the playhead is there, or nothing can be done about it.
pub(super) fn settle(session: &mut Session) {
    let limit = Instant::now() + Duration::from_secs(20);
    loop {
        session.poll(Instant::now());
        if session.frame().is_some() && !session.waiting() && session.trouble().is_none() {
            return;
        }
        if session.trouble().is_some() && session.playback.arrival() == Arrival::Jumped {
            return;
        }
        assert!(Instant::now() < limit, "the frame did not come");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// A file that no reader takes for a frame.
fn bad_file(folder: &tempfile::TempDir) -> String {
    let path = folder.path().join("bad.vtk");
    std::fs::write(&path, "not a frame").unwrap();
    path.display().to_string()
}

/// What the renderer reports of the frame in view, with a picture of one grey pixel.
pub(super) fn picture(session: &Session) -> Report {
    let (index, frame) = session.frame().unwrap();
    let (_, facts) = Preparation::default().scene(frame, &session.complete_view()).unwrap();
    Report::Picture(Box::new(Shown {
        index: *index,
        numbering: session.numbering(),
        width: 1,
        height: 1,
        pixels: vec![[128, 128, 128, 255]],
        full: ROOM,
        divisor: 4,
        sampling: session.view.sampling,
        wished: session.view.sampling.tolerance,
        stats: Stats::default(),
        facts,
        drawn: None,
        cells: None,
        probed: None,
        shot: None,
    }))
}

#[test]
fn a_bad_frame_is_told_once_and_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let bad = bad_file(&folder);
    let mut session = open(&["demo:radial:27", &bad, &bad, "demo:radial:64"]);
    settle(&mut session);
    assert_eq!(session.frame().unwrap().1.len(), 27);
    session.step(true);
    settle(&mut session);
    assert_eq!(session.playback.index(), 3, "both bad frames are passed over");
    assert_eq!(session.messages.list().len(), 2);
    session.step(false);
    settle(&mut session);
    assert_eq!(session.playback.index(), 0, "known bad frames are not tried again");
    session.jump(1);
    settle(&mut session);
    assert!(session.trouble().is_some(), "where the user points, it says why");
    assert_eq!(session.messages.list().len(), 2);
}

#[test]
fn a_run_of_bad_frames_ends_the_search() {
    let folder = tempfile::tempdir().unwrap();
    let bad = bad_file(&folder);
    let mut session = open(&[&bad, &bad]);
    session.toggle_playing();
    let limit = Instant::now() + Duration::from_secs(20);
    while session.playback.playing() || session.messages.list().len() < 2 {
        session.poll(Instant::now());
        assert!(Instant::now() < limit);
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(session.frame().is_none() && session.job(Instant::now(), ROOM).is_none());
}

#[test]
fn a_job_is_asked_for_once_and_again_when_something_changes() {
    let now = Instant::now();
    let mut session = open(&["demo:radial:27"]);
    settle(&mut session);
    let job = session.job(now, ROOM).unwrap();
    assert_eq!([job.view.image.width, job.view.image.height], ROOM);
    assert!(!job.moving && session.job(now, ROOM).is_none());
    session.view.transfer.points[0].opacity = 0.5;
    session.touch(now);
    assert!(session.job(now, ROOM).unwrap().moving);
    assert!(session.due(now).is_some());
    let later = now + 2 * SETTLE;
    assert!(!session.job(later, ROOM).unwrap().moving, "at rest it is refined");
    assert!(session.job(later, ROOM).is_none());
    assert!(session.job(later, [0, 400]).is_none(), "no room, no picture");
}

#[test]
fn the_picture_keeps_the_shape_of_the_image() {
    let mut session = open(&["demo:radial:27"]);
    settle(&mut session);
    session.job(Instant::now(), ROOM);
    session.fits_window = false;
    (session.view.image.width, session.view.image.height) = (3000, 1000);
    assert_eq!(session.fitted(), [640, 213]);
    (session.view.image.width, session.view.image.height) = (1, 32_768);
    assert_eq!(session.fitted(), [1, 400]);
    assert_eq!(session.complete_view().image.height, 32_768, "it is saved in its own size");
}

#[test]
fn a_saved_view_brings_the_same_picture_back() {
    let mut session = open(&["demo:radial:64"]);
    settle(&mut session);
    session.job(Instant::now(), ROOM);
    session.note(&picture(&session));
    let camera = session.camera.as_mut().unwrap();
    camera.look_from(Side::NegZ);
    camera.fly(glam::DVec3::new(0.1, 0.2, 0.3));
    session.view.transfer.points.push(ControlPoint { u: 1.0, rgb: [1.0, 0.0, 0.0], opacity: 0.7 });
    session.view.quantity.range = Some([0.25, 0.75]);
    session.range_source = RangeSource::Fixed;
    (session.view.sampling.tolerance, session.view.sampling.super_pixels) = (Some(0.01), false);
    let saved = View::from_json(&session.complete_view().to_json()).unwrap();
    assert!(saved.validate().is_ok());

    let mut again = Session::new(saved.clone());
    again.open(run(&["demo:radial:64"]));
    settle(&mut again);
    again.job(Instant::now(), ROOM);
    assert_eq!(again.range_source, RangeSource::Fixed);
    again.note(&picture(&again));
    let near = |a: CameraView, b: CameraView| a.eye.distance(b.eye) + a.target.distance(b.target) < 1e-9;
    assert!(near(again.complete_view().camera.unwrap(), saved.camera.unwrap()));
    session.reset_camera();
    session.adopt(saved.clone());
    assert!(near(session.complete_view().camera.unwrap(), saved.camera.unwrap()));
    assert_eq!(session.complete_view().transfer, saved.transfer);
    assert_eq!(again.complete_view().sampling, saved.sampling);
}

#[test]
fn ranges_come_from_the_frame_from_all_seen_or_from_the_user() {
    let mut session = open(&["demo:radial:1000", "demo:radial:8"]);
    assert_eq!(session.range_source, RangeSource::Seen, "colours of a sequence do not jump");
    settle(&mut session);
    let first = session.question().unwrap().answer();
    session.answer(first.clone());
    assert_eq!(session.range(), first.colour.extremes);
    assert!(session.steady().colour, "a film must look at the frame that was not seen");
    session.step(true);
    settle(&mut session);
    let second = session.question().unwrap().answer();
    session.answer(second.clone());
    let ([a, b], [c, d]) = (first.colour.extremes.unwrap(), second.colour.extremes.unwrap());
    assert_eq!(session.range(), Some([a.min(c), b.max(d)]));
    assert!(!session.steady().colour, "all is known");
    session.range_source = RangeSource::Frame;
    assert_eq!(session.complete_view().quantity.range, None);
    session.answer(session.question().unwrap().answer());
    assert_eq!(session.range(), second.colour.extremes);
    assert!(session.question().is_none());
}

#[test]
fn another_run_keeps_the_colours_and_gets_its_own_camera() {
    let mut session = open(&["demo:radial:27"]);
    settle(&mut session);
    session.job(Instant::now(), ROOM);
    session.note(&picture(&session));
    session.view.transfer.points[0].opacity = 0.9;
    session.view.particles.support_radius = Some(7.0);
    session.open(run(&["demo:checker:27"]));
    assert!(session.camera.is_none() && session.view.particles.support_radius.is_none());
    assert_eq!(session.view.transfer.points[0].opacity, 0.9);
}

#[test]
fn playing_goes_on_where_a_frame_has_no_picture() {
    let mut session = open(&["demo:radial:27", "demo:checker:27"]);
    settle(&mut session);
    session.toggle_playing();
    session.note(&Report::Failed {
        index: 0,
        numbering: session.numbering(),
        text: "there is no field".into(),
    });
    let start = Instant::now();
    session.poll(start);
    session.poll(start + Duration::from_secs(1));
    assert_eq!(session.playback.index(), 1);
    assert_eq!(session.messages.list().len(), 1);
}
