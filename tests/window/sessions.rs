//! What outlives the program: the session after a crash, the runs that were open, keys of one's own.

use std::path::Path;

use crate::desktop::eventually;
use crate::harness::{Window, missing};
use crate::system::{assert_same, frames, window_over_frames};

/// The sessions that are kept, as far as they are not being written or taken away just now.
fn kept(folder: &Path) -> Vec<serde_json::Value> {
    let files = std::fs::read_dir(folder.join("home/data/sphcast/sessions")).unwrap();
    let files = files.filter_map(|file| Some(file.ok()?.path()));
    let files = files.filter(|path| path.extension().is_some_and(|ending| ending == "json"));
    files.filter_map(|file| Some(serde_json::from_slice(&std::fs::read(file).ok()?).unwrap())).collect()
}

#[test]
fn a_window_that_runs_is_no_crash() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for name in ["first", "second"] {
        std::fs::create_dir(folder.path().join(name)).unwrap();
        frames(&folder.path().join(name));
    }
    let mut first = Window::open(folder.path(), &["first", "--size", "120x90"]);
    let _second = Window::open(folder.path(), &["second", "--size", "120x90"]);
    eventually("two sessions", || kept(folder.path()).len() == 2);
    first.program.0.kill().unwrap();
    first.program.0.wait().unwrap();
    let mut third = Window::open(folder.path(), &[]);
    third.wait_for_area("last-session");
    third.click("last-session", [0.3, 0.5]);
    assert_eq!(third.wait_for("opened"), "first frames=2");
    eventually("its own session in place of the one after the crash", || {
        let titles: Vec<_> = kept(folder.path()).iter().map(|kept| kept["title"].clone()).collect();
        titles.len() == 2 && titles.contains(&"first".into()) && titles.contains(&"second".into())
    });
}

#[test]
fn after_a_crash_the_session_is_opened_again_from_the_start_page() {
    let Some((folder, mut window)) = window_over_frames(&[".", "--size", "120x90"]) else { return };
    // By its name in the palette, found by the beginnings of words.
    window.key("ctrl+k");
    window.wait_for_area("palette");
    window.tool(&["type", "ne fr"]);
    std::thread::sleep(std::time::Duration::from_millis(300));
    window.key("Return");
    window.wait_for("picture frame=1");
    window.drag("picture", [0.3, 0.5], [0.6, 0.4]);
    window.drag("transfer", [0.0, 0.5], [0.0, 0.2]);
    let (_, before) = window.save(folder.path());
    eventually("a session with this view", || {
        let [kept] = kept(folder.path()).try_into().expect("one session");
        kept["view"]["camera"] == serde_json::to_value(before.camera).unwrap() && kept["frame"] == 1
    });
    // Not by its own will: nothing is written on the way.
    window.program.0.kill().unwrap();
    drop(window);

    let mut window = Window::open(folder.path(), &[]);
    window.wait_for_area("last-session");
    window.click("last-session", [0.3, 0.5]);
    assert!(window.wait_for("opened").ends_with("frames=2"));
    window.wait_for("picture frame=1");
    let (_, after) = window.save(folder.path());
    assert_same(&after, &before);
    assert_eq!((after.image.width, after.image.height), (120, 90));
}

#[test]
fn keys_of_ones_own_are_there_at_the_next_start() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    frames(folder.path());
    let settings = folder.path().join("home/config/sphcast/settings.json");
    std::fs::create_dir_all(settings.parent().unwrap()).unwrap();
    let keys = r#"{"keys": [{"action": "step-forward", "keys": ["Ctrl+J"]}]}"#;
    std::fs::write(&settings, keys).unwrap();
    let mut window = Window::open(folder.path(), &["."]);
    window.key("Right");
    window.key("ctrl+j");
    window.wait_for("picture frame=1");
    window.key("ctrl+j");
    window.wait_for("picture frame=0");
}
