//! The system's file dialogs: a `zenity` that answers as it is told, and a system without any.

use std::fs::{create_dir, remove_file, write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use crate::harness::{Window, missing};
use crate::system::{another_view, assert_same, frames};

/// Opens the window where programs are looked for in one folder alone, and no portal answers.
fn open(folder: &Path, programs: &Path) -> Window {
    let bus = PathBuf::from(format!("unix:path={}", folder.join("no bus").display()));
    let variables = [("PATH", programs), ("DBUS_SESSION_BUS_ADDRESS", &bus)];
    Window::open_with(folder, &["demo", "--size", "120x90"], &variables)
}

/// A zenity that chooses what the file `answer` says, and is closed without a choice where there is
/// no such file.
pub struct Zenity {
    programs: PathBuf,
    answer: PathBuf,
}

impl Zenity {
    pub fn new(folder: &Path) -> Zenity {
        let (programs, answer) = (folder.join("programs"), folder.join("answer"));
        create_dir(&programs).unwrap();
        let path = programs.join("zenity");
        write(&path, format!("#!/bin/sh\nread -r line < '{}' && echo \"$line\"\n", answer.display()))
            .unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
        Zenity { programs, answer }
    }

    pub fn choose(&self, path: &Path) {
        write(&self.answer, format!("{}\n", path.display())).unwrap();
    }

    /// Opens the window on the demo.
    pub fn open(&self, folder: &Path) -> Window {
        open(folder, &self.programs)
    }
}

#[test]
fn what_a_dialog_chooses_is_opened_loaded_and_saved() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    create_dir(&run).unwrap();
    let zenity = Zenity::new(folder.path());
    let choose = |path: &Path| zenity.choose(path);
    let mut window = zenity.open(folder.path());

    window.key("ctrl+o");
    window.wait_for("dialog closed");
    let [first, second] = frames(&run);
    choose(Path::new(&format!("{}|{}", first.display(), second.display())));
    window.key("ctrl+o");
    assert!(window.wait_for("opened").ends_with("frames=2"));
    choose(&first);
    window.key("ctrl+o");
    assert!(window.wait_for("opened").ends_with("frames=1"));
    choose(&run);
    window.key("ctrl+shift+o");
    assert!(window.wait_for("opened").ends_with("frames=2"));
    window.wait_for("picture frame=0");

    let (_, view) = window.save(folder.path());
    let (path, other) = another_view(folder.path(), &view);
    choose(&path);
    window.key("ctrl+l");
    window.wait_for("loaded");
    window.wait_for("picture frame=0");

    // The ending is added where it is missing, and decides the format of a picture.
    let mine = folder.path().join("mine");
    choose(&mine);
    window.key("ctrl+s");
    window.wait_for("saved");
    let text = std::fs::read_to_string(mine.with_extension("json")).unwrap();
    assert_same(&renderer::View::from_json(&text).unwrap(), &other);
    for (chosen, written) in [("mine", "mine.png"), ("mine.exr", "mine.exr")] {
        choose(&folder.path().join(chosen));
        window.key("ctrl+e");
        assert!(window.wait_for("saved").ends_with(written));
        let picture = sphcast::image_file::read(&folder.path().join(written)).unwrap();
        assert_eq!((picture.width, picture.height), (120, 90));
    }

    remove_file(&zenity.answer).unwrap();
    window.key("ctrl+s");
    window.wait_for("dialog closed");
    assert!(!window.said.iter().any(|line| line.starts_with("event: error")), "{:#?}", window.said);
}

#[test]
fn without_any_dialog_it_says_what_to_do() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut window = open(folder.path(), folder.path());
    for keys in ["ctrl+o", "ctrl+shift+o", "ctrl+l", "ctrl+s", "ctrl+e"] {
        window.key(keys);
        let error = window.wait_for("error");
        for way in ["zenity", "drop", "command line", "Ctrl+Shift+E"] {
            assert!(error.contains(way), "{keys}: {error}");
        }
    }
}
