//! Videos from the command line: by a stand-in for ffmpeg that writes down what it is given, and by ffmpeg itself.
#![cfg(unix)]

#[path = "support/files.rs"]
mod files;
#[path = "support/program.rs"]
#[expect(dead_code, reason = "no test calls all of it")]
mod program;

#[path = "support/ffmpeg.rs"]
mod ffmpeg;

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
        for part in ["-f rawvideo", "-pix_fmt rgba", "-video_size 16x10", "-framerate 12.5", codec] {
            assert!(said.contains(part), "{part} in {said}");
        }
        let bytes = fs::read(folder.path().join(out)).unwrap();
        assert_eq!(bytes.len(), 2 * 16 * 10 * 4);
        assert_eq!(bytes[..4], [255; 4], "the background");
        for row in bytes.chunks_exact(16 * 4) {
            assert_eq!(row[14 * 4..15 * 4], row[15 * 4..], "sides are made even by doubling the edge");
        }
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

    stand_in(folder.path(), "head -c 700 > /dev/null; echo 'No space left on device' >&2; exit 1");
    let full = render(
        folder.path(),
        &with_stand_in(folder.path()),
        &["--out", "film.mp4", "--frames", "0", "--turntable", "60"],
    );
    let err = String::from_utf8(full.stderr).unwrap();
    assert_eq!(full.status.code(), Some(1));
    assert!(err.contains("error: film.mp4: ffmpeg: No space left on device"), "{err}");

    let ending = render(folder.path(), &with_stand_in(folder.path()), &["--out", "film.mkv"]);
    let err = String::from_utf8(ending.stderr).unwrap();
    assert!(ending.status.code() == Some(2) && err.contains(".mp4 or .webm"), "{err}");

    for flag in [&["--resume"][..], &["--shard", "1/2"], &["--fps", "0"]] {
        let arguments = [&["--out", "film.mp4"], flag].concat();
        let wrong = render(folder.path(), &with_stand_in(folder.path()), &arguments);
        assert_eq!(wrong.status.code(), Some(2), "{flag:?}");
    }
    assert_eq!(files_in(folder.path()), ["bin", "one.vtk", "run"]);
}

/// Colours of a picture's pixels, 0 to 255.
fn png_colours(path: &Path) -> Vec<[f64; 3]> {
    let picture = image::open(path).unwrap().to_rgb8();
    picture.pixels().map(|pixel| pixel.0.map(f64::from)).collect()
}

#[test]
fn the_installed_ffmpeg_makes_films_that_play() {
    if !ffmpeg::is_there() {
        eprintln!("skipped: ffmpeg is not installed");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // Full colours, of which each matrix makes something else, and sides that must be made even.
    let view = r#"{"image": {"width": 61, "height": 45, "background": [0.02, 0.8, 0.02]},
        "quantity": {"range": [0, 1]},
        "transfer": {"points": [{"u": 0, "rgb": [0, 0, 1], "opacity": 0.5}, {"u": 1, "rgb": [1, 0, 0], "opacity": 0.9}]}}"#;
    fs::write(folder.path().join("view.json"), view).unwrap();
    let render = |out: &str| {
        let arguments =
            ["render", "demo", "--frames", "..3", "--view", "view.json", "--fps", "12.5", "--out", out];
        let outcome = program::sphcast(folder.path(), &arguments);
        assert_eq!(outcome.status, 0, "{out}: {}", outcome.err);
    };
    render("{}.png");
    for (out, codec) in [("film.mp4", "h264"), ("film.webm", "vp9")] {
        render(out);
        let film = folder.path().join(out);
        let facts = ffmpeg::facts(&film);
        for (key, value) in [
            ("codec_name", codec),
            ("width", "62"),
            ("height", "46"),
            ("pix_fmt", "yuv420p"),
            ("r_frame_rate", "25/2"),
            ("nb_read_frames", "3"),
            ("color_range", "tv"),
            ("color_space", "bt709"),
            ("color_primaries", "bt709"),
            ("color_transfer", "iec61966-2-1"),
        ] {
            assert!(facts.contains(&format!("{key}={value}")), "{out}: {key} is not {value}: {facts:?}");
        }
        for (number, frame) in ffmpeg::frames(&film, [62, 46]).iter().enumerate() {
            let picture = png_colours(&folder.path().join(format!("{number}.png")));
            let far = |x: usize, y: usize| -> f64 {
                let (there, here) = (frame[y * 62 + x], picture[y * 61 + x]);
                there.iter().zip(here).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            // Where all is of one colour, a film has that colour; another matrix would be off by 20.
            assert!(far(1, 1) <= 4.0, "{out}: the background is off by {}", far(1, 1));
            // Elsewhere colours are spread over two by two pixels, and the same on the whole.
            let off = |channel: usize| -> f64 {
                let places = (0..45).flat_map(|y| (0..61).map(move |x| (y * 62 + x, y * 61 + x)));
                places.map(|(there, here)| frame[there][channel] - picture[here][channel]).sum::<f64>()
                    / (61.0 * 45.0)
            };
            let off = [0, 1, 2].map(off);
            assert!(off.iter().all(|off| off.abs() < 3.0), "{out}: frame {number} is off by {off:?}");
            let edge =
                (0..45).map(|y| (frame[y * 62 + 60][1] - frame[y * 62 + 61][1]).abs()).fold(0.0, f64::max);
            assert!(edge < 16.0, "{out}: a seam at the edge, {edge}");
        }
    }
}

#[test]
fn a_film_that_is_cancelled_leaves_neither_a_file_nor_a_process() {
    if !ffmpeg::is_there() || !Path::new("/proc/self/cmdline").exists() {
        eprintln!("skipped: ffmpeg is not installed, or processes cannot be listed here");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film.mp4");
    let mut command = Command::new(program());
    command.args(["render", "demo", "--size", "640x480", "--out"]).arg(&film);
    command.current_dir(&folder).env("XDG_RUNTIME_DIR", folder.path()).stderr(std::process::Stdio::null());
    let mut rendering = command.spawn().unwrap();
    let limit = std::time::Instant::now() + std::time::Duration::from_secs(120);
    while ffmpeg::writers_in(folder.path()) == 0 {
        assert!(rendering.try_wait().unwrap().is_none(), "it has ended before it began");
        assert!(std::time::Instant::now() < limit, "ffmpeg does not start");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let status = Command::new("kill").args(["-INT", &rendering.id().to_string()]).status().unwrap();
    assert!(status.success());
    assert_eq!(rendering.wait().unwrap().code(), Some(1));
    assert_eq!(ffmpeg::writers_in(folder.path()), 0);
    assert!(files_in(folder.path()).is_empty(), "{:?}", files_in(folder.path()));
}
