//! What the system does with the window: drops files on it, gives it the whole screen, takes its
//! graphics device away.

use std::path::{Path, PathBuf};

use renderer::View;
use tempfile::TempDir;

use crate::desktop::eventually;
use crate::files::write_vtk;
use crate::harness::{Window, missing};

/// Two small frames, under names that an address must escape.
pub fn frames(folder: &Path) -> [PathBuf; 2] {
    ["first frame.vtk", "zweite für später.vtk"].map(|name| {
        let path = folder.join(name);
        write_vtk(&path, 30, true);
        path
    })
}

/// A window over these two in a folder of its own; `None`, and why, where no window can be opened.
pub fn window_over_frames(arguments: &[&str]) -> Option<(TempDir, Window)> {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    frames(folder.path());
    let window = Window::open(folder.path(), arguments);
    Some((folder, window))
}

/// Another view than `view`, in a file.
pub fn another_view(folder: &Path, view: &View) -> (PathBuf, View) {
    let mut other = view.clone();
    let camera = other.camera.as_mut().unwrap();
    camera.eye = camera.target + 1.5 * (camera.eye - camera.target);
    other.transfer.points.retain(|point| point.u != 0.0);
    let path = folder.join("other view.json");
    std::fs::write(&path, other.to_json()).unwrap();
    (path, other)
}

pub fn assert_same(view: &View, other: &View) {
    let ends = |view: &View| view.camera.map(|camera| (camera.eye, camera.target)).unwrap();
    let ((eye, target), (other_eye, other_target)) = (ends(view), ends(other));
    assert!(eye.distance(other_eye) + target.distance(other_target) < 1e-9, "the camera is the same");
    assert_eq!(view.transfer, other.transfer);
}

#[test]
fn dropped_files_are_opened_and_dropped_views_loaded() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::open(folder.path(), &["demo", "--size", "120x90"]);
    let desktop = window.desktop();

    // What hovers is announced by darkening the window.
    let corner = [450, 2, 1, 1];
    let bright = desktop.resting_pixels(corner);
    let frames = frames(folder.path());
    desktop.hover(&frames);
    eventually("a darker window", || desktop.pixels(corner) < bright);
    desktop.leave();
    eventually("the window as it was", || desktop.pixels(corner) == bright);

    desktop.hover(&frames);
    desktop.drop();
    assert!(window.wait_for("opened").ends_with("frames=2"));
    window.wait_for("picture frame=0");
    eventually("the window as it was", || desktop.pixels(corner) == bright);

    let (_, view) = window.save(folder.path());
    let (path, other) = another_view(folder.path(), &view);
    desktop.hover(&[path]);
    desktop.drop();
    window.wait_for("loaded");
    window.wait_for("picture frame=0");
    assert_same(&window.save(folder.path()).1, &other);

    // What cannot be opened leaves everything as it is.
    let broken = folder.path().join("broken.pvd");
    std::fs::write(&broken, "<VTKFile").unwrap();
    desktop.hover(&[broken]);
    desktop.drop();
    assert!(window.wait_for("error").contains("broken.pvd"));
    // A folder is a sequence, and is waited in where there is no frame as yet.
    let empty = folder.path().join("empty");
    std::fs::create_dir(&empty).unwrap();
    desktop.hover(&[empty]);
    desktop.drop();
    assert!(window.wait_for("opened").ends_with("empty frames=0"));
    desktop.hover(&[folder.path().to_owned()]);
    desktop.drop();
    assert!(window.wait_for("opened").ends_with("frames=2"));
}

#[test]
fn full_screen_and_back() {
    let Some((_folder, mut window)) = window_over_frames(&["."]) else { return };
    let desktop = window.desktop();
    for (full, timeline) in [(true, "area timeline 16 750"), (false, "area timeline 16 550")].repeat(2) {
        window.key("F11");
        desktop.grant_full_screen(full);
        window.wait_for(timeline);
        // The picture grows and shrinks with the window.
        window.wait_for_full_picture();
    }
}

#[test]
fn after_the_loss_of_its_device_the_window_goes_on_as_it_was() {
    let Some((folder, mut window)) = window_over_frames(&[".", "--size", "120x90"]) else { return };
    let desktop = window.desktop();
    window.key("Right");
    window.wait_for("picture frame=1");
    window.drag("picture", [0.3, 0.5], [0.6, 0.4]);
    window.drag("transfer", [0.0, 0.5], [0.0, 0.2]);
    window.wait_for_full_picture();
    let (_, before) = window.save(folder.path());
    // Below the messages: half of the picture, letters and curves of the panel, the timeline.
    let lower_half = [0, 320, 900, 280];
    let shown = desktop.resting_pixels(lower_half);

    for _ in 0..2 {
        window.key("F12");
        window.wait_for("recovered");
        window.wait_for("picture frame=1");
        eventually("the same window", || desktop.pixels(lower_half) == shown);
    }
    let (_, after) = window.save(folder.path());
    assert_same(&after, &before);
    window.key("Left");
    window.wait_for("picture frame=0");
}
