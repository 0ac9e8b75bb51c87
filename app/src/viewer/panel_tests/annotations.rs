use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{AnnotationsView, Ink, Stats};

use super::transfer::by_density;
use super::{assert_written, fluid, panel, pictured, texts};
use crate::viewer::panels::annotations;
use crate::viewer::session::Session;

fn click(harness: &mut Harness<'_, Session>, label: &str) -> Option<AnnotationsView> {
    harness.get_by_label(label).click();
    harness.run();
    harness.state().view.annotations.clone()
}

#[test]
fn what_is_switched_on_is_saved_with_pictures() {
    let mut harness = panel(fluid(), annotations::show);
    assert_eq!(harness.state().view.annotations, None, "a look at the panel changes nothing");
    let look = click(&mut harness, "Scale bar").unwrap();
    assert!(look.in_pictures && look.scale_bar && look.colour_bar && look.axes && !look.time);
    let look = click(&mut harness, "Without").unwrap();
    assert!(!look.in_pictures && look.scale_bar);
    // From then on the user's choice stands.
    assert!(!click(&mut harness, "Time").unwrap().in_pictures);
    assert!(click(&mut harness, "As shown here").unwrap().in_pictures);
    assert!(harness.state().complete_view().validate().is_ok());
}

#[test]
fn what_is_switched_off_leaves_saved_pictures_alone() {
    let mut harness = panel(fluid(), annotations::show);
    let look = click(&mut harness, "Colour bar").unwrap();
    assert!(!look.colour_bar && !look.in_pictures);
}

#[test]
fn the_opacity_has_a_bar_where_it_has_a_field() {
    let mut harness = panel(fluid(), annotations::show);
    assert!(harness.query_by_label("Opacity bar").is_none());
    harness = panel(by_density(), annotations::show);
    harness.get_by_label("Opacity title").focus();
    harness.run();
    harness.get_by_label("Opacity title").type_text("Density (kg/m³)");
    harness.run();
    assert_eq!(harness.state().annotations().opacity_label, "Density (kg/m³)");
    let look = click(&mut harness, "Opacity bar").unwrap();
    assert!(!look.opacity_bar && look.colour_bar);
    assert!(click(&mut harness, "Opacity bar").unwrap().opacity_bar);
}

#[test]
fn texts_and_units_are_typed() {
    let mut harness = panel(fluid(), annotations::show);
    click(&mut harness, "Time");
    for (label, text) in [("Title", "Dam break"), ("Time unit", "s"), ("Bar title", "Density")] {
        harness.get_by_label(label).focus();
        harness.run();
        harness.get_by_label(label).type_text(text);
        harness.run();
    }
    let look = harness.state().view.annotations.clone().unwrap();
    assert_eq!((&*look.title, &*look.time_unit, &*look.quantity_label), ("Dam break", "s", "Density"));
    assert!(harness.query_by_label("Length unit").is_none(), "there is no length to write it behind");
    assert_eq!(click(&mut harness, "Dark").unwrap().ink, Ink::Dark);
}

#[test]
fn the_picture_is_not_drawn_anew() {
    let session = fluid();
    let before = session.drawn_view();
    let mut harness = panel(session, annotations::show);
    click(&mut harness, "Frame");
    assert_eq!(harness.state().drawn_view(), before);
}

#[test]
fn the_window_shows_them_over_the_picture() {
    let mut session = pictured(fluid(), Stats::default());
    let look = AnnotationsView {
        title: "Block".into(),
        frame_number: true,
        scale_bar: true,
        ..AnnotationsView::of_window()
    };
    session.view.annotations = Some(look);
    let harness = panel(session, |ui, session| {
        let rect = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(290.0, 290.0));
        crate::viewer::picture::annotations::show(ui, session, rect, true);
    });
    assert_written(&harness, &["Block", "frame 0", "velocity", "X", "Y", "Z"]);
    assert!(texts(&harness).iter().any(|text| text.starts_with("at the target's depth, ")));
}
