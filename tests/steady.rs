//! Films whose colours mean the same in every frame.

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
#[expect(dead_code, reason = "no test calls all of it")]
mod program;

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use sphcast::image_file::{Pixels, read};

use program::sphcast;

/// Three frames of two particles, whose heat grows, with a view that leaves its range open and one that has
/// the whole of it.
fn folder(opacity: bool) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("run")).unwrap();
    for (number, [a, b]) in [[1.0, 2.0], [2.0, 4.0], [3.0, 10.0]].into_iter().enumerate() {
        let rows = format!("x,y,z,heat,glow\n-0.5,0,0,{a},{b}\n0.5,0,0,{b},{a}\n");
        fs::write(folder.path().join(format!("run/f_{number}.csv")), rows).unwrap();
    }
    let view = |range: Value| {
        let mut quantity = json!({"name": "heat", "range": range});
        if opacity {
            quantity["opacity"] = json!({"name": "glow", "range": range});
        }
        json!({
            "camera": {"eye": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0], "fov_y_degrees": 40, "near": 3, "far": 7},
            "image": {"width": 32, "height": 24},
            "quantity": quantity,
            "particles": {"support_radius": 0.8},
            "transfer": {"reference_length": 0.5,
                         "points": [{"u": 0, "rgb": [0, 0, 1], "opacity": 0.1}, {"u": 1, "rgb": [1, 0.5, 0], "opacity": 0.8}]},
        })
    };
    for (name, range) in [("open", Value::Null), ("whole", json!([1, 10]))] {
        fs::write(folder.path().join(format!("{name}.json")), view(range).to_string()).unwrap();
    }
    folder
}

/// The pictures of the run.
fn render(folder: &Path, view: &str, more: &[&str]) -> Vec<Pixels> {
    let out = format!("{view}{}", more.concat());
    let pattern = format!("{out}-{{}}.exr");
    let usual = ["render", "run", "--view", &format!("{view}.json"), "--out", &pattern];
    let outcome = sphcast(folder, &[&usual, more].concat());
    assert_eq!(outcome.status, 0, "{more:?}: {}", outcome.err);
    assert_eq!(outcome.err.contains("--steady keeps"), view == "open" && !more.contains(&"--steady"));
    (0..3).map(|number| read(&folder.join(format!("{out}-{number}.exr"))).unwrap()).collect()
}

#[test]
fn steady_pictures_are_those_of_the_range_of_all_frames() {
    for opacity in [false, true] {
        let folder = folder(opacity);
        let wanted = render(folder.path(), "whole", &[]);
        let steady = render(folder.path(), "open", &["--steady"]);
        assert_eq!(steady, wanted, "opacity of its own: {opacity}");
        let each = render(folder.path(), "open", &[]);
        assert!((0..3).all(|number| each[number] != wanted[number]), "ranges of their own differ");
    }
}

#[test]
fn parts_of_a_steady_film_span_the_values_of_the_whole_run() {
    let folder = folder(false);
    let wanted = render(folder.path(), "whole", &[]);
    let part = ["render", "run", "--view", "open.json", "--out", "part-{}.exr", "--steady", "--shard", "2/3"];
    assert_eq!(sphcast(folder.path(), &part).status, 0);
    assert_eq!(read(&folder.path().join("part-1.exr")).unwrap(), wanted[1]);
}

#[test]
fn a_range_of_the_view_stays() {
    let folder = folder(false);
    let wanted = render(folder.path(), "whole", &[]);
    let view = fs::read_to_string(folder.path().join("whole.json")).unwrap().replace("[1,10]", "[1,4]");
    fs::write(folder.path().join("narrow.json"), view).unwrap();
    let narrow = render(folder.path(), "narrow", &[]);
    assert_ne!(narrow, wanted);
    assert_eq!(render(folder.path(), "narrow", &["--steady"]), narrow);
}
