use egui::{Rect, Sense, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{ClipBox, ClipPlane, Stats};

use super::{fluid, panel, pictured};
use crate::viewer::picture::handles::Handles;
use crate::viewer::session::Session;

/// A picture with its handles, over a ground that feels every drag past them.
fn picture<'a>(session: Session) -> Harness<'a, (Session, f32)> {
    let mut handles = Handles::default();
    panel((session, 0.0), move |ui, (session, dragged)| {
        let picture = Rect::from_min_size(pos2(0.0, 0.0), vec2(280.0, 280.0));
        *dragged += ui.allocate_rect(picture, Sense::click_and_drag()).drag_delta().length();
        handles.show(ui, picture, session);
    })
}

fn drag(harness: &mut Harness<'_, (Session, f32)>, name: &str, way: egui::Vec2) {
    let from = harness.get_by_label(name).rect().center();
    harness.drag_at(from);
    harness.run();
    for step in 1..=4 {
        harness.hover_at(from + way * (step as f32 / 4.0));
        harness.run();
    }
    harness.drop_at(from + way);
    harness.run();
}

#[test]
fn a_side_of_the_box_is_dragged_and_the_camera_stays() {
    let mut session = pictured(fluid(), Stats::default());
    let scene = session.scene_bounds().unwrap();
    let clip = ClipBox {
        min: scene.min,
        max: scene.max,
        rotation_degrees: Default::default(),
        invert: false,
        on: true,
    };
    session.view.select.clip_box = Some(clip);
    let mut harness = picture(session);
    drag(&mut harness, "Box side +Y", vec2(3.0, 40.0));
    let (session, dragged) = harness.state();
    let found = session.view.select.clip_box.unwrap();
    assert!(found.max.y < clip.max.y - 0.2, "{found:?}");
    assert_eq!(ClipBox { max: clip.max, ..found }, clip, "only that side");
    assert_eq!(*dragged, 0.0);
}

#[test]
fn the_arrow_of_the_plane_moves_and_turns_it() {
    let mut session = pictured(fluid(), Stats::default());
    let point = session.scene_bounds().unwrap().centre();
    let clip = ClipPlane { point, normal: -glam::DVec3::Y, invert: false, on: true };
    session.view.select.clip_plane = Some(clip);
    let mut harness = picture(session);
    drag(&mut harness, "Foot of the plane's arrow", vec2(0.0, 30.0));
    let moved = harness.state().0.view.select.clip_plane.unwrap();
    assert!(moved.point.y < point.y - 0.1 && moved.normal == clip.normal, "{moved:?}");
    drag(&mut harness, "Tip of the plane's arrow", vec2(20.0, 0.0));
    let turned = harness.state().0.view.select.clip_plane.unwrap();
    assert!(turned.normal.y > -0.99 && turned.normal.is_normalized(), "{turned:?}");
}

#[test]
fn without_a_clip_that_is_on_there_are_no_handles() {
    let mut session = pictured(fluid(), Stats::default());
    let point = session.scene_bounds().unwrap().centre();
    session.view.select.clip_plane = Some(ClipPlane { point, normal: point, invert: false, on: false });
    assert!(picture(session).query_by_label("Foot of the plane's arrow").is_none());
}
