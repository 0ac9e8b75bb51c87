//! A run's pictures by several jobs, and by jobs that were cut short.

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
#[expect(dead_code, reason = "no test calls all of it")]
mod program;

use std::fs;
use std::path::Path;
use std::time::SystemTime;

use files::write_vtk;
use program::{Outcome, files_in, sphcast};

/// A folder with a run of `count` frames that grows from frame to frame: every part alone would have
/// another camera in view.
fn growing_run(count: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("run")).unwrap();
    for number in 0..count {
        write_vtk(&folder.path().join(format!("run/frame_{number}.vtk")), 5 + 5 * number, true);
    }
    folder
}

fn render(folder: &Path, arguments: &[&str]) -> Outcome {
    let outcome = sphcast(folder, &[&["render", "run", "--size", "24x16"], arguments].concat());
    assert_eq!(outcome.status, 0, "{arguments:?}: {}", outcome.err);
    outcome
}

fn changed(path: &Path) -> SystemTime {
    path.metadata().unwrap().modified().unwrap()
}

#[test]
fn parts_make_the_pictures_of_the_whole() {
    let folder = growing_run(5);
    let path = |name: &str| folder.path().join(name);
    // Without a field in the first frame, the parts must still agree on what is shown.
    write_vtk(&path("run/frame_0.vtk"), 0, false);
    render(folder.path(), &["--out", "whole"]);
    for shard in ["1/3", "2/3", "3/3"] {
        render(folder.path(), &["--out", "parts", "--shard", shard, "--stats", "stats.json"]);
    }
    assert_eq!(files_in(&path("parts")), files_in(&path("whole")));
    for name in files_in(&path("whole")) {
        let [a, b] = ["whole", "parts"].map(|part| fs::read(path(part).join(&name)).unwrap());
        assert!(a == b, "{name} is not the same picture");
    }
    let frames = |name: &str| -> Vec<u64> {
        let stats: Vec<serde_json::Value> = serde_json::from_slice(&fs::read(path(name)).unwrap()).unwrap();
        stats.iter().map(|entry| entry["frame"].as_u64().unwrap()).collect()
    };
    assert_eq!(frames("stats-1-of-3.json"), [0, 3]);
    assert_eq!(frames("stats-2-of-3.json"), [1, 4]);
    assert_eq!(frames("stats-3-of-3.json"), [2]);
    // More jobs than frames.
    render(folder.path(), &["--out", "none", "--shard", "9/9", "--stats", "stats.json"]);
    assert!(files_in(&path("none")).is_empty() && frames("stats-9-of-9.json").is_empty());
}

#[test]
fn every_other_frame_keeps_its_number() {
    let folder = growing_run(5);
    render(folder.path(), &["--out", "a", "--frames", "1..", "--every", "2"]);
    assert_eq!(files_in(&folder.path().join("a")), ["frame-0001.png", "frame-0003.png"]);
}

#[test]
fn what_is_there_is_left_and_the_rest_is_made() {
    let folder = growing_run(3);
    let path = |name: &str| folder.path().join(name);
    for format in ["png", "exr"] {
        let out = format!("{format}-{{}}.{format}");
        let picture = |number: usize| path(&format!("{format}-{number}.{format}"));
        let resume = |more: &[&str]| render(folder.path(), &[&["--out", &out, "--resume"], more].concat());
        let all = resume(&["--stats", "stats.json"]);
        assert!(!all.err.contains("left as they are"), "{}", all.err);
        let before: Vec<SystemTime> = (0..3).map(|number| changed(&picture(number))).collect();

        fs::remove_file(picture(1)).unwrap();
        // A copy that was cut short has no right to its place.
        let whole = fs::read(picture(2)).unwrap();
        fs::write(picture(2), &whole[..whole.len() / 2]).unwrap();
        let some = resume(&["--stats", "stats.json"]);
        assert!(some.err.contains("note: 1 of 3 pictures were there"), "{}", some.err);
        assert_eq!(changed(&picture(0)), before[0]);
        assert_eq!(fs::read(picture(2)).unwrap(), whole);
        let stats: Vec<serde_json::Value> =
            serde_json::from_slice(&fs::read(path("stats.json")).unwrap()).unwrap();
        assert_eq!(stats.len(), 3, "what was said of the picture that is kept stays");

        let other_view = resume(&["--tolerance", "0.01"]);
        assert!(!other_view.err.contains("left as they are"), "{}", other_view.err);
        // Without --resume all are made anew.
        let anew = render(folder.path(), &["--out", &out, "--tolerance", "0.01"]);
        assert!(!anew.err.contains("left as they are"), "{}", anew.err);
        assert!(resume(&["--tolerance", "0.01"]).err.contains("note: 3 of 3 pictures"));
    }
}

#[test]
fn pictures_with_other_layers_are_made_anew() {
    let folder = growing_run(2);
    let resume = |layers: &[&str]| {
        let arguments = ["--out", "{}.exr", "--tolerance", "0.01", "--resume"];
        render(folder.path(), &[&arguments, layers].concat()).err
    };
    let kept = |said: String| said.contains("note: 2 of 2 pictures");
    let ways: [&[&str]; 4] = [
        &[],
        &["--layers", "depth"],
        &["--layers", "predicted-error"],
        &["--layers", "depth,predicted-error"],
    ];
    for layers in ways {
        assert!(!kept(resume(layers)), "{layers:?} are not what was there");
        assert!(kept(resume(layers)), "{layers:?} are there");
    }
    assert!(kept(resume(&["--layers", "predicted-error,depth"])), "their order is that of the channels");
    for shard in ["1/2", "2/2"] {
        let arguments = ["--out", "part-{}.exr", "--tolerance", "0.01", "--shard", shard];
        render(folder.path(), &[&arguments[..], &["--layers", "depth,predicted-error"]].concat());
    }
    for number in 0..2 {
        let [a, b] = ["", "part-"].map(|part| fs::read(folder.path().join(format!("{part}{number}.exr"))));
        assert!(a.unwrap() == b.unwrap(), "frame {number} is not the same picture");
    }
}

#[test]
fn a_frame_that_has_changed_is_drawn_again() {
    let folder = growing_run(2);
    let view =
        r#"{"camera": {"eye": [0, 0, 9], "target": [0.2, 0, 0]}, "transfer": {"reference_length": 0.1}}"#;
    fs::write(folder.path().join("view.json"), view).unwrap();
    let resume = || render(folder.path(), &["--out", "{}.png", "--view", "view.json", "--resume"]);
    resume();
    assert!(resume().err.contains("note: 2 of 2 pictures"));
    write_vtk(&folder.path().join("run/frame_1.vtk"), 7, true);
    assert!(resume().err.contains("note: 1 of 2 pictures"));
}

#[test]
fn parts_that_cannot_be_are_wrong_arguments() {
    let folder = growing_run(1);
    for shard in ["0/2", "3/2", "1", "a/b"] {
        let outcome = sphcast(folder.path(), &["render", "run", "--out", "a.png", "--shard", shard]);
        assert_eq!(outcome.status, 2, "{shard}: {}", outcome.err);
    }
}
