//! The program, called as its users do, in folders of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use super::files::write_vtk;

/// The program. Cargo builds binaries for the tests of their own package only, and this package has
/// none: so the first test asks cargo for it, which is quick where it is built already.
pub fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut build = Command::new(cargo);
        build.args(["build", "-p", "sphcast", "--bin", "sphcast", "--message-format", "json"]);
        if !cfg!(debug_assertions) {
            build.arg("--release");
        }
        build.current_dir(env!("CARGO_MANIFEST_DIR")).stderr(Stdio::inherit());
        let output = build.output().expect("cargo runs");
        assert!(output.status.success(), "the program does not build");
        let messages = String::from_utf8(output.stdout).unwrap();
        let executable = messages.lines().find_map(|line| {
            let message: serde_json::Value = serde_json::from_str(line).ok()?;
            message["executable"].as_str().map(PathBuf::from)
        });
        executable.expect("cargo names the executable")
    })
}

pub struct Outcome {
    pub status: i32,
    pub out: String,
    pub err: String,
}

impl Outcome {
    /// The one error line, without its `error: `.
    pub fn error(&self) -> &str {
        let errors: Vec<&str> = self.err.lines().filter_map(|line| line.strip_prefix("error: ")).collect();
        let [error] = errors[..] else { panic!("not one error line: {}", self.err) };
        error
    }
}

pub fn sphcast(folder: &Path, arguments: &[&str]) -> Outcome {
    let mut command = Command::new(program());
    // A Wayland library complains on standard error where there is no such folder.
    command.args(arguments).current_dir(folder).env("XDG_RUNTIME_DIR", folder);
    let output = command.output().unwrap();
    Outcome {
        status: output.status.code().expect("not killed by a signal"),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A folder with `run/frame_1.vtk` to `_3`, the second of them cut short, and `one.vtk`.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("run")).unwrap();
    for number in 1..=3 {
        write_vtk(&folder.path().join(format!("run/frame_{number}.vtk")), 20, true);
    }
    let second = folder.path().join("run/frame_2.vtk");
    let whole = fs::read(&second).unwrap();
    fs::write(second, &whole[..whole.len() / 2]).unwrap();
    write_vtk(&folder.path().join("one.vtk"), 20, true);
    folder
}

/// All files below `folder`, sorted.
pub fn files_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
