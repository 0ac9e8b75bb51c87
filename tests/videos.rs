//! Videos from the command line, by a stand-in for ffmpeg that writes down what it is given.
#![cfg(unix)]

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
#[expect(dead_code, reason = "no test calls all of it")]
mod program;

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use program::{files_in, folder, program};

/// Puts a stand-in into `folder`/bin that runs `script`.
fn stand_in(folder: &Path, script: &str) {
    fs::create_dir_all(folder.join("bin")).unwrap();
    let path = folder.join("bin/ffmpeg");
    fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(path, PermissionsExt::from_mode(0o755)).unwrap();
}

/// Writes its arguments to `said`, and what it reads to the file that is its last argument.
const RECORDS: &str = "echo \"$@\" > said; for last; do :; done; cat > \"$last\"";

fn render(folder: &Path, path: &str, arguments: &[&str]) -> Output {
    let mut command = Command::new(program());
    command.args(["render", "run", "--size", "15x10"]).args(arguments).current_dir(folder);
    command.env("PATH", path).env("XDG_RUNTIME_DIR", folder).output().unwrap()
}

fn with_stand_in(folder: &Path) -> String {
    format!("{}:{}", folder.join("bin").display(), std::env::var("PATH").unwrap())
}

#[test]
fn pictures_go_to_ffmpeg_one_after_the_other() {
    let folder = folder();
    stand_in(folder.path(), RECORDS);
    for (out, codec) in [("film.mp4", "libx264"), ("film.webm", "libvpx-vp9")] {
        let path = with_stand_in(folder.path());
        fs::write(folder.path().join("white.json"), r#"{"image": {"background": [1, 1, 1]}}"#).unwrap();
        let outcome = render(folder.path(), &path, &["--out", out, "--fps", "12.5", "--view", "white.json"]);
        fs::remove_file(folder.path().join("white.json")).unwrap();
        let err = String::from_utf8(outcome.stderr).unwrap();
        // One of the three frames is bad, and told.
        assert_eq!(outcome.status.code(), Some(1), "{err}");
        assert!(err.contains("run/frame_2.vtk: no picture: 1 of 3 frames failed"), "{err}");
        let said = fs::read_to_string(folder.path().join("said")).unwrap();
        for part in ["-f rawvideo", "-pix_fmt rgba", "-video_size 15x10", "-framerate 12.5", codec] {
            assert!(said.contains(part), "{part} in {said}");
        }
        let bytes = fs::read(folder.path().join(out)).unwrap();
        assert_eq!(bytes.len(), 2 * 15 * 10 * 4);
        assert_eq!(bytes[..4], [255; 4], "the background");
        assert!(
            bytes.as_chunks::<4>().0.iter().any(|pixel| pixel[..3] != [255; 3]),
            "something is to be seen"
        );
    }
    assert_eq!(files_in(folder.path()), ["bin", "film.mp4", "film.webm", "one.vtk", "run", "said"]);
}

#[test]
fn what_ffmpeg_has_against_it_is_told_and_no_file_is_left() {
    let folder = folder();
    let missing = render(folder.path(), "/nowhere", &["--out", "film.mp4"]);
    let err = String::from_utf8(missing.stderr).unwrap();
    assert_eq!(missing.status.code(), Some(1));
    assert!(err.contains("error: film.mp4: ffmpeg is not installed"), "{err}");
    assert!(err.contains("apt install ffmpeg"), "{err}");

    stand_in(folder.path(), "echo 'Unknown encoder' >&2; exit 1");
    let refused = render(folder.path(), &with_stand_in(folder.path()), &["--out", "film.mp4"]);
    let err = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(1));
    assert!(err.contains("error: film.mp4: ffmpeg: Unknown encoder"), "{err}");

    for flag in [&["--resume"][..], &["--shard", "1/2"], &["--fps", "0"]] {
        let arguments = [&["--out", "film.mp4"], flag].concat();
        let wrong = render(folder.path(), &with_stand_in(folder.path()), &arguments);
        assert_eq!(wrong.status.code(), Some(2), "{flag:?}");
    }
    assert_eq!(files_in(folder.path()), ["bin", "one.vtk", "run"]);
}
