//! The program as its users call it: arguments in; files, messages and exit status out.

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
mod program;

use std::fs;
use std::process::{Command, Stdio};

use program::{files_in, folder, program, sphcast};

#[test]
fn a_reader_who_leaves_is_no_error() {
    let folder = folder();
    let mut command = Command::new(program());
    command.args(["info", "one.vtk"]).current_dir(&folder).env("XDG_RUNTIME_DIR", folder.path());
    let mut reading = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(reading.stdout.take());
    let output = reading.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn every_command_has_help_with_an_example() {
    let folder = folder();
    let commands = ["render", "bench", "info", "compare"].map(|command| vec![command, "--help"]);
    for command in commands.iter().map(Vec::as_slice).chain([&["--help"][..]]) {
        let help = sphcast(folder.path(), command);
        assert_eq!(help.status, 0);
        assert!(help.out.contains("Example") && help.out.contains("  sphcast "), "{command:?}: {}", help.out);
    }
    assert!(sphcast(folder.path(), &["--version"]).out.starts_with("sphcast "));
}

/// More particles than the least memory holds at a time.
#[test]
fn device_memory_can_be_limited() {
    let folder = folder();
    let render = |out: &str, more: &[&str]| {
        let stats = format!("{out}.json");
        let mut arguments = vec!["render", "demo:radial:1300000", "--size", "160x120", "--out", out];
        arguments.extend(["--stats", &stats].iter().chain(more));
        let run = sphcast(folder.path(), &arguments);
        assert_eq!(run.status, 0, "{}", run.err);
        let stats = fs::read_to_string(folder.path().join(stats)).unwrap();
        serde_json::from_str::<serde_json::Value>(&stats).unwrap()["gpu_bytes"].as_u64().unwrap()
    };
    let [much, little] = [render("much.png", &[]), render("little.png", &["--device-memory", "64"])];
    assert!(little <= 64 << 20 && much > 64 << 20, "{little} and {much} bytes");
    let same = sphcast(folder.path(), &["compare", "much.png", "little.png"]);
    assert_eq!(same.status, 0, "{}{}", same.out, same.err);
}

#[test]
fn wrong_arguments_give_status_2() {
    let folder = folder();
    for arguments in [
        &["render", "one.vtk"][..],
        &["render", "--out", "a.png"],
        &["render", "one.vtk", "--out", "a.png", "--size", "0x5"],
        &["render", "one.vtk", "--out", "a.png", "--tolerance", "nan"],
        &["render", "one.vtk", "--out", "a.png", "--relaxation", "2"],
        &["render", "one.vtk", "--out", "a.png", "--kernel", "gauss"],
        &["render", "one.vtk", "--out", "a.png", "--support-radius", "-1"],
        &["render", "one.vtk", "--out", "a.png", "--frames", "5..2"],
        &["render", "one.vtk", "--out", "a.png", "--frames", "0..2"],
        &["render", "one.vtk", "--out", "a.jpg"],
        &["render", "one.vtk", "--out", "a.png", "--device-memory", "1"],
        &["render", "one.vtk", "--out", "a.png", "--overlay", "b.exr"],
        &["render", "one.vtk", "--out", "a.png", "--overlay", "a.png"],
        &["render", "run", "--out", "pictures", "--overlay", "b.png"],
        &["render", "run", "--out", "a.png"],
        &["bench", "one.vtk", "--tolerances", "0.1,2"],
        &["bench", "one.vtk", "--rounds", "0"],
        &["bench", "one.vtk", "--frames", "0..2"],
        &["info"],
        &["compare", "a.png"],
        &["--follow", "one.vtk"],
        &["--follow", "demo"],
        &["--follow"],
        &["--no-such-flag"],
    ] {
        let outcome = sphcast(folder.path(), arguments);
        assert_eq!(outcome.status, 2, "{arguments:?}: {}", outcome.err);
        assert!(outcome.err.starts_with("error: "), "{arguments:?}: {}", outcome.err);
    }
    assert_eq!(files_in(folder.path()), ["one.vtk", "run"]);
}

#[test]
fn failures_give_status_1_and_one_line_that_names_the_file() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("typo.json", "{\n  \"kamera\": {}\n}");
    write("range.json", r#"{"camera": {"eye": [0, 0, 0], "target": [0, 0, 0]}}"#);
    write("bound.json", r#"{"sampling": {"bound": "tight"}}"#);
    write("broken.json", "{\n");
    write("a.png", "no picture");
    let cases: [(&[&str], &str); 11] = [
        (&["--follow", "nowhere"], "nowhere: no such file or directory"),
        (&["info", "no.vtk"], "no.vtk: no such file or directory"),
        (&["info", "demo:cube:5"], "demo:cube:5: there is no demo `cube`"),
        (&["info", "run/frame_2.vtk"], "run/frame_2.vtk: "),
        (&["info", "*.bgeo"], "*.bgeo: matches no file"),
        (&["render", "one.vtk", "--out", "o.png", "--view", "no.json"], "no.json: "),
        (
            &["render", "one.vtk", "--out", "o.png", "--view", "typo.json"],
            "typo.json: unknown field `kamera`",
        ),
        (&["render", "one.vtk", "--out", "o.png", "--view", "range.json"], "range.json: camera.target: "),
        (
            &["render", "one.vtk", "--out", "o.png", "--view", "bound.json"],
            "bound.json: sampling.bound: unknown bound `tight`",
        ),
        (&["render", "one.vtk", "--out", "o.png", "--view", "broken.json"], "broken.json: "),
        (&["compare", "a.png", "a.png"], "a.png: "),
    ];
    for (arguments, expected) in cases {
        let outcome = sphcast(folder.path(), arguments);
        assert_eq!(outcome.status, 1, "{arguments:?}: {}", outcome.err);
        assert!(outcome.error().starts_with(expected), "{arguments:?}: {}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    }
    let typo = sphcast(folder.path(), &["render", "one.vtk", "--out", "o.png", "--view", "typo.json"]);
    assert!(typo.error().ends_with(": line 2, column 10"), "{}", typo.err);
}

#[test]
fn info_tells_what_is_in_a_frame() {
    let folder = folder();
    let text = sphcast(folder.path(), &["info", "one.vtk"]);
    assert_eq!(text.status, 0, "{}", text.err);
    for part in [
        "particles       20",
        "spacing         0.1 ",
        "support radius  0.2 (estimated",
        "concentration 0 to 0.95",
    ] {
        assert!(text.out.contains(part), "{part} in {}", text.out);
    }
    let json = sphcast(folder.path(), &["info", "one.vtk", "--json"]);
    let info: serde_json::Value = serde_json::from_str(&json.out).unwrap();
    assert_eq!(info["particles"], 20);
    assert_eq!(info["fields"][0]["name"], "concentration");
    assert_eq!(info["fields"][0]["non_finite"], 0);
}

#[test]
fn info_goes_on_after_a_bad_frame() {
    let folder = folder();
    let run = sphcast(folder.path(), &["info", "run", "--json"]);
    assert_eq!(run.status, 1);
    let infos: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(infos.as_array().unwrap().len(), 2);
    assert!(run.err.starts_with("warning: run/frame_2.vtk: "), "{}", run.err);
    assert!(run.error().starts_with("run/frame_2.vtk: "));
    let one = sphcast(folder.path(), &["info", "run", "--frames", "2..3", "--json"]);
    assert_eq!(one.status, 0, "{}", one.err);
    assert!(one.out.contains("frame_3.vtk"));
}

#[test]
fn a_frame_becomes_a_picture_of_either_format() {
    let folder = folder();
    let render = |out: &str, more: &[&str]| {
        let arguments = [&["render", "demo:radial:1000", "--size", "64x48", "--out", out], more].concat();
        let outcome = sphcast(folder.path(), &arguments);
        assert_eq!(outcome.status, 0, "{}", outcome.err);
    };
    render("a.exr", &["--stats", "a.json"]);
    render("b.exr", &["--tolerance", "off"]);
    render("a.png", &[]);
    render("c.exr", &["--support-radius", "0.3", "--kernel", "cubic"]);
    let stats: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("a.json")).unwrap()).unwrap();
    assert_eq!(stats["particles"], 1000);
    assert!(stats["milliseconds"]["total"].as_f64().unwrap() > 0.0);
    assert_eq!(image::open(folder.path().join("a.png")).unwrap().to_rgba8().dimensions(), (64, 48));

    let compare = |b: &str, more: &[&str]| sphcast(folder.path(), &[&["compare", "a.exr", b], more].concat());
    assert_eq!(compare("b.exr", &["--fail-above", "0.004"]).status, 0);
    // Eight bits are near, but not the same; another radius is far.
    assert_eq!(compare("a.png", &["--fail-above", "0.02"]).status, 0);
    let other = compare("c.exr", &["--fail-above", "0.01"]);
    assert_eq!(other.status, 1);
    assert!(other.error().starts_with("a.exr: differs by "), "{}", other.err);
    assert!(other.out.starts_with("max   0."), "{}", other.out);
    assert_eq!(compare("c.exr", &[]).status, 0);
}

#[test]
fn the_classes_of_the_cells_are_a_picture_of_their_own() {
    let folder = folder();
    let render = |out: &str, more: &[&str]| {
        let arguments = ["render", "one.vtk", "--size", "150x120", "--tolerance", "0.01", "--out", out];
        let outcome = sphcast(folder.path(), &[&arguments, more].concat());
        assert_eq!(outcome.status, 0, "{}", outcome.err);
        sphcast::image_file::read(&folder.path().join(out)).unwrap()
    };
    let plain = render("a.png", &[]);
    let beside = render("b.png", &["--overlay", "cells.png", "--stats", "b.json"]);
    assert_eq!(plain, beside, "the picture itself is the same");
    let cells = sphcast::image_file::read(&folder.path().join("cells.png")).unwrap();
    assert_eq!((cells.width, cells.height), (150, 120));
    // Covered where there are particles, and as it was elsewhere.
    let seen = plain.data.iter().filter(|pixel| pixel[3] > 0.1).count();
    let pairs = || plain.data.iter().zip(&cells.data);
    let covered = pairs().filter(|(before, after)| before != after && after[3] > 0.6).count();
    let untouched = pairs().filter(|(before, after)| before == after).count();
    assert!(covered > seen / 2 && untouched > 100, "{seen} seen, {covered} covered, {untouched} untouched");
}

#[test]
fn a_run_has_an_overlay_for_each_of_its_pictures() {
    let folder = folder();
    let arguments = ["render", "run", "--size", "32x32", "--out", "out", "--overlay", "cells-{:02}.png"];
    let outcome = sphcast(folder.path(), &arguments);
    assert_eq!(outcome.status, 1, "a frame of it is bad: {}", outcome.err);
    assert_eq!(files_in(&folder.path().join("out")), ["frame-0000.png", "frame-0002.png"]);
    let here = files_in(folder.path());
    assert_eq!(here, ["cells-00.png", "cells-02.png", "one.vtk", "out", "run"]);
    let nowhere = sphcast(
        folder.path(),
        &["render", "one.vtk", "--size", "32x32", "--out", "c.png", "--overlay", "no/c.png"],
    );
    assert_eq!(nowhere.status, 1);
    assert!(nowhere.error().starts_with("no/c.png: cannot be written"), "{}", nowhere.err);
}

#[test]
fn pictures_of_two_sizes_cannot_be_compared() {
    let folder = folder();
    image::RgbaImage::new(4, 4).save(folder.path().join("a.png")).unwrap();
    image::RgbaImage::new(4, 5).save(folder.path().join("b.png")).unwrap();
    let outcome = sphcast(folder.path(), &["compare", "a.png", "b.png"]);
    assert_eq!(outcome.status, 1);
    assert_eq!(outcome.error(), "a.png: is 4 x 4 pixels, b.png is 4 x 5");
}

#[test]
fn a_run_goes_on_after_a_bad_frame() {
    let folder = folder();
    let arguments = ["render", "run", "--size", "32x32", "--out", "out-{:03}.png", "--stats", "stats.json"];
    let outcome = sphcast(folder.path(), &arguments);
    assert_eq!(outcome.status, 1);
    assert!(outcome.err.contains("warning: run/frame_2.vtk: "), "{}", outcome.err);
    assert_eq!(outcome.error(), "run/frame_2.vtk: no picture: 1 of 3 frames failed");
    assert_eq!(files_in(folder.path()), ["one.vtk", "out-000.png", "out-002.png", "run", "stats.json"]);
    let stats: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("stats.json")).unwrap()).unwrap();
    assert_eq!(stats.as_array().unwrap().len(), 2);

    let last =
        sphcast(folder.path(), &["render", "run", "--size", "8x8", "--frames", "2..", "--out", "pictures"]);
    assert_eq!(last.status, 0, "{}", last.err);
    assert_eq!(files_in(&folder.path().join("pictures")), ["frame-0002.png"]);
}

#[test]
fn stats_go_to_standard_output_once_where_that_is_wanted() {
    let folder = folder();
    let render = |more: &[&str]| {
        let mut arguments = vec!["render", "--size", "8x8", "--stats", "-"];
        arguments.extend(more);
        sphcast(folder.path(), &arguments)
    };
    let one = render(&["one.vtk", "--out", "one.png"]);
    let stats: serde_json::Value = serde_json::from_str(&one.out).unwrap();
    assert_eq!(stats["particles"], 20);
    // Nor is anything waited for where pictures are left as they are.
    assert_eq!(render(&["one.vtk", "--out", "one.png", "--resume"]).out, "");
    // One part of several, and a frame that cannot be read.
    let some = render(&["run", "--out", "out", "--shard", "1/1"]);
    assert_eq!(some.status, 1);
    let stats: Vec<serde_json::Value> = serde_json::from_str(&some.out).unwrap();
    assert_eq!(stats.iter().map(|entry| &entry["frame"]).collect::<Vec<_>>(), [0, 2]);
    assert!(!files_in(folder.path()).iter().any(|name| name.starts_with('-')));
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_a_device_a_device() {
    let folder = folder();
    fs::create_dir(folder.path().join("kept")).unwrap();
    fs::write(folder.path().join("kept/there.png"), "old").unwrap();
    std::os::unix::fs::symlink("kept/there.png", folder.path().join("link.png")).unwrap();
    let arguments =
        ["render", "one.vtk", "--size", "8x8", "--out", "link.png", "--resume", "--stats", "/dev/stdout"];
    let made = sphcast(folder.path(), &arguments);
    assert_eq!(made.status, 0, "{}", made.err);
    assert!(fs::symlink_metadata(folder.path().join("link.png")).unwrap().is_symlink());
    assert!(fs::read(folder.path().join("kept/there.png")).unwrap().starts_with(b"\x89PNG"));
    assert_eq!(serde_json::from_str::<serde_json::Value>(&made.out).unwrap()["particles"], 20);
}

#[test]
fn a_picture_is_written_whole_or_not_at_all() {
    let folder = folder();
    fs::create_dir(folder.path().join("taken.png")).unwrap();
    fs::write(folder.path().join("taken.png/inside"), "").unwrap();
    let missing = sphcast(folder.path(), &["render", "one.vtk", "--size", "8x8", "--out", "no/a.png"]);
    assert_eq!(missing.status, 1);
    assert!(missing.error().starts_with("no/a.png: cannot be written"), "{}", missing.err);
    let unknown = sphcast(folder.path(), &["render", "one.vtk", "--quantity", "dye", "--out", "a.png"]);
    assert_eq!(unknown.error(), "one.vtk: there is no field `dye`; there are: concentration");
    assert_eq!(files_in(folder.path()), ["one.vtk", "run", "taken.png"]);
}

#[test]
fn another_field_decides_the_opacity() {
    let folder = folder();
    let mut text = String::from("x,y,z,velocity,density\n");
    for i in 0..125_u32 {
        let [x, y, z] = [i % 5, i / 5 % 5, i / 25];
        text += &format!("{x},{y},{z},{},{}\n", f64::from(x) / 4.0, 1000 + y);
    }
    fs::write(folder.path().join("fluid.csv"), text).unwrap();
    let quantity =
        r#"{"quantity": {"name": "velocity", "opacity": {"name": "density", "range": [1000, 1004]}}}"#;
    fs::write(folder.path().join("view.json"), quantity).unwrap();
    let picture = |flags: &[&str]| {
        let flags = [&["render", "fluid.csv", "--size", "24x24", "--out", "a.png"], flags].concat();
        let outcome = sphcast(folder.path(), &flags);
        assert_eq!(outcome.status, 0, "{}", outcome.err);
        image::open(folder.path().join("a.png")).unwrap().into_rgba8()
    };
    let one = picture(&["--quantity", "velocity"]);
    let both = picture(&["--quantity", "velocity", "--opacity-by", "density"]);
    assert_eq!(both, picture(&["--view", "view.json"]));
    assert_ne!(both, one);
    let unknown = sphcast(folder.path(), &["render", "fluid.csv", "--opacity-by", "dye", "--out", "a.png"]);
    assert_eq!(unknown.error(), "fluid.csv: there is no field `dye`; there are: velocity, density");
}
