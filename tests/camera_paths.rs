//! Pictures of a run along a path of its view, around a turntable, and of every N-th frame.

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
#[expect(dead_code, reason = "no test calls all of it")]
mod program;

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use sphcast::image_file::{Pixels, read};

use files::write_vtk;
use program::{files_in, sphcast};

fn camera(eye: [f64; 3]) -> Value {
    json!({"eye": eye, "target": [0.9, 0, 0], "up": [0, 1, 0], "fov_y_degrees": 40, "near": 1.5, "far": 6})
}

/// A view of which nothing is left open, with `more` in it.
fn write_view(path: &Path, more: Value) {
    let mut view = json!({
        "image": {"width": 40, "height": 30},
        "quantity": {"name": "concentration", "range": [0, 1]},
        "particles": {"support_radius": 0.3},
        "transfer": {"reference_length": 0.1,
                     "points": [{"u": 0, "rgb": [0, 0, 1], "opacity": 0.2}, {"u": 1, "rgb": [1, 0.5, 0], "opacity": 0.6}]},
    });
    view.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    fs::write(path, view.to_string()).unwrap();
}

/// A folder with `run/frame_0.vtk` to `_4`, each longer than the one before.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("run")).unwrap();
    for number in 0..5 {
        write_vtk(&folder.path().join(format!("run/frame_{number}.vtk")), 16 + number, true);
    }
    folder
}

/// The names of the pictures that the program makes in a new folder.
fn render(folder: &Path, out: &str, arguments: &[&str]) -> Vec<String> {
    let pattern = format!("{out}/{{}}.png");
    fs::create_dir_all(folder.join(out)).unwrap();
    let outcome = sphcast(folder, &[&["render", "run", "--out", &pattern], arguments].concat());
    assert_eq!(outcome.status, 0, "{arguments:?}: {}", outcome.err);
    files_in(&folder.join(out))
}

fn picture(folder: &Path, path: &str) -> Pixels {
    let picture = read(&folder.join(path)).unwrap();
    assert!(picture.data.iter().filter(|pixel| pixel[3] > 0.05).count() > 30, "{path} shows something");
    picture
}

/// The largest difference of any channel.
fn difference(a: &Pixels, b: &Pixels) -> f32 {
    let pixels = a.data.iter().zip(&b.data);
    pixels.flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs())).fold(0.0, f32::max)
}

/// What two pictures of one scene may differ by, whose cameras are rounded differently: a step of 8 bits.
const ROUNDING: f32 = 0.02;

#[test]
fn the_camera_goes_from_keyframe_to_keyframe() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let (first, last) = (camera([0.9, 0.5, 3.5]), camera([4.0, 1.0, 1.0]));
    let keys = json!([{"frame": 0, "camera": first}, {"frame": 4, "camera": last}]);
    write_view(&at("path.json"), json!({"path": {"keyframes": keys}}));
    write_view(&at("first.json"), json!({"camera": first}));
    write_view(&at("last.json"), json!({"camera": last}));
    let whole = render(folder.path(), "path", &["--view", "path.json"]);
    assert_eq!(whole, ["0.png", "1.png", "2.png", "3.png", "4.png"]);
    let singly = [("first", "0"), ("last", "4"), ("first", "2"), ("last", "2")];
    let [first, last, from_first, from_last] = singly.map(|(view, frame)| {
        let out = format!("{view}{frame}");
        render(folder.path(), &out, &["--view", &format!("{view}.json"), "--frames", frame]);
        picture(folder.path(), &format!("{out}/{frame}.png"))
    });
    let [on_path @ .., end] = [0, 2, 4].map(|frame| picture(folder.path(), &format!("path/{frame}.png")));
    assert!(difference(&on_path[0], &first) <= ROUNDING && difference(&end, &last) <= ROUNDING);
    for elsewhere in [&from_first, &from_last] {
        assert!(difference(&on_path[1], elsewhere) > 0.1, "in between it is on its way");
    }

    // A part of the run goes along the same path.
    assert_eq!(render(folder.path(), "part", &["--view", "path.json", "--frames", "2.."]), whole[2..]);
    assert_eq!(picture(folder.path(), "part/2.png"), on_path[1]);
}

#[test]
fn a_turntable_goes_around_one_frame() {
    let folder = folder();
    write_view(&folder.path().join("view.json"), json!({"camera": camera([0.9, 0.5, 3.5])}));
    write_view(&folder.path().join("behind.json"), json!({"camera": camera([0.9, 0.5, -3.5])}));
    let around =
        render(folder.path(), "around", &["--view", "view.json", "--frames", "3", "--turntable", "4"]);
    assert_eq!(around, ["0.png", "1.png", "2.png", "3.png"]);
    for (view, number) in [("view", 0), ("behind", 2)] {
        render(folder.path(), view, &["--view", &format!("{view}.json"), "--frames", "3"]);
        let singly = picture(folder.path(), &format!("{view}/3.png"));
        for other in 0..4 {
            let far = difference(&picture(folder.path(), &format!("around/{other}.png")), &singly);
            assert_eq!(far <= ROUNDING, other == number, "{view}: picture {other} is off by {far}");
        }
    }
    let several = sphcast(folder.path(), &["render", "run", "--turntable", "4", "--out", "{}.png"]);
    assert!(
        several.status == 2 && several.err.contains("--turntable: goes around one frame"),
        "{}",
        several.err
    );
}

#[test]
fn every_second_frame_is_the_frame_that_it_is_among_all() {
    let folder = folder();
    write_view(&folder.path().join("view.json"), json!({"camera": camera([0.9, 0.5, 3.5])}));
    render(folder.path(), "all", &["--view", "view.json"]);
    for (out, arguments, names) in [
        ("second", &["--every", "2"][..], &["0.png", "2.png", "4.png"][..]),
        ("odd", &["--every", "2", "--frames", "1.."], &["1.png", "3.png"]),
        ("few", &["--every", "9"], &["0.png"]),
    ] {
        assert_eq!(render(folder.path(), out, &[&["--view", "view.json"], arguments].concat()), names);
        for name in names {
            let [all, some] = ["all", out].map(|folder| format!("{folder}/{name}"));
            assert_eq!(picture(folder.path(), &all), picture(folder.path(), &some));
        }
    }
    assert_ne!(picture(folder.path(), "all/0.png"), picture(folder.path(), "all/4.png"), "frames differ");
    assert_eq!(sphcast(folder.path(), &["render", "run", "--every", "0", "--out", "{}.png"]).status, 2);
}
