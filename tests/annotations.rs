//! Annotations in saved pictures: there when the view asks for them, and nothing but what they cover changed.

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
mod program;

use std::fs;
use std::path::Path;

use program::{files_in, folder, sphcast};
use sphcast::image_file::{self, Pixels};

const SIZE: &str = "320x240";

/// The picture of a frame with `view` and annotations, as a file of that name.
fn picture(folder: &Path, view: &str, name: &str) -> Pixels {
    fs::write(folder.join("view.json"), view).unwrap();
    let arguments = ["render", "one.vtk", "--view", "view.json", "--size", SIZE, "--out", name];
    let outcome = sphcast(folder, &arguments);
    assert_eq!((outcome.status, &*outcome.out), (0, ""), "{}", outcome.err);
    image_file::read(&folder.join(name)).unwrap()
}

/// Pixels that differ.
fn changed(a: &Pixels, b: &Pixels) -> usize {
    assert_eq!((a.width, a.height), (b.width, b.height));
    a.data.iter().zip(&b.data).filter(|(a, b)| a != b).count()
}

const ALL: &str = r#"{"annotations": {"colour_bar": true, "axes": true, "frame_number": true, "scale_bar": true,
    "title": "A block", "length_unit": "m"}}"#;

#[test]
fn pictures_have_what_the_view_asks_for() {
    let folder = folder();
    let at = folder.path();
    for name in ["a.exr", "a.png"] {
        let plain = picture(at, "{}", &format!("plain-{name}"));
        let unsaved = ALL.replacen("{\"colour_bar\"", "{\"in_pictures\": false, \"colour_bar\"", 1);
        assert_eq!(changed(&plain, &picture(at, &unsaved, &format!("unsaved-{name}"))), 0);
        let annotated = picture(at, ALL, &format!("annotated-{name}"));
        let touched = changed(&plain, &annotated);
        assert!((500..20_000).contains(&touched), "{name}: {touched} pixels");
        // Letters are written where nothing else is to be seen: on no background, they bring their own alpha.
        let written = plain.data.iter().zip(&annotated.data);
        assert!(
            written.filter(|(before, after)| before[3] == 0.0 && after[3] == 1.0).count() > 200,
            "{name}"
        );
    }
}

#[test]
fn errors_name_the_key() {
    let folder = folder();
    fs::write(folder.path().join("view.json"), r#"{"annotations": {"size": 99}}"#).unwrap();
    let outcome = sphcast(folder.path(), &["render", "one.vtk", "--view", "view.json", "--out", "a.png"]);
    assert_eq!(outcome.status, 1);
    assert_eq!(outcome.error(), "view.json: annotations.size: 99 is not between 0.25 and 4");
    fs::write(folder.path().join("view.json"), r#"{"annotations": {"sise": 1}}"#).unwrap();
    let outcome = sphcast(folder.path(), &["render", "one.vtk", "--view", "view.json", "--out", "a.png"]);
    assert!(outcome.error().contains("sise"), "{}", outcome.err);
    assert!(!files_in(folder.path()).contains(&"a.png".to_owned()));
}
