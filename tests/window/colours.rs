//! Transfer functions from files and under names of one's own, and the range over all frames.

use std::path::Path;

use renderer::TransferView;

use crate::dialogs::Zenity;
use crate::files::write_vtk;
use crate::harness::{Window, missing};

fn transfer(window: &mut Window, folder: &Path) -> TransferView {
    TransferView { reference_length: None, ..window.save(folder).1.transfer }
}

fn open_presets(window: &mut Window) {
    window.rest();
    window.click("presets", [0.5, 0.5]);
    window.wait_for_area("import");
    window.rest();
}

#[test]
fn colours_of_paraview_are_imported_saved_under_a_name_and_chosen_again() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let zenity = Zenity::new(folder.path());
    let map = folder.path().join("map.json");
    let text =
        r#"[{"Name": "mine", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 1, 2, 1, 1, 0, 4, 1, 0, 0]}]"#;
    std::fs::write(&map, text).unwrap();
    zenity.choose(&map);
    let mut window = zenity.open(folder.path());
    let before = transfer(&mut window, folder.path());

    open_presets(&mut window);
    window.click("import", [0.5, 0.5]);
    assert!(window.wait_for("imported").ends_with("map.json"));
    let imported = transfer(&mut window, folder.path());
    let colours = imported.map.as_ref().expect("colours of their own").points.clone();
    for (u, rgb) in [(0.0, [0.0, 0.0, 1.0]), (0.5, [1.0, 1.0, 0.0]), (1.0, [1.0, 0.0, 0.0])] {
        assert!(colours.iter().any(|node| (node.u, node.rgb) == (u, rgb)), "{u}: {colours:?}");
    }
    assert_eq!(
        imported.points.iter().map(|point| point.opacity).collect::<Vec<_>>(),
        before.points.iter().map(|point| point.opacity).collect::<Vec<_>>(),
        "opacities stay"
    );

    open_presets(&mut window);
    window.click("preset-name", [0.3, 0.5]);
    window.tool(&["type", "--delay", "60", "mine"]);
    window.key("Return");
    while window.wait_for("functions") != "1" {}
    window.key("Escape");
    window.rest();
    window.key("ctrl+z");
    window.wait_for("undone");
    assert_eq!(transfer(&mut window, folder.path()), before);

    // It is there at the next start, too.
    drop(window);
    let mut window = zenity.open(folder.path());
    open_presets(&mut window);
    window.click("preset", [0.5, 0.5]);
    window.wait_for("picture");
    assert_eq!(transfer(&mut window, folder.path()), imported);
}

#[test]
fn all_frames_are_read_for_their_range_unless_that_is_cancelled() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    std::fs::create_dir(&run).unwrap();
    // So long that there is time to think better of it; the first one is in view.
    for (number, particles) in [(0, 30), (1, 700_000), (2, 700_000), (3, 20)] {
        write_vtk(&run.join(format!("frame_{number}.vtk")), particles, true);
    }
    let mut window = Window::open(folder.path(), &["run", "--size", "120x90"]);
    window.rest();
    let (_, before) = window.save(folder.path());
    window.click("read-all", [0.5, 0.5]);
    window.wait_for_area("cancel-reading");
    window.click("cancel-reading", [0.5, 0.5]);
    window.rest();
    assert!(!window.said.iter().any(|line| line.contains("looked through")), "{:#?}", window.said);
    let (_, cancelled) = window.save(folder.path());
    assert_eq!(cancelled.quantity.range, before.quantity.range);

    window.click("read-all", [0.5, 0.5]);
    window.wait_for("all frames looked through");
    let (_, all) = window.save(folder.path());
    // The frame in view ends at 29/30; those of many particles, closer to 1.
    let high = |range: Option<[f64; 2]>| range.expect("a range")[1];
    assert!(
        high(before.quantity.range) < 0.97 && high(all.quantity.range) > 0.999,
        "{:?}",
        all.quantity.range
    );
}
