//! Tools that point into the picture, and their cards.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use egui::{Modifiers, Rect, Sense, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use renderer::Stats;

use super::{assert_written, fluid, panel, session_over, shown};
use crate::viewer::inspect::pointer;
use crate::viewer::inspect::pointing::Shot;
use crate::viewer::inspect::tracked::{Mark, Tracked};
use crate::viewer::panels::{distance, picked};
use crate::viewer::render_thread::Report;
use crate::viewer::render_thread::prepare::Preparation;
use crate::viewer::session::{End, Session, Tool};

/// Tells the session of a picture, with what it was drawn from.
fn draw(session: &mut Session) {
    let mut picture = shown(session, Stats::default());
    let (index, frame) = session.frame().cloned().unwrap();
    let mut view = session.complete_view();
    (view.image.width, view.image.height) = (64, 64);
    let (scene, _) = Preparation::default().scene(&frame, &view).unwrap();
    let quantity = view.quantity;
    picture.shot = Some(Shot { frame, index, scene: Arc::new(scene), size: [280, 280], quantity });
    session.note(&Report::Picture(Box::new(picture)));
}

/// A picture with a tool in hand, and questions answered as the window does in the background.
fn picture<'a>(tool: Tool) -> Harness<'a, Session> {
    let mut session = fluid();
    session.take_tool(tool);
    draw(&mut session);
    panel(session, move |ui, session| {
        let picture = Rect::from_min_size(pos2(0.0, 0.0), vec2(280.0, 280.0));
        let response = ui.allocate_rect(picture, Sense::click_and_drag());
        pointer::point(ui, &response, picture, session);
        while let Some(question) = session.looking.question() {
            session.take_pointed(question.answer());
        }
        pointer::show(ui, picture, session);
    })
}

fn click(harness: &mut Harness<'_, Session>, [x, y]: [f32; 2]) {
    harness.hover_at(pos2(x, y));
    harness.run();
    harness.drag_at(pos2(x, y));
    harness.run();
    harness.drop_at(pos2(x, y));
    harness.run();
}

#[test]
fn hovering_tells_what_is_seen_and_a_click_picks_the_particle() {
    let mut harness = picture(Tool::Pick);
    harness.hover_at(pos2(140.0, 140.0));
    harness.run();
    let pointed = harness.state().looking.pointed.as_ref().expect("an answer");
    let nearest = pointed.seen.as_ref().expect("the block is seen").near[0];
    assert!(harness.state().looking.picked.is_none());
    click(&mut harness, [140.0, 140.0]);
    let picked = &harness.state().looking.picked.as_ref().expect("a particle").particle;
    assert_eq!(
        (picked.row, picked.mark, picked.position()),
        (nearest.row, Mark::Row(nearest.row), nearest.position)
    );
    // Beside the block is nothing to be picked, and what was stays.
    click(&mut harness, [3.0, 3.0]);
    assert!(harness.state().looking.picked.is_some());
    harness.hover_at(pos2(4.0, 4.0));
    harness.run();
    assert_written(&harness, &["Nothing is to be seen here"]);
}

fn ends(harness: &Harness<Session>) -> Vec<DVec3> {
    harness.state().looking.distance.ends.iter().map(End::position).collect()
}

#[test]
fn two_clicks_measure_and_a_third_begins_anew() {
    let mut harness = picture(Tool::Measure);
    click(&mut harness, [80.0, 140.0]);
    click(&mut harness, [200.0, 150.0]);
    let ends = ends(&harness);
    assert_eq!(ends.len(), 2);
    assert!(ends.iter().all(|end| end.fract() == DVec3::ZERO), "at particles: {ends:?}");
    assert!(ends[0].distance(ends[1]) >= 1.0);
    harness.state_mut().looking.distance.at_particles = false;
    click(&mut harness, [140.0, 140.0]);
    let ends = self::ends(&harness);
    assert!(ends.len() == 1 && ends[0].fract() != DVec3::ZERO, "{ends:?}");
}

#[test]
fn escape_clears_what_was_measured_and_then_puts_the_tool_away() {
    let mut harness = picture(Tool::Measure);
    click(&mut harness, [110.0, 140.0]);
    let session = harness.state_mut();
    session.put_away();
    assert!(session.looking.distance.ends.is_empty() && session.looking.holds(Tool::Measure));
    session.put_away();
    assert_eq!(session.looking.tool, None);
}

#[test]
fn the_card_of_a_particle_has_all_its_values() {
    let mut session = fluid();
    draw(&mut session);
    let (index, frame) = session.frame().cloned().unwrap();
    // x = 3, y = 2, z = 1: density 1020, velocity (0.25, 0, −0.25).
    session.looking.pick(Tracked::new(frame, index, 3 + 4 * 2 + 16));
    let mut harness = panel(session, |ui, session| {
        if session.looking.picked.is_some() {
            picked::card(ui, session);
        }
    });
    assert_written(&harness, &["Row 27", "3", "2", "1", "1020", "0.3536", "0.25  0  -0.25"]);
    harness.get_by_label("Keep in the middle").click();
    harness.run();
    let session = harness.state();
    assert!(session.looking.picked.as_ref().unwrap().in_the_middle);
    assert_eq!(session.complete_view().camera.unwrap().target, DVec3::new(3.0, 2.0, 1.0));
    harness.get_by_label("Close (Escape)").click();
    harness.run();
    assert!(harness.state().looking.picked.is_none());
}

/// Three frames: in the second, particle 2 has gone from y = 0 to 4; in the third, it is gone.
fn moving(folder: &Path) -> Session {
    let file = |name: &str, rows: &str| {
        let path = folder.join(name);
        std::fs::write(&path, format!("id,x,y,z,heat\n{rows}")).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let first = file("f_1.csv", "1,0,0,0,5\n2,1,0,0,6\n3,0,1,1,7\n");
    let second = file("f_2.csv", "3,0,1,1,7\n2,1,4,0,6\n1,0,0,0,5\n");
    let third = file("f_3.csv", "3,0,1,1,7\n1,0,0,0,5\n4,9,9,9,5\n");
    let mut session = session_over(&[&first, &second, &third]);
    draw(&mut session);
    session
}

/// Goes to the next frame. Returns in how many searches all that is followed was looked for.
fn go(session: &mut Session) -> usize {
    session.step(true);
    while session.waiting() {
        session.poll(Instant::now());
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let mut searches = 0;
    while let Some(search) = session.search() {
        session.take_located(&search.locate());
        searches += 1;
    }
    searches
}

#[test]
fn a_followed_particle_is_found_in_the_next_frame_and_the_camera_goes_along() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = moving(folder.path());
    let (index, frame) = session.frame().cloned().unwrap();
    session.looking.pick(Tracked::new(frame, index, 1));
    session.keep_in_the_middle(true);
    let target = |session: &Session| session.complete_view().camera.unwrap().target;
    let now = Instant::now();
    session.remember(now, false);
    assert_eq!(go(&mut session), 1);
    session.remember(now, true);
    session.remember(now, false);
    assert!(!session.can_undo(), "to go along is no step of the user's");
    let picked = session.looking.picked.clone().unwrap().particle;
    assert_eq!((picked.index, picked.row, picked.mark, picked.lost), (1, 1, Mark::Id(2.0), false));
    assert_eq!(target(&session), DVec3::new(1.0, 4.0, 0.0));
    assert_eq!(go(&mut session), 1);
    let picked = session.looking.picked.clone().unwrap().particle;
    assert!(picked.lost && picked.index == 1, "it is shown as it was last");
    assert_eq!(target(&session), DVec3::new(1.0, 4.0, 0.0));
}

#[test]
fn a_particle_that_is_not_followed_is_forgotten_with_its_frame() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = moving(folder.path());
    let (index, frame) = session.frame().cloned().unwrap();
    session.looking.pick(Tracked::new(frame, index, 1));
    session.looking.picked.as_mut().unwrap().follow = false;
    assert_eq!(go(&mut session), 0);
    assert!(session.looking.picked.is_none());
}

#[test]
fn the_ends_of_a_distance_go_where_their_particles_go() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = moving(folder.path());
    let (index, frame) = session.frame().cloned().unwrap();
    let end = |row| End::Particle(Tracked::new(Arc::clone(&frame), index, row));
    session.looking.distance.ends = vec![end(0), end(1)];
    assert_eq!(go(&mut session), 2);
    let mut harness = panel(session, distance::card);
    assert_eq!(ends(&harness), [DVec3::ZERO, DVec3::new(1.0, 4.0, 0.0)]);
    assert_written(&harness, &["4.123", "1", "4", "0"]);
    go(harness.state_mut());
    harness.run();
    assert_written(&harness, &["This frame lacks a particle that the distance was measured from."]);
}

#[test]
fn the_card_of_a_distance_tells_it_along_the_axes() {
    let mut session = fluid();
    session.looking.distance.ends =
        [[1.0, 2.0, 3.0], [1.0, 5.0, -1.0]].map(|place| End::Place(place.into())).into();
    let mut harness = panel(session, distance::card);
    assert_written(&harness, &["5", "0", "3", "-4"]);
    harness.get_by_label("Places").click();
    harness.run();
    assert!(!harness.state().looking.distance.at_particles);
    harness.get_by_label("Close (Escape)").click_modifiers(Modifiers::NONE);
    harness.run();
    assert!(harness.state().looking.distance.ends.is_empty());
    assert_written(&harness, &["Click on one end, and then on the other."]);
}
