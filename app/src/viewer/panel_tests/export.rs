use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use super::{frame_arrives, panel, session_over};
use crate::export::Layer;
use crate::export::video::VideoFormat;
use crate::image_file::Format;
use crate::viewer::exports::{Exports, Plan, State};
use crate::viewer::panels::export::{ExportForm, Kind};
use crate::viewer::panels::export_queue;
use crate::viewer::session::Session;
use crate::viewer::theme;

fn form() -> Harness<'static, (ExportForm, Session)> {
    let session = session_over(&["demo"]);
    let mut form = ExportForm::new(&session);
    form.folder = "out".into();
    // As wide as the window, which is no part of the side panel.
    let builder = Harness::builder().with_size(egui::vec2(420.0, 500.0));
    let mut harness = builder.build_ui_state(
        |ui, (form, session): &mut (ExportForm, Session)| {
            theme::apply(ui.ctx());
            form.fields(ui, session, &mut Vec::new());
        },
        (form, session),
    );
    harness.run();
    harness
}

fn plan(harness: &Harness<(ExportForm, Session)>) -> Plan {
    let (form, session) = harness.state();
    form.plan(session).expect("there is a run, a folder and a name")
}

fn click(harness: &mut Harness<(ExportForm, Session)>, name: &str) {
    harness.get_by_label(name).click();
    harness.run();
}

#[test]
fn a_run_is_a_sequence_of_numbered_pictures_at_first() {
    let harness = form();
    let plan = plan(&harness);
    assert_eq!((plan.first, plan.last, plan.every), (0, 26, 1));
    assert_eq!(plan.path, std::path::Path::new("out/frame-{:04}.png"));
    assert!(plan.resumes && plan.layers.is_empty() && plan.view_file.is_none());
}

#[test]
fn what_is_clicked_is_what_is_exported() {
    let mut harness = form();
    click(&mut harness, "EXR");
    assert_eq!(harness.state().0.format, Format::Exr);
    assert!(plan(&harness).layers.is_empty(), "none unless asked for");
    click(&mut harness, "Predicted error of each pixel");
    assert_eq!(plan(&harness).layers, [Layer::PredictedError]);
    click(&mut harness, "Depth of each pixel");
    click(&mut harness, "view.json");
    click(&mut harness, "Keep pictures that are done");
    let sequence = plan(&harness);
    assert_eq!(sequence.path, std::path::Path::new("out/frame-{:04}.exr"));
    assert_eq!(sequence.layers, [Layer::Depth, Layer::PredictedError]);
    assert_eq!(sequence.view_file.as_deref(), Some("out/frame.view.json".as_ref()));
    assert!(!sequence.resumes);

    click(&mut harness, "Video");
    assert_eq!(harness.state().0.kind, Kind::Video);
    click(&mut harness, "WebM");
    assert_eq!(harness.state().0.video, VideoFormat::WebM);
    let video = plan(&harness);
    assert_eq!(video.path, std::path::Path::new("out/film.webm"));
    assert!(video.layers.is_empty(), "a video has none");

    let session = &mut harness.state_mut().1;
    session.jump(7);
    frame_arrives(session);
    click(&mut harness, "Picture");
    let picture = plan(&harness);
    assert_eq!((picture.first, picture.last), (7, 7));
    assert!(picture.in_memory.is_some(), "it is not read again");
    assert_eq!(picture.path, std::path::Path::new("out/sphcast-0007.exr"));
}

#[test]
fn the_depth_says_what_it_is_and_what_it_costs() {
    let mut harness = form();
    assert!(harness.query_by_label("Depth of each pixel").is_none(), "a PNG holds none");
    click(&mut harness, "EXR");
    harness.get_by_label("Depth of each pixel").hover();
    harness.run();
    for said in ["As channel Z", "along the camera's axis", "once more in full"] {
        assert!(harness.query_by_label_contains(said).is_some(), "{said}");
    }
}

#[test]
fn without_a_name_there_is_nothing_to_export() {
    let mut harness = form();
    harness.state_mut().0.name = "  ".into();
    let (form, session) = harness.state();
    assert!(form.plan(session).is_none());
}

#[test]
fn a_picture_of_the_view_is_as_it_is_seen() {
    let mut session = session_over(&["demo"]);
    session.jump(3);
    frame_arrives(&mut session);
    session.view.path.revolutions = 1.0;
    let mut exports = Exports::new(std::sync::Arc::new(|| {}));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("{mine}.png");
    session.view.image.width = 32;
    session.view.image.height = 24;
    session.fits_window = false;
    exports.add(Plan::in_view(&session, path.clone()).unwrap());
    let first = exports.first_pending().unwrap();
    assert!(first.plan.view.path.is_empty(), "the camera stays where it is");
    let limit = std::time::Instant::now() + std::time::Duration::from_secs(60);
    while exports.pending() > 0 {
        assert!(std::time::Instant::now() < limit);
        exports.poll(&Default::default());
    }
    let [export] = exports.list.as_slice() else { panic!("one export") };
    assert!(matches!(&export.state, State::Done(summary) if summary.frames == 1));
    assert!(export.plan.in_memory.is_none(), "the memory is free again");
    assert_eq!(crate::image_file::read(&path).unwrap().width, 32);
}

#[test]
fn an_export_is_cancelled_resumed_and_removed() {
    let (form, session) = form_and_session();
    let mut exports = Exports::new(std::sync::Arc::new(|| {}));
    exports.add(form.plan(&session).unwrap());
    let mut harness = panel(exports, export_queue::show);
    harness.get_by_label("Cancel frame-{:04}.png").click();
    harness.run();
    assert_eq!(harness.state().pending(), 0);
    harness.get_by_label("Resume frame-{:04}.png").click();
    harness.run();
    assert_eq!(harness.state().pending(), 1);
    harness.get_by_label("Cancel frame-{:04}.png").click();
    harness.run();
    harness.get_by_label("Remove frame-{:04}.png").click();
    harness.run();
    assert!(harness.state().list.is_empty());
}

fn form_and_session() -> (ExportForm, Session) {
    let session = session_over(&["demo"]);
    (ExportForm::new(&session), session)
}
