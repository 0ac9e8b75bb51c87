//! Pictures that are rendered and written in bands, and what an EXR holds beside colour.

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
mod program;

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

#[test]
fn layers_are_channels_of_the_exr_and_leave_its_colour_alone() {
    let folder = folder();
    let view = r#"{"sampling": {"tolerance": 0.01, "always_adaptive": true}}"#;
    std::fs::write(folder.path().join("view.json"), view).unwrap();
    let render = |more: &[&str]| {
        let arguments = ["render", "demo:radial:1000", "--size", "64x48", "--view", "view.json"];
        let outcome = sphcast(folder.path(), &[&arguments, more].concat());
        assert_eq!(outcome.status, 0, "{}", outcome.err);
    };
    render(&["--out", "plain.exr"]);
    render(&["--out", "layers.exr", "--layers", "predicted-error", "--stats", "stats.json"]);
    render(&["--out", "both.exr", "--layers", "predicted-error", "--overlay", "cells.png"]);
    let predicted = |name: &str| -> Vec<f32> {
        use exr::prelude::{ReadChannels, ReadLayers, read};
        let layer = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = layer.all_attributes().from_file(folder.path().join(name)).unwrap();
        let channel =
            image.layer_data.channel_data.list.iter().find(|c| c.name.to_string() == "predicted_error");
        channel.unwrap().sample_data.values_as_f32().collect()
    };
    let charged = predicted("layers.exr");
    assert_eq!(charged, predicted("both.exr"));
    let stats: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("stats.json")).unwrap()).unwrap();
    let largest = f64::from(charged.iter().copied().fold(0.0, f32::max));
    assert!(
        largest > 0.0 && (largest - stats["predicted_error"].as_f64().unwrap()).abs() < 1e-7,
        "{largest}"
    );
    for other in ["layers.exr", "both.exr"] {
        let same = sphcast(folder.path(), &["compare", "plain.exr", other, "--fail-above", "0.0001"]);
        assert_eq!(same.status, 0, "{}{}", same.out, same.err);
    }
}

#[test]
fn what_cannot_be_is_told_before_anything_is_drawn() {
    let folder = folder();
    let render = |more: &[&str]| sphcast(folder.path(), &[&["render", "one.vtk"], more].concat());
    let png = render(&["--out", "a.png", "--layers", "predicted-error"]);
    assert_eq!(png.status, 2);
    assert!(png.error().starts_with("--layers: only .exr files hold them"), "{}", png.err);
    assert_eq!(render(&["--out", "a.exr", "--layers", "normals"]).status, 2);
    let large = render(&["--out", "a.exr", "--overlay", "b.png", "--size", "16384x16384"]);
    assert_eq!(large.status, 1);
    assert!(large.error().starts_with("--overlay: 16384 x 16384 pixels are more than"), "{}", large.err);
    assert_eq!(files_in(folder.path()), ["one.vtk", "run"]);
}
