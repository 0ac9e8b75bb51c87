//! The real window, driven by a real mouse and keyboard under Xvfb, with whatever Vulkan there is.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use renderer::View;

/// Software Vulkan on a busy machine takes its time.
const PATIENCE: Duration = Duration::from_secs(240);

/// Ends a process with the test, whatever becomes of the test.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The program in a window of its own display.
struct Window {
    program: Guard,
    lines: Receiver<String>,
    /// Everything it has written so far.
    said: Vec<String>,
    display: String,
    _server: Guard,
}

fn installed(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Where cargo puts the program; built if it is not there.
fn binary() -> PathBuf {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["build", "-p", "sphcast", "--bin", "sphcast", "--message-format", "json"];
    let output = Command::new(cargo).args(arguments).stderr(Stdio::inherit()).output().unwrap();
    assert!(output.status.success(), "the program does not build");
    let text = String::from_utf8(output.stdout).unwrap();
    let executable = text.lines().rev().find_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        Some(PathBuf::from(message.get("executable")?.as_str()?))
    });
    executable.expect("cargo names the program")
}

/// An X server on a display that nobody has.
fn server() -> (Guard, String) {
    let mut server = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut number = String::new();
    BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
    (Guard(server), format!(":{}", number.trim()))
}

impl Window {
    fn open(folder: &Path, arguments: &[&str]) -> Window {
        let (server, display) = server();
        let mut program = Command::new(binary())
            .args(arguments)
            .arg("--log-events")
            .current_dir(folder)
            .env("DISPLAY", &display)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let errors = BufReader::new(program.stderr.take().unwrap());
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            errors.lines().map_while(Result::ok).try_for_each(|line| sender.send(line))
        });
        let mut window =
            Window { program: Guard(program), lines, said: Vec::new(), display, _server: server };
        window.wait_for("picture");
        // Without a window manager, nobody else gives it the keyboard.
        let number = window.tool(&["search", "--name", "sphcast"]);
        let number = number.lines().last().expect("a window").to_owned();
        window.tool(&["windowsize", "--sync", &number, "900", "600"]);
        window.tool(&["windowfocus", &number]);
        window.wait_for("area timeline 16 550");
        window
    }

    /// Runs xdotool and returns what it writes.
    fn tool(&self, arguments: &[&str]) -> String {
        let output = Command::new("xdotool").args(arguments).env("DISPLAY", &self.display).output().unwrap();
        assert!(output.status.success(), "xdotool {arguments:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Waits for an event that begins with `beginning` and returns the rest of it.
    fn wait_for(&mut self, beginning: &str) -> String {
        let limit = Instant::now() + PATIENCE;
        loop {
            let left = limit.saturating_duration_since(Instant::now());
            let line = match self.lines.recv_timeout(left) {
                Ok(line) => line,
                Err(RecvTimeoutError::Timeout) => panic!("no `{beginning}` after {:#?}", self.said),
                Err(RecvTimeoutError::Disconnected) => panic!("the program ended after {:#?}", self.said),
            };
            self.said.push(line.clone());
            if let Some(event) = line.strip_prefix("event: ")
                && let Some(rest) = event.strip_prefix(beginning)
            {
                return rest.trim().to_owned();
            }
        }
    }

    /// The last known place of an area: x, y, width, height.
    fn area(&self, name: &str) -> [i32; 4] {
        let beginning = format!("event: area {name} ");
        let place = self.said.iter().rev().find_map(|line| line.strip_prefix(&beginning)).expect(name);
        let numbers: Vec<i32> = place.split(' ').map(|number| number.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    }

    /// A place inside an area, in shares of its sides.
    fn place(&self, name: &str, across: f64, down: f64) -> [String; 2] {
        let [x, y, width, height] = self.area(name).map(f64::from);
        [x + across * width, y + down * height].map(|number| format!("{number:.0}"))
    }

    fn point(&self, [x, y]: &[String; 2]) {
        self.tool(&["mousemove", "--sync", x, y]);
        std::thread::sleep(Duration::from_millis(60));
    }

    fn drag(&self, name: &str, from: [f64; 2], to: [f64; 2]) {
        self.point(&self.place(name, from[0], from[1]));
        self.tool(&["mousedown", "1"]);
        for step in 1..=6 {
            let s = f64::from(step) / 6.0;
            let between = |axis: usize| from[axis] + s * (to[axis] - from[axis]);
            self.point(&self.place(name, between(0), between(1)));
        }
        self.tool(&["mouseup", "1"]);
    }

    fn key(&self, keys: &str) {
        self.tool(&["key", keys]);
    }

    /// Saves picture and view by the shortcut; returns their paths in `folder`.
    fn save(&mut self, folder: &Path) -> (PathBuf, View) {
        self.key("ctrl+shift+e");
        let mut paths = Vec::new();
        while paths.len() < 2 {
            paths.push(self.wait_for("saved"));
        }
        let path = |ending: &str| folder.join(paths.iter().find(|path| path.ends_with(ending)).unwrap());
        let view = std::fs::read_to_string(path("json")).unwrap();
        (path("png"), View::from_json(&view).unwrap())
    }
}

/// Why the tests of this file cannot run here.
fn missing() -> Option<String> {
    let tools = ["Xvfb", "xdotool"];
    let missing: Vec<&str> = tools.into_iter().filter(|tool| !installed(tool)).collect();
    let gpu = renderer::Gpu::new(&renderer::GpuOptions::default()).err();
    match (missing.is_empty(), gpu) {
        (false, _) => Some(format!("{} not installed", missing.join(" and "))),
        (true, Some(error)) => Some(error.to_string()),
        (true, None) => None,
    }
}

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
