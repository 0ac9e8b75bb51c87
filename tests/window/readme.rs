//! The pictures of the window in the README. To make them anew:
//! `cargo test --release -p sphcast-tests --test window readme -- --ignored --test-threads 1`

use std::path::{Path, PathBuf};

use renderer::View;
use sphcast::image_file::{self, Pixels, to_linear};

use crate::harness::{Window, missing};

const SIZE: [u16; 2] = [1280, 800];
const FRAME: usize = 12;

fn assets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets")
}

/// The demo's own view, changed.
fn view(folder: &Path, change: impl FnOnce(&mut View)) -> String {
    let mut view =
        View::from_json(&std::fs::read_to_string(assets().join("demo-view.json")).unwrap()).unwrap();
    // As large as the room beside the panel.
    (view.image.width, view.image.height) = (960, 697);
    change(&mut view);
    let path = folder.join("view.json");
    std::fs::write(&path, view.to_json()).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The window at the size of the README's pictures, at a frame in the middle of the demo.
fn open(folder: &Path, view: &str) -> Window {
    let mut window = Window::open(folder, &["demo", "--view", view]);
    window.resize(SIZE);
    for _ in 0..FRAME {
        window.key("Right");
    }
    window.wait_for(&format!("picture frame={FRAME}"));
    window.wait_for_full_picture();
    window
}

fn save(window: &mut Window, name: &str) {
    window.rest();
    let bytes = window.desktop().resting_pixels([0, 0, SIZE[0], SIZE[1]]);
    let channel = |byte: u8| to_linear(f32::from(byte) / 255.0);
    let pixel = |bgrx: &[u8]| [channel(bgrx[2]), channel(bgrx[1]), channel(bgrx[0]), 1.0];
    let [width, height] = SIZE.map(u32::from);
    let pixels = Pixels { width, height, data: bytes.chunks_exact(4).map(pixel).collect() };
    image_file::write(&assets().join("pictures").join(name), &pixels, None).unwrap();
}

#[test]
#[ignore = "writes the pictures of the README"]
fn the_window_as_it_opens() {
    assert_eq!(missing(), None);
    let folder = tempfile::tempdir().unwrap();
    let mut window = open(folder.path(), &view(folder.path(), |_| {}));
    save(&mut window, "window.png");
}

#[test]
#[ignore = "writes the pictures of the README"]
fn a_run_cut_open() {
    assert_eq!(missing(), None);
    let folder = tempfile::tempdir().unwrap();
    let view = view(folder.path(), |view| {
        let changes = serde_json::json!({
            "camera": {"eye": [1.65, 1.2, 2.2], "target": [0, 0.3, 0], "up": [0, 1, 0], "fov_y_degrees": 32},
            "select": {"plane": {"point": [0, 0.25, 0.05], "normal": [0.25, 0, -1]}},
            "annotations": {"colour_bar": true, "axes": true, "time": true, "scale_bar": true,
                            "title": "Stirred tank, cut open", "length_unit": "m", "time_unit": "s"},
        });
        let changes = View::from_json(&changes.to_string()).unwrap();
        (view.camera, view.select, view.annotations) = (changes.camera, changes.select, changes.annotations);
        let map =
            serde_json::json!({"transfer": {"points": view.transfer.points, "map": {"name": "viridis"}}});
        view.transfer = View::from_json(&map.to_string()).unwrap().transfer;
        for point in &mut view.transfer.points {
            point.opacity = point.opacity.max(0.12);
        }
    });
    let mut window = open(folder.path(), &view);
    window.fold(&["Quantity", "Clip and filter"]);
    save(&mut window, "clip.png");
}

#[test]
#[ignore = "writes the pictures of the README"]
fn what_became_of_the_cells() {
    assert_eq!(missing(), None);
    let folder = tempfile::tempdir().unwrap();
    let view = view(folder.path(), |view| view.sampling.always_adaptive = true);
    let mut window = open(folder.path(), &view);
    window.fold(&["Quantity", "Transfer function"]);
    window.key("c");
    window.wait_for_area("depth");
    window.click("depth", [0.85, 0.5]);
    window.rest();
    window.click("inspect", [0.5, 0.5]);
    window.wait_for("inspect on");
    window.click("picture", [0.72, 0.5]);
    window.wait_for("inspected");
    window.wait_for_area("inspector");
    save(&mut window, "overlay.png");
}
