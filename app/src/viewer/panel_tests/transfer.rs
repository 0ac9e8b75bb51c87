use egui::{Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use renderer::{MapView, TransferView};

use super::fluid;
use crate::viewer::kept::library::Saved;
use crate::viewer::panels::presets::Wish;
use crate::viewer::panels::transfer_edit as edit;
use crate::viewer::panels::transfer_editor::TransferEditor;
use crate::viewer::session::Session;
use crate::viewer::theme;

type Editor = (TransferEditor, Session);

/// The editor in the side panel, with frames that follow one another fast enough for double clicks.
fn editor() -> Harness<'static, Editor> {
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
            (TransferEditor::default(), fluid()),
        );
    harness.run();
    harness
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
