use std::sync::Arc;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use renderer::{SelectView, Stats};

use super::{assert_written, fluid, panel, shown};
use crate::viewer::analysis::field_ranges::FieldRanges;
use crate::viewer::panels::selection;
use crate::viewer::render_thread::Report;
use crate::viewer::session::Session;

/// Tells the session of a picture of its view.
fn draw(session: &mut Session) {
    let picture = shown(session, Stats::default());
    session.note(&Report::Picture(Box::new(picture)));
    let (_, frame) = session.frame().unwrap();
    session.field_ranges = Some(FieldRanges::find(Arc::clone(frame)));
}

fn section<'a>() -> Harness<'a, Session> {
    let mut handles = true;
    let mut session = fluid();
    draw(&mut session);
    panel(session, move |ui, session| selection::show(ui, session, &mut handles))
}

fn click(harness: &mut Harness<Session>, name: &str) -> SelectView {
    harness.get_by_label(name).click();
    harness.run();
    harness.state().view.select.clone()
}

fn write(harness: &mut Harness<Session>, name: &str, number: &str) {
    harness.get_by_label(name).click();
    harness.run();
    harness.get_by_label(name).type_text(number);
    harness.key_press(egui::Key::Enter);
    harness.run();
}

#[test]
fn a_box_fits_the_scene_until_a_number_is_written() {
    let mut harness = section();
    let select = click(&mut harness, "+ Box");
    let scene = harness.state().scene_bounds().unwrap();
    let clip = select.clip_box.unwrap();
    assert_eq!((clip.min, clip.max, clip.on, clip.invert), (scene.min, scene.max, true, false));
    write(&mut harness, "Box Y to", "1.5");
    write(&mut harness, "Box turned about Z", "30");
    let clip = harness.state().view.select.clip_box.unwrap();
    assert_eq!((clip.max.y, clip.min), (1.5, scene.min));
    assert_eq!(clip.rotation_degrees, DVec3::new(0.0, 0.0, 30.0));
    assert!(click(&mut harness, "Invert Box").clip_box.unwrap().invert);
    let fitted = click(&mut harness, "Fit to the scene").clip_box.unwrap();
    assert_eq!((fitted.max, fitted.rotation_degrees), (scene.max, DVec3::ZERO));
    assert_eq!(click(&mut harness, "Remove Box").clip_box, None);
}

#[test]
fn an_end_that_is_written_past_the_other_carries_it_along() {
    let mut harness = section();
    click(&mut harness, "+ Box");
    write(&mut harness, "Box X from", "99");
    let clip = harness.state().view.select.clip_box.unwrap();
    assert_eq!((clip.min.x, clip.max.x), (99.0, 99.0));
    assert!(harness.state().view.validate().is_ok());
}

#[test]
fn a_plane_stands_across_an_axis_and_is_flipped() {
    let mut harness = section();
    let select = click(&mut harness, "+ Plane");
    let middle = harness.state().scene_bounds().unwrap().centre();
    let clip = select.clip_plane.unwrap();
    // From the front right: what is before the middle is cut away.
    assert_eq!((clip.point, clip.normal), (middle, DVec3::NEG_Z));
    assert_eq!(click(&mut harness, "Y").clip_plane.unwrap().normal, DVec3::Y);
    assert_eq!(click(&mut harness, "Flip").clip_plane.unwrap().normal, DVec3::NEG_Y);
    write(&mut harness, "Point of the plane Y", "0.5");
    assert_eq!(harness.state().view.select.clip_plane.unwrap().point.y, 0.5);
    write(&mut harness, "Normal of the plane Y", "0");
    let normal = harness.state().view.select.clip_plane.unwrap().normal;
    assert_eq!(normal, DVec3::NEG_Y, "a plane without a direction is none");
    assert_eq!(click(&mut harness, "Remove Plane").clip_plane, None);
}

#[test]
fn a_filter_begins_with_the_quantity_in_view_and_takes_another_field() {
    let mut harness = section();
    let select = click(&mut harness, "+ Filter");
    assert_eq!((select.filters[0].field.as_str(), select.filters.len()), ("velocity", 1));
    let all = select.filters[0].range;
    assert_eq!(Some(all), harness.state().analysis.as_ref().unwrap().colour.extremes);
    click(&mut harness, "Field of Filter 1");
    let select = click(&mut harness, "density");
    assert_eq!((select.filters[0].field.as_str(), select.filters[0].range), ("density", [1000.0, 1030.0]));
    write(&mut harness, "Filter 1 to", "1015");
    assert_eq!(harness.state().view.select.filters[0].range, [1000.0, 1015.0]);

    draw(harness.state_mut());
    harness.run();
    assert_written(&harness, &["32 of 64"]);
    click(&mut harness, "Invert Filter 1");
    assert!(click(&mut harness, "Remove all").is_empty());
}
