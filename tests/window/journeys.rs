//! What a user does on most days, from one end to the other.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use sphcast::image_file::{self, Pixels};

use crate::files::write_vtk;
use crate::harness::{Window, binary, missing};
use crate::system::{assert_same, frames, window_over_frames};

/// The pictures that the command line makes of the frames in `folder`, with the view in a file.
fn rendered(folder: &Path, view: &Path, count: usize) -> Vec<Pixels> {
    let out = folder.join("rendered");
    let status = Command::new(binary())
        .current_dir(folder)
        .args(["render", "*.vtk", "--out", "rendered/"])
        .arg("--view")
        .arg(view)
        .stderr(Stdio::null())
        .status()
        .unwrap();
    assert!(status.success());
    (0..count).map(|index| image_file::read(&out.join(format!("frame-{index:04}.png"))).unwrap()).collect()
}

fn visible(pixels: &Pixels) -> usize {
    pixels.data.iter().filter(|pixel| pixel[3] > 0.05).count()
}

#[test]
fn a_plane_cuts_the_run_open() {
    let Some((folder, mut window)) = window_over_frames(&[".", "--size", "120x90"]) else { return };
    window.key("5");
    window.wait_for_full_picture();
    let (whole, before) = window.save(folder.path());
    assert!(before.select.is_empty());
    // A plane is put across the line of sight: along this row of particles.
    window.key("1");
    // The section above it is folded away, so that all of it is in view.
    window.fold(&["Transfer function", "Clip and filter"]);
    window.wait_for_area("+ Plane");
    window.rest();
    window.click("+ Plane", [0.5, 0.5]);
    window.key("5");
    window.wait_for_full_picture();
    let (cut, after) = window.save(folder.path());
    assert!(after.select.clip_plane.is_some());
    let [whole, cut] = [whole, cut].map(|path| image_file::read(&path).unwrap());
    let share = visible(&cut) as f64 / visible(&whole) as f64;
    assert!((0.3..0.7).contains(&share), "half is cut away: {share} is left");

    // And back.
    window.key("ctrl+z");
    window.key("ctrl+z");
    window.wait_for_full_picture();
    let (_, undone) = window.save(folder.path());
    assert!(undone.select.is_empty());
}

#[test]
fn a_sequence_is_exported_as_the_command_line_makes_it() {
    let Some((folder, mut window)) = window_over_frames(&[".", "--size", "60x45"]) else { return };
    window.drag("picture", [0.3, 0.5], [0.6, 0.4]);
    window.wait_for_full_picture();
    let (picture, _) = window.save(folder.path());
    window.key("ctrl+shift+s");
    window.wait_for_area("export");
    window.rest();
    window.click("export", [0.5, 0.5]);
    window.wait_for("saved");
    let exported: Vec<PathBuf> =
        (0..2).map(|index| folder.path().join(format!("frame-{index:04}.png"))).collect();
    let rendered = rendered(folder.path(), &picture.with_extension("json"), 2);
    for (exported, rendered) in exported.iter().zip(&rendered) {
        assert!(visible(rendered) > 20, "it shows something");
        assert_eq!(&image_file::read(exported).unwrap(), rendered, "{}", exported.display());
    }
}

#[test]
fn a_bookmark_leads_back() {
    let Some((folder, mut window)) = window_over_frames(&[".", "--size", "120x90"]) else { return };
    window.wait_for_full_picture();
    window.key("b");
    let (_, before) = window.save(folder.path());
    assert_eq!(before.bookmarks.len(), 1);
    window.drag("picture", [0.3, 0.5], [0.6, 0.4]);
    window.wait_for_full_picture();
    let (_, away) = window.save(folder.path());
    assert_ne!(away.camera, before.camera);
    // The camera takes a moment to get there.
    window.key("ctrl+1");
    window.wait_for_full_picture();
    window.rest();
    let (_, back) = window.save(folder.path());
    assert_same(&back, &before);
}

#[test]
fn a_run_grows_while_it_is_watched() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let frame = |number: usize| folder.path().join(format!("frame_{number}.vtk"));
    (0..2).for_each(|number| write_vtk(&frame(number), 30, true));
    let mut window = Window::open(folder.path(), &[".", "--size", "120x90", "--follow"]);
    window.wait_for("picture frame=1");
    // A solver is half through with a frame, and then done.
    write_vtk(&frame(3), 20, true);
    let whole = std::fs::read(frame(3)).unwrap();
    std::fs::remove_file(frame(3)).unwrap();
    std::fs::write(frame(2), &whole[..whole.len() / 2]).unwrap();
    std::thread::sleep(std::time::Duration::from_secs(3));
    std::fs::write(frame(2), &whole).unwrap();
    window.wait_for("picture frame=2");
    assert!(!window.said.iter().any(|line| line.contains("bad frame")), "{:#?}", window.said);
}

#[test]
fn a_run_begins_and_fills_up_while_it_is_watched() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    std::fs::create_dir(&run).unwrap();
    let mut window = Window::open_without_picture(folder.path(), &["run", "--size", "120x90", "--follow"]);
    assert_eq!(window.said[0], "event: opened run frames=0");
    write_vtk(&run.join("frame_5.vtk"), 30, true);
    window.wait_for("picture frame=0");
    // Two that are late: one before the frame in view, which stays in view, and one that is the newest.
    write_vtk(&run.join("frame_3.vtk"), 20, true);
    window.wait_for("appended run frames=2");
    window.wait_for("picture frame=1");
    write_vtk(&run.join("frame_10.vtk"), 25, true);
    window.wait_for("picture frame=2");
    window.key("ctrl+Left");
    window.wait_for("picture frame=0");
    assert!(!window.said.iter().any(|line| line.starts_with("event: error")), "{:#?}", window.said);
}

#[test]
fn a_path_of_keyframes_is_exported_as_the_command_line_goes_along_it() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    frames(folder.path());
    write_vtk(&folder.path().join("z.vtk"), 30, true);
    let mut window = Window::open(folder.path(), &["*.vtk", "--size", "60x45"]);
    window.wait_for_full_picture();
    window.key("shift+k");
    window.key("ctrl+Right");
    window.wait_for("picture frame=2");
    window.drag("picture", [0.3, 0.5], [0.7, 0.4]);
    window.wait_for_full_picture();
    window.key("shift+k");
    window.rest();
    let (seen, view) = window.save(folder.path());
    let keys: Vec<f64> = view.path.keyframes.iter().map(|key| key.frame).collect();
    assert_eq!(keys, [0.0, 2.0]);
    assert_ne!(view.path.keyframes[0].camera, view.path.keyframes[1].camera);
    window.key("ctrl+shift+s");
    window.wait_for_area("export");
    window.rest();
    window.click("export", [0.5, 0.5]);
    window.wait_for("saved");
    let rendered = rendered(folder.path(), &seen.with_extension("json"), 3);
    for (index, rendered) in rendered.iter().enumerate() {
        let exported = image_file::read(&folder.path().join(format!("frame-{index:04}.png"))).unwrap();
        assert_eq!(&exported, rendered, "frame {index}");
    }
    // At its keyframe, the path is what was seen.
    assert_eq!(image_file::read(&seen).unwrap(), rendered[2]);
    assert!(visible(&rendered[2]) > 20 && rendered[0] != rendered[1]);
}

#[test]
fn a_camera_goes_through_the_clipboard() {
    let Some((folder, mut window)) = window_over_frames(&[".", "--size", "60x45"]) else { return };
    window.wait_for_full_picture();
    let (_, before) = window.save(folder.path());
    window.key("ctrl+shift+c");
    window.wait_for("copied camera");
    window.drag("picture", [0.3, 0.5], [0.7, 0.4]);
    window.wait_for_full_picture();
    let (_, away) = window.save(folder.path());
    assert_ne!(away.camera, before.camera);
    window.key("ctrl+shift+v");
    window.wait_for("pasted camera");
    window.wait_for_full_picture();
    window.rest();
    let (_, back) = window.save(folder.path());
    assert_same(&back, &before);
}
