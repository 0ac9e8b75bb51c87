//! What becomes of the settings of one run when another one is opened.

use renderer::{AnnotationsView, OpacityView, Scale};

use super::tests::{ROOM, open, picture, run, settle};
use super::*;
use crate::viewer::render_thread::Report;
use crate::viewer::render_thread::prepare::Preparation;

/// A session that shows its run, with a picture.
fn shown(frames: &[&str]) -> Session {
    let mut session = open(frames);
    settle(&mut session);
    session.job(Instant::now(), ROOM);
    session.note(&picture(&session));
    session
}

fn told(session: &Session) -> Vec<&str> {
    session.messages.list().iter().map(|message| message.text.as_str()).collect()
}

#[test]
fn fields_that_another_run_lacks_are_given_up() {
    let mut session = shown(&["demo:checker:27"]);
    let name = || Some("concentration".to_owned());
    (session.view.quantity.name, session.view.quantity.scale) = (name(), Scale::Log);
    session.view.quantity.opacity = Some(OpacityView { name: name(), ..OpacityView::default() });
    session.open(run(&["demo:radial:27"]));
    session.remember(Instant::now(), false);
    settle(&mut session);
    let (_, frame) = session.frame().unwrap();
    assert!(Preparation::default().scene(frame, &session.drawn_view()).is_ok(), "there is a picture");
    let quantity = &session.view.quantity;
    assert_eq!((&quantity.name, quantity.scale, &quantity.opacity), (&None, Scale::Linear, &None));
    assert_eq!(
        told(&session),
        [
            "demo:radial:27 has no field concentration: its radius is shown",
            "demo:radial:27 has no field concentration: one field decides colour and opacity"
        ]
    );
    session.remember(Instant::now() + Duration::from_secs(5), true);
    session.remember(Instant::now() + Duration::from_secs(5), false);
    assert!(!session.can_undo(), "that is no step of the user's");
}

#[test]
fn fields_that_another_run_has_too_stay_and_so_do_those_of_a_given_view() {
    let mut session = shown(&["demo:checker:27"]);
    session.view.quantity.name = Some("Concentration".into());
    session.open(run(&["demo:checker:64"]));
    settle(&mut session);
    assert_eq!(session.view.quantity.name.as_deref(), Some("Concentration"));

    // Of a view that is loaded before the first frame comes, or given at the start.
    session.open(run(&["demo:radial:27"]));
    let given = session.view.clone();
    session.adopt(given.clone());
    settle(&mut session);
    assert_eq!(session.view.quantity.name.as_deref(), Some("Concentration"));
    let mut session = Session::new(given);
    session.open(run(&["demo:radial:27"]));
    settle(&mut session);
    assert_eq!(session.view.quantity.name.as_deref(), Some("Concentration"));
    assert!(told(&session).is_empty());
}

#[test]
fn another_run_has_no_path_no_bookmarks_and_no_title_yet() {
    let mut session = shown(&["demo:radial:27", "demo:radial:64"]);
    session.set_keyframe();
    session.view.path.revolutions = 2.0;
    session.add_bookmark();
    let look = AnnotationsView { title: "A jet".into(), axes: true, ..AnnotationsView::of_window() };
    session.view.annotations = Some(look);
    let kept = session.complete_view();
    session.open(run(&["demo:checker:27", "demo:checker:64"]));
    assert!(session.view.path.is_empty() && session.view.bookmarks.is_empty());
    assert!(session.annotations().title.is_empty() && session.annotations().axes);
    // A view that comes with the run brings its own.
    session.adopt(kept.clone());
    assert_eq!((&session.view.path, &session.view.bookmarks), (&kept.path, &kept.bookmarks));
    let mut session = Session::new(kept.clone());
    session.open(run(&["demo:radial:27", "demo:radial:64"]));
    assert_eq!(session.view.path, kept.path);
}

#[test]
fn a_session_goes_on_in_the_size_of_the_window_or_in_its_own() {
    let mut session = shown(&["demo:radial:27"]);
    assert!(session.fits_window);
    let last = |session: &Session, fits_window| LastSession {
        paths: Vec::new(),
        title: String::new(),
        frame: 0,
        view: session.complete_view(),
        fits_window,
        when: 0,
        ended: true,
    };
    let (fitting, own, old) = (last(&session, Some(true)), last(&session, Some(false)), last(&session, None));
    for (kept, room, fits) in [
        (fitting, [800, 600], true),
        (own, ROOM, false),
        (old.clone(), [800, 600], false),
        (old.clone(), ROOM, true),
    ] {
        session = shown(&["demo:checker:27"]);
        session.job(Instant::now(), room);
        session.restore(kept);
        assert_eq!(session.fits_window, fits, "{room:?}");
    }
    // Files of before do not say.
    let mut written = serde_json::to_value(&old).unwrap();
    written.as_object_mut().unwrap().remove("fits_window").unwrap();
    assert_eq!(serde_json::from_value::<LastSession>(written).unwrap().fits_window, None);
}

#[test]
fn what_comes_late_about_the_run_before_is_dropped() {
    let mut session = shown(&["demo:radial:27"]);
    let (late, question) = (picture(&session), session.question().unwrap());
    let begun = session.numbering();
    let failed = Report::Failed { index: 0, numbering: begun, text: "no".into() };
    session.open(run(&["demo:checker:64"]));
    assert!(session.current(late).is_none() && session.current(failed).is_none());
    assert!(!session.bring_up_to_date(begun, &mut [0]));
    settle(&mut session);
    let job = session.job(Instant::now(), ROOM).expect("another picture");
    assert_eq!(job.numbering, session.numbering());
    assert!(session.current(picture(&session)).is_some());
    assert!(session.current(Report::Recovered("lost".into())).is_some(), "that is about no run");
    session.answer(question.answer());
    assert!(session.question().is_some(), "a histogram of another frame is no answer");
}
