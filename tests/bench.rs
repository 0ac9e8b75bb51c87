//! `sphcast bench` as its users call it: tables and plots.

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
mod program;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use program::{files_in, folder, sphcast};

/// The rows of a CSV file without quotes, each a map from column to cell.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let row = |cells: Vec<String>| {
        assert_eq!(cells.len(), names.len(), "{cells:?}");
        names.iter().cloned().zip(cells).collect()
    };
    lines.map(row).collect()
}

/// Whether a cell of a CSV says what its place in the JSON says.
fn agree(cell: &str, value: &serde_json::Value) -> bool {
    match value {
        serde_json::Value::Null => cell.is_empty(),
        serde_json::Value::String(text) => cell == text,
        number => cell.parse::<f64>().ok() == number.as_f64(),
    }
}

#[test]
fn a_bench_writes_tables_that_agree_and_plots() {
    let folder = folder();
    let arguments =
        ["bench", "demo", "--frames", "3..5", "--size", "256x176", "--rounds", "1", "--ablations"];
    let more = ["--tolerances", "0.01", "--discretisation", "--out", "results"];
    let bench = sphcast(folder.path(), &[&arguments[..], &more].concat());
    assert_eq!(bench.status, 0);
    // Only relaxation may break the tolerance.
    assert!(bench.err.lines().all(|line| line.contains(" relaxed: the error is above")), "{}", bench.err);
    let results = folder.path().join("results");
    let plots = ["error-over-frames.svg", "time-against-error.svg", "time-over-frames.svg"];
    assert_eq!(
        files_in(&results),
        [&["bench.json"], &plots[..1], &["frames.csv", "settings.csv"], &plots[1..]].concat()
    );
    for plot in plots {
        let text = fs::read_to_string(results.join(plot)).unwrap();
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n") && !text.contains("NaN"), "{plot}");
    }

    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(results.join("bench.json")).unwrap()).unwrap();
    assert_eq!((&json["complete"], &json["frames"]), (&true.into(), &2.into()));
    for (table, file, count) in [("settings", "settings.csv", 15), ("by_frame", "frames.csv", 30)] {
        let rows = rows(&results.join(file));
        assert_eq!((rows.len(), json[table].as_array().unwrap().len()), (count, count), "{file}");
        for (row, value) in rows.iter().zip(json[table].as_array().unwrap()) {
            for (column, cell) in row {
                let value = column.split('.').fold(value, |value, key| &value[key]);
                assert!(agree(cell, value), "{file}: {column}: {cell} and {value}");
            }
            // Every picture was rendered, from the grid to the last ray.
            for time in ["milliseconds.grid.lower", "milliseconds.ray_cast.lower"] {
                assert!(row[time].parse::<f64>().unwrap() > 0.0, "{file}: {time}");
            }
            assert!(bench.out.contains(&format!("\n{} ", row["setting"])), "{}", bench.out);
        }
    }
    let [full, object_space, adaptive, ablation] = [0, 1, 2, 3].map(|row| &json["settings"][row]);
    assert_eq!(
        [full, object_space, adaptive, ablation].map(|row| row["tolerance"].as_f64()),
        [None, None, Some(0.01), Some(0.01)]
    );
    assert!(object_space["evaluations"]["share"].as_f64().unwrap() > 2.0, "many more are in vain");
    assert!(object_space["error"]["mean"].as_f64().unwrap() < 1e-5);
    assert!(adaptive["error"]["max"].as_f64().unwrap() <= 0.01);
    assert!(adaptive["milliseconds"]["analysis"]["lower"].as_f64().unwrap() > 0.0);
    assert!(full["evaluations"]["inside"].as_f64().unwrap() > 0.0);
    assert!(full["discretisation"]["max"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_bench_goes_on_after_a_bad_frame() {
    let folder = folder();
    let arguments =
        ["bench", "run", "--size", "16x16", "--rounds", "1", "--tolerances", "0.01", "--out", "b"];
    let bench = sphcast(folder.path(), &arguments);
    assert_eq!(bench.status, 1);
    assert_eq!(bench.error(), "run/frame_2.vtk: not measured: 1 of 3 frames failed");
    assert!(bench.err.contains("warning: not complete: 2 of 3 frames"), "{}", bench.err);
    let numbers: Vec<String> =
        rows(&folder.path().join("b/frames.csv")).into_iter().map(|row| row["frame"].clone()).collect();
    assert_eq!(numbers, ["0", "0", "2", "2"]);

    let nothing = sphcast(folder.path(), &["bench", "run/frame_2.vtk", "--out", "nothing"]);
    assert_eq!(nothing.status, 1);
    assert!(nothing.error().starts_with("run/frame_2.vtk: ") && nothing.out.is_empty(), "{}", nothing.err);
    assert!(files_in(&folder.path().join("nothing")).is_empty());
}

#[test]
fn frames_of_many_sizes_have_a_plot_of_growth() {
    let folder = folder();
    let runs = ["bench", "demo:radial:729", "demo:radial:64", "demo:radial:4096"];
    let more = ["--size", "24x24", "--rounds", "1", "--tolerances", "off,0.01", "--out", "growth"];
    assert_eq!(sphcast(folder.path(), &[&runs[..], &more].concat()).status, 0);
    let plot = fs::read_to_string(folder.path().join("growth/time-over-particles.svg")).unwrap();
    for mark in ["Time over the number of particles", ">100<", ">1000<", ">full<", ">0.01<"] {
        assert!(plot.contains(mark), "{mark}: {plot}");
    }
}
