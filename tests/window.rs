//! The real window, driven by a real mouse and keyboard under Xvfb, with whatever Vulkan there is.

#[path = "window/cells.rs"]
mod cells;
#[cfg(unix)]
#[path = "window/colours.rs"]
mod colours;
#[path = "window/desktop.rs"]
mod desktop;
#[cfg(unix)]
#[path = "window/dialogs.rs"]
mod dialogs;
#[path = "support/files.rs"]
mod files;
#[path = "window/harness.rs"]
mod harness;
#[path = "window/journeys.rs"]
mod journeys;
#[path = "window/readme.rs"]
mod readme;
#[path = "window/sampling.rs"]
mod sampling;
#[path = "window/sessions.rs"]
mod sessions;
#[path = "window/system.rs"]
mod system;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use harness::{PATIENCE, Window, binary, missing};

#[test]
fn play_orbit_edit_and_save() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::open(folder.path(), &["demo", "--size", "120x90"]);

    // Play, and pause.
    window.key("space");
    window.wait_for("playing");
    window.wait_for("picture frame=3");
    window.key("space");
    window.wait_for("paused");
    let (first, before) = window.save(folder.path());

    // Orbit with the mouse.
    window.drag("picture", [0.3, 0.5], [0.6, 0.4]);
    window.wait_for("picture");
    // Add a point to the transfer function, and drag it.
    window.point(&window.place("transfer", 0.37, 0.2));
    window.tool(&["click", "--repeat", "2", "--delay", "60", "1"]);
    window.wait_for("picture");
    window.drag("transfer", [0.37, 0.2], [0.4, 0.5]);
    window.wait_for("picture");

    let (path, after) = window.save(folder.path());
    let (eye, target) = (after.camera.unwrap().eye, after.camera.unwrap().target);
    let (old_eye, old_target) = (before.camera.unwrap().eye, before.camera.unwrap().target);
    assert!(eye.distance(old_eye) > 0.1 * eye.distance(target), "the drag turned the camera");
    assert_eq!(target, old_target);
    assert_eq!(after.transfer.points.len(), before.transfer.points.len() + 1);
    let added = after.transfer.points.iter().find(|point| (point.u - 0.4).abs() < 0.03);
    assert!(added.is_some_and(|point| (point.opacity - 0.5).abs() < 0.1), "{:?}", after.transfer.points);

    same_as_rendered(folder.path(), &path);
    let [first, second] = [&first, &path].map(|path| sphcast::image_file::read(path).unwrap());
    assert_ne!(first, second, "another view is another picture");

    // Scrub to the end, and quit.
    window.point(&window.place("timeline", 0.99, 0.5));
    window.tool(&["click", "1"]);
    window.wait_for("picture");
    window.key("ctrl+q");
    let limit = Instant::now() + PATIENCE;
    let status = loop {
        if let Some(status) = window.program.0.try_wait().unwrap() {
            break status;
        }
        assert!(Instant::now() < limit, "it does not end");
        std::thread::sleep(Duration::from_millis(50));
    };
    assert!(status.success(), "{status}");
}

/// A saved picture shows something, and is what the command line makes of the view saved with it.
fn same_as_rendered(folder: &Path, picture: &Path) {
    let stem = picture.file_stem().unwrap().to_str().unwrap();
    let number = stem.split('-').nth(1).unwrap();
    let out = folder.join("rendered.png");
    let status = Command::new(binary())
        .args(["render", "demo", "--frames", number, "--view"])
        .arg(picture.with_extension("json"))
        .arg("--out")
        .arg(&out)
        .stderr(Stdio::null())
        .status()
        .unwrap();
    assert!(status.success());
    let saved = sphcast::image_file::read(picture).unwrap();
    let rendered = sphcast::image_file::read(&out).unwrap();
    assert_eq!((saved.width, saved.height), (120, 90));
    assert!(saved.data.iter().filter(|pixel| pixel[3] > 0.05).count() > 500, "it shows something");
    assert_eq!(saved, rendered);
}

#[test]
fn without_a_display_it_says_what_to_do() {
    if !cfg!(target_os = "linux") {
        eprintln!("skipped: other systems always have a display");
        return;
    }
    let output = Command::new(binary())
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.starts_with("error: display: ") && text.contains("sphcast render"), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
}
