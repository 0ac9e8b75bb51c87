use egui::{Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{MapView, OpacityView, Scale, TransferView};

use super::{assert_written, count, fluid, session_over, texts};
use crate::viewer::kept::library::Saved;
use crate::viewer::panels::presets::Wish;
use crate::viewer::panels::transfer_edit as edit;
use crate::viewer::panels::transfer_editor::TransferEditor;
use crate::viewer::session::Session;
use crate::viewer::theme;

type Editor = (TransferEditor, Session);

/// The editor in the side panel, with frames that follow one another fast enough for double clicks.
fn editor() -> Harness<'static, Editor> {
    editor_of(fluid())
}

fn editor_of(session: Session) -> Harness<'static, Editor> {
    let width = theme::SIDE_WIDTH - 2.0 * f32::from(theme::MARGIN);
    let mut harness = Harness::builder()
        .with_size(vec2(width, 600.0))
        .with_step_dt(0.02)
        .with_max_steps(50)
        .build_ui_state(
            |ui, (editor, session): &mut Editor| {
                theme::apply(ui.ctx());
                editor.show(ui, session);
            },
            (TransferEditor::default(), session),
        );
    harness.run();
    harness
}

/// A session whose opacities are of the density, from 1000 to 1030, at ratios.
pub fn by_density() -> Session {
    let mut session = fluid();
    let scale = Scale::Log;
    session.view.quantity.opacity = Some(OpacityView { name: Some("density".into()), range: None, scale });
    count(&mut session);
    session
}

/// A place on the canvas, by u and the share of its height, or below it.
fn place(harness: &Harness<'_, Editor>, u: f32, height: f32) -> Pos2 {
    let outer = harness.get_by_label("Transfer function").rect();
    let inner = egui::Rect::from_min_size(outer.min, vec2(outer.width(), 132.0)).shrink(7.0);
    egui::pos2(inner.left() + u * inner.width(), inner.bottom() - height * inner.height())
}

/// The strip of colours.
fn on_strip(harness: &Harness<'_, Editor>, u: f32) -> Pos2 {
    let bottom = harness.get_by_label("Transfer function").rect().bottom();
    egui::pos2(place(harness, u, 0.0).x, bottom - 19.0)
}

fn button(harness: &mut Harness<'_, Editor>, pos: Pos2, button: PointerButton, pressed: bool) {
    harness.event(egui::Event::PointerMoved(pos));
    harness.event(egui::Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
    harness.step();
}

fn click(harness: &mut Harness<'_, Editor>, pos: Pos2, which: PointerButton) {
    button(harness, pos, which, true);
    button(harness, pos, which, false);
}

fn double_click(harness: &mut Harness<'_, Editor>, pos: Pos2) {
    click(harness, pos, PointerButton::Primary);
    click(harness, pos, PointerButton::Primary);
    // Until the next click is no third one.
    harness.run_steps(40);
}

#[test]
fn a_double_click_adds_opacity_on_the_canvas_and_colour_on_the_strip() {
    let mut harness = editor();
    let before = harness.state().1.view.transfer.clone();
    let pos = place(&harness, 0.4, 0.8);
    double_click(&mut harness, pos);
    let transfer = &harness.state().1.view.transfer;
    assert_eq!(transfer.points.len(), before.points.len() + 1);
    let added = transfer.points.iter().find(|point| (point.u - 0.4).abs() < 0.01).unwrap();
    assert!((added.opacity - 0.8).abs() < 0.02);
    let (nodes, colours) = (edit::colour_nodes(transfer).unwrap(), before.colours().unwrap());
    assert_eq!(nodes, colours, "colours stay");
    let pos = on_strip(&harness, 0.4);
    double_click(&mut harness, pos);
    let transfer = &harness.state().1.view.transfer;
    assert_eq!(edit::colour_nodes(transfer).unwrap().len(), nodes.len() + 1);
    assert_eq!(transfer.points.len(), before.points.len() + 1, "opacities stay");
}

#[test]
fn a_node_is_dragged_and_removed() {
    let mut harness = editor();
    let first = harness.state().1.view.transfer.points[1];
    let from = place(&harness, first.u, first.opacity);
    let to = place(&harness, 0.3, 0.6);
    button(&mut harness, from, PointerButton::Primary, true);
    for share in [0.3, 0.6, 1.0] {
        harness.event(egui::Event::PointerMoved(from + share * (to - from)));
        harness.step();
    }
    button(&mut harness, to, PointerButton::Primary, false);
    let moved = harness.state().1.view.transfer.points[1];
    assert!((moved.u - 0.3).abs() < 0.01 && (moved.opacity - 0.6).abs() < 0.02, "{moved:?}");
    harness.run();
    click(&mut harness, to, PointerButton::Secondary);
    harness.run();
    assert_eq!(harness.state().1.view.transfer.points.len(), 4);
}

#[test]
fn with_shift_a_node_moves_a_tenth_of_the_way_and_never_jumps_to_the_mouse() {
    let mut harness = editor();
    let first = harness.state().1.view.transfer.points[1];
    // Not in the node's middle.
    let from = place(&harness, first.u, first.opacity) + vec2(3.0, 3.0);
    let mut modifiers = Modifiers::SHIFT;
    for (step, way) in [0.0_f32, 12.0, 30.0, 60.0].into_iter().enumerate() {
        let pos = from - vec2(0.0, way);
        harness.event(egui::Event::ModifiersChanged(modifiers));
        harness.event(egui::Event::PointerMoved(pos));
        if step == 0 {
            let button = PointerButton::Primary;
            harness.event(egui::Event::PointerButton { pos, button, pressed: true, modifiers });
        }
        harness.step();
    }
    let height = 118.0;
    let moved = harness.state().1.view.transfer.points[1];
    assert_eq!(moved.u, first.u);
    assert!((moved.opacity - first.opacity - 6.0 / height).abs() < 2e-3, "{moved:?}");
    // It goes on from there when Shift is let go.
    modifiers = Modifiers::NONE;
    harness.event(egui::Event::ModifiersChanged(modifiers));
    harness.event(egui::Event::PointerMoved(from - vec2(0.0, 71.8)));
    harness.step();
    let further = harness.state().1.view.transfer.points[1];
    assert!((further.opacity - moved.opacity - 11.8 / height).abs() < 2e-3, "{further:?}");
}

/// Types into the number of that name.
fn enter(harness: &mut Harness<'_, Editor>, label: &str, text: &str) {
    harness.get_by_label(label).click();
    harness.run();
    harness.get_by_label(label).type_text(text);
    harness.key_press(egui::Key::Enter);
    harness.run();
}

#[test]
fn opacities_near_zero_are_entered_and_told_in_all_their_digits() {
    let mut harness = editor();
    let point = harness.state().1.view.transfer.points[2];
    let pos = place(&harness, point.u, point.opacity);
    click(&mut harness, pos, PointerButton::Primary);
    harness.run();
    enter(&mut harness, "Opacity", "3.25e-5");
    assert_eq!(harness.state().1.view.transfer.points[2].opacity, 3.25e-5);
    assert_written(&harness, &["3.25e-5"]);
}

#[test]
fn a_node_of_opacity_has_the_value_of_its_field_and_one_of_colour_that_of_its_own() {
    let mut harness = editor_of(by_density());
    assert_written(&harness, &["Opacity by density", "Colour by velocity", "1000", "1030"]);
    let point = harness.state().1.view.transfer.points[2];
    let pos = place(&harness, point.u, point.opacity);
    click(&mut harness, pos, PointerButton::Primary);
    harness.run();
    // The middle of the ratios.
    enter(&mut harness, "Value", "1010");
    let transfer = harness.state().1.view.transfer.clone();
    let expected = (1010.0_f64 / 1000.0).ln() / (1030.0_f64 / 1000.0).ln();
    assert!((f64::from(transfer.points[2].u) - expected).abs() < 1e-6, "{}", transfer.points[2].u);
    let pos = on_strip(&harness, 0.25);
    click(&mut harness, pos, PointerButton::Primary);
    harness.run();
    let [low, high] = harness.state().1.range().unwrap();
    enter(&mut harness, "Value", &format!("{}", low + 0.4 * (high - low)));
    let colours = edit::colour_nodes(&harness.state().1.view.transfer).unwrap();
    assert!((colours[1].u - 0.4).abs() < 1e-4, "{}", colours[1].u);
    assert_eq!(harness.state().1.view.transfer.points[2].u, transfer.points[2].u);
}

#[test]
fn beyond_the_range_only_colours_are_asked_for_where_the_opacity_has_a_field() {
    for (session, asked) in [(fluid(), 1), (by_density(), 0)] {
        let mut harness = editor_of(session);
        harness.get_by_label("Below range").click();
        harness.run();
        assert_eq!(harness.query_all_by_label("Below range: colour").count(), 1);
        assert_eq!(harness.query_all_by_label("Below range: opacity").count(), asked);
    }
}

#[test]
fn the_histogram_is_of_this_frame_or_of_all_in_memory() {
    let session = session_over(&["demo:radial:8", "demo:radial:64", "demo:radial:1000"]);
    let mut harness = editor_of(session);
    assert!(!harness.state().1.wants_pool);
    harness.get_by_label("Axes").click();
    harness.run();
    harness.get_by_label("All loaded frames").click();
    harness.run();
    assert!(harness.state().1.wants_pool);
    let session = &mut harness.state_mut().1;
    while session.run().unwrap().stream.loaded().len() < 3 {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let mut counted = 0;
    while let Some(question) = session.pool_question() {
        session.pool.take(question.answer());
        counted += 1;
    }
    assert_eq!(counted, 3);
    harness.run();
    assert_written(&harness, &["Histogram of 3 frames"]);
    harness.get_by_label("This frame").click();
    harness.run();
    harness.state_mut().1.wants_pool = false;
    harness.run();
    assert!(!harness.state().1.wants_pool && !texts(&harness).contains(&"Histogram of 3 frames".to_owned()));
}

#[test]
fn one_frame_alone_has_no_choice_of_histograms() {
    let mut harness = editor();
    harness.get_by_label("Axes").click();
    harness.run();
    assert!(harness.query_by_label("Logarithmic counts").is_some());
    assert!(harness.query_by_label("All loaded frames").is_none());
}

#[test]
fn a_map_is_chosen_and_reversed() {
    let mut harness = editor();
    let opacities = |harness: &Harness<'_, Editor>| -> Vec<f32> {
        harness.state().1.view.transfer.points.iter().map(|point| point.opacity).collect()
    };
    let before = opacities(&harness);
    harness.get_by_label("Colours").click();
    harness.run();
    harness.get_by_label("batlow").click();
    harness.run();
    let map = harness.state().1.view.transfer.map.clone().unwrap();
    assert_eq!((map.name.as_deref(), map.reversed), (Some("batlow"), false));
    harness.get_by_label("Reverse the colours").click();
    harness.run();
    assert!(harness.state().1.view.transfer.map.as_ref().unwrap().reversed);
    assert_eq!(opacities(&harness), before);
}

#[test]
fn what_lies_outside_gets_a_colour_of_its_own() {
    let mut harness = editor();
    harness.get_by_label("Above range").click();
    harness.run();
    let quantity = &harness.state().1.view.quantity;
    let end = harness.state().1.view.transfer.points[4];
    assert_eq!(quantity.above.map(|above| (above.rgb, above.opacity)), Some((end.rgb, end.opacity)));
    assert_eq!(quantity.below, None);
    assert!(harness.state().1.view.validate().is_ok());
}

#[test]
fn the_selected_node_has_numbers() {
    let mut harness = editor();
    assert!(harness.query_by_label("Opacity").is_none());
    let point = harness.state().1.view.transfer.points[2];
    let pos = place(&harness, point.u, point.opacity);
    click(&mut harness, pos, PointerButton::Primary);
    harness.run();
    for label in ["Value", "u", "Opacity"] {
        assert!(harness.query_all_by_label(label).count() >= 1, "{label}");
    }
    harness.get_by_label("Remove").click();
    harness.run();
    assert_eq!(harness.state().1.view.transfer.points.len(), 4);
}

#[test]
fn presets_are_saved_chosen_and_deleted() {
    let mut harness = editor();
    let mine = TransferView { map: Some(MapView::named("oslo")), ..TransferView::default() };
    harness.state_mut().0.presets.saved = vec![Saved { name: "mine".into(), transfer: mine.clone() }];
    harness.run();
    harness.get_by_label("Presets").click();
    harness.run();
    harness.get_by_label("Delete mine").click();
    harness.run();
    harness.get_by_label("Name of the preset").click();
    harness.run();
    harness.get_by_label("Name of the preset").type_text("fog");
    harness.run();
    harness.get_by_label("Save").click();
    harness.run();
    let wishes = &mut harness.state_mut().0.presets.wishes;
    assert_eq!(std::mem::take(wishes), [Wish::Delete("mine".into()), Wish::Save("fog".into())]);
    harness.get_by_label("mine").click();
    harness.run();
    assert_eq!(harness.state().1.view.transfer, mine);
    harness.get_by_label("Presets").click();
    harness.run();
    harness.get_by_label("Export for ParaView…").click();
    harness.run();
    assert_eq!(harness.state().0.presets.wishes, [Wish::Export]);
}
