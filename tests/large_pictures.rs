//! Pictures that are rendered and written in bands, and what an EXR holds beside colour.

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
#[expect(dead_code, reason = "no test calls all of it")]
mod program;

use std::collections::BTreeMap;
use std::path::Path;

use program::{files_in, folder, sphcast};

#[test]
fn a_picture_may_be_16384_pixels_wide() {
    let folder = folder();
    for out in ["wide.png", "wide.exr"] {
        let outcome = sphcast(
            folder.path(),
            &["render", "one.vtk", "--size", "16384x8", "--tolerance", "off", "--out", out],
        );
        assert_eq!(outcome.status, 0, "{}", outcome.err);
    }
    let [png, exr] = ["wide.png", "wide.exr"].map(|name| {
        let picture = sphcast::image_file::read(&folder.path().join(name)).unwrap();
        assert_eq!((picture.width, picture.height), (16384, 8));
        picture
    });
    assert!(exr.data.iter().any(|pixel| pixel[3] > 0.1), "something is to be seen");
    let far = png.data.iter().zip(&exr.data).map(|(a, b)| (a[3] - b[3]).abs()).fold(0.0, f32::max);
    assert!(far <= 0.5 / 255.0 + 1e-6, "alpha differs by {far}");
}

/// Names and values of the channels of an EXR.
fn channels(path: &Path) -> BTreeMap<String, Vec<f32>> {
    use exr::prelude::{ReadChannels, ReadLayers, read};
    let layer = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = layer.all_attributes().from_file(path).unwrap();
    let list = image.layer_data.channel_data.list.into_iter();
    list.map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().collect())).collect()
}

#[test]
fn layers_are_channels_of_the_exr_and_leave_its_colour_alone() {
    let folder = folder();
    let view = r#"{"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]},
                   "sampling": {"tolerance": 0.01, "always_adaptive": true, "brick_width": 2}}"#;
    std::fs::write(folder.path().join("view.json"), view).unwrap();
    let render = |out: &str, more: &[&str]| {
        let arguments =
            ["render", "demo:radial:1000", "--size", "64x48", "--view", "view.json", "--out", out];
        let outcome = sphcast(folder.path(), &[&arguments, more].concat());
        assert_eq!(outcome.status, 0, "{}", outcome.err);
        channels(&folder.path().join(out))
    };
    let plain = render("plain.exr", &[]);
    let error = render("error.exr", &["--layers", "predicted-error", "--stats", "stats.json"]);
    let depth = render("depth.exr", &["--layers", "depth", "--tolerance", "off"]);
    let both = render("both.exr", &["--layers", "predicted-error,depth,depth"]);
    let over = render("over.exr", &["--layers", "depth,predicted-error", "--overlay", "cells.png"]);

    let names =
        |channels: &BTreeMap<String, Vec<f32>>| channels.keys().cloned().collect::<Vec<_>>().join(" ");
    assert_eq!(names(&plain), "A B G R");
    assert_eq!(names(&depth), "A B G R Z");
    assert_eq!([names(&both), names(&over)], ["A B G R Z predicted_error"; 2]);
    let stats: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("stats.json")).unwrap()).unwrap();
    let largest = f64::from(error["predicted_error"].iter().copied().fold(0.0, f32::max));
    assert!(
        largest > 0.0 && (largest - stats["predicted_error"].as_f64().unwrap()).abs() < 1e-7,
        "{largest}"
    );
    // Of full sampling, whatever the tolerance of the colours, and beside whatever else.
    for other in [&both, &over] {
        assert!(other["predicted_error"] == error["predicted_error"] && other["Z"] == depth["Z"]);
        assert!(["R", "G", "B", "A"].iter().all(|channel| other[*channel] == plain[*channel]));
    }
    for (z, opacity) in depth["Z"].iter().zip(&depth["A"]) {
        let seen = (3.5..6.5).contains(z);
        assert!(if *opacity > 0.0 { seen } else { *z == f32::INFINITY }, "{z} where opacity is {opacity}");
    }
    assert!(depth["Z"].contains(&f32::INFINITY) && depth["Z"].iter().any(|z| z.is_finite()));
}

#[test]
fn what_cannot_be_is_told_before_anything_is_drawn() {
    let folder = folder();
    let render = |more: &[&str]| sphcast(folder.path(), &[&["render", "one.vtk"], more].concat());
    let png = render(&["--out", "a.png", "--layers", "predicted-error"]);
    assert_eq!(png.status, 2);
    assert!(png.error().starts_with("--layers: only .exr files hold them"), "{}", png.err);
    let normals = render(&["--out", "a.exr", "--layers", "depth,normals"]);
    assert!(normals.status == 2 && normals.err.contains("predicted-error"), "{}", normals.err);
    let large = render(&["--out", "a.exr", "--overlay", "b.png", "--size", "16384x16384"]);
    assert_eq!(large.status, 1);
    assert!(large.error().starts_with("--overlay: 16384 x 16384 pixels are more than"), "{}", large.err);
    assert_eq!(files_in(folder.path()), ["one.vtk", "run"]);
}
