//! The program in a window on a display of its own, with what a user has: mouse, keyboard, eyes.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use renderer::View;

use crate::desktop::Desktop;

/// Software Vulkan on a busy machine takes its time.
pub const PATIENCE: Duration = Duration::from_secs(240);

/// Ends a process with the test, whatever becomes of the test.
pub struct Guard(pub Child);

impl Drop for Guard {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The program in a window of its own display.
pub struct Window {
    pub program: Guard,
    lines: Receiver<String>,
    /// Everything it has written so far.
    pub said: Vec<String>,
    display: String,
    /// By which the X server knows it.
    number: u32,
    _server: Guard,
}

fn installed(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Where cargo puts the program; built if it is not there.
pub fn binary() -> PathBuf {
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
    pub fn open(folder: &Path, arguments: &[&str]) -> Window {
        Window::open_with(folder, arguments, &[])
    }

    /// Opens it with other variables of the environment.
    pub fn open_with(folder: &Path, arguments: &[&str], variables: &[(&str, &Path)]) -> Window {
        let mut window = Window::start(folder, arguments, variables);
        window.wait_for("picture");
        window.settle_down();
        window.wait_for("area timeline 16 550");
        window
    }

    /// Opens it where there is nothing to be seen as yet.
    pub fn open_without_picture(folder: &Path, arguments: &[&str]) -> Window {
        let mut window = Window::start(folder, arguments, &[]);
        window.wait_for("area picture");
        window.settle_down();
        window
    }

    fn start(folder: &Path, arguments: &[&str], variables: &[(&str, &Path)]) -> Window {
        let (server, display) = server();
        // Settings and sessions of whoever runs the tests are none of theirs.
        let home = folder.join("home");
        let mut program = Command::new(binary())
            .args(arguments)
            .arg("--log-events")
            .current_dir(folder)
            .env("DISPLAY", &display)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .env("XDG_CONFIG_HOME", home.join("config"))
            .env("XDG_DATA_HOME", home.join("data"))
            .envs(variables.iter().copied())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let errors = BufReader::new(program.stderr.take().unwrap());
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            errors.lines().map_while(Result::ok).try_for_each(|line| sender.send(line))
        });
        Window { program: Guard(program), lines, said: Vec::new(), display, number: 0, _server: server }
    }

    /// Gives it its size and, as nobody else does without a window manager, the keyboard.
    fn settle_down(&mut self) {
        let number = self.tool(&["search", "--name", "sphcast"]);
        let number = number.lines().last().expect("a window").to_owned();
        self.number = number.parse().unwrap();
        self.tool(&["windowsize", "--sync", &number, "900", "600"]);
        self.tool(&["windowfocus", &number]);
    }

    /// Gives the window another size, in pixels.
    pub fn resize(&mut self, size: [u16; 2]) {
        let [width, height] = size.map(|side| side.to_string());
        self.tool(&["windowsize", "--sync", &self.number.to_string(), &width, &height]);
        self.wait_for("area picture");
    }

    /// The other programs of its desktop.
    pub fn desktop(&self) -> Desktop {
        Desktop::new(&self.display, self.number)
    }

    /// Runs xdotool and returns what it writes.
    pub fn tool(&self, arguments: &[&str]) -> String {
        let output = Command::new("xdotool").args(arguments).env("DISPLAY", &self.display).output().unwrap();
        assert!(output.status.success(), "xdotool {arguments:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Waits for an event that begins with `beginning` and returns the rest of it.
    pub fn wait_for(&mut self, beginning: &str) -> String {
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

    /// Waits until the picture in the window is as fine as it gets.
    pub fn wait_for_full_picture(&mut self) {
        while !self.wait_for("picture").ends_with("full") {}
    }

    /// Waits until it has nothing to say for a while.
    pub fn rest(&mut self) {
        while let Ok(line) = self.lines.recv_timeout(Duration::from_secs(1)) {
            self.said.push(line);
        }
    }

    /// The last known place of an area: x, y, width, height.
    fn area(&self, name: &str) -> [i32; 4] {
        let beginning = format!("event: area {name} ");
        let place = self.said.iter().rev().find_map(|line| line.strip_prefix(&beginning)).expect(name);
        let numbers: Vec<i32> = place.split(' ').map(|number| number.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    }

    /// Waits until an area is known that was not there from the beginning.
    pub fn wait_for_area(&mut self, name: &str) {
        let beginning = format!("area {name} ");
        let known = |line: &String| line.strip_prefix("event: ").is_some_and(|e| e.starts_with(&beginning));
        if !self.said.iter().any(known) {
            self.wait_for(&beginning);
        }
    }

    /// A place inside an area, in shares of its sides.
    pub fn place(&self, name: &str, across: f64, down: f64) -> [String; 2] {
        let [x, y, width, height] = self.area(name).map(f64::from);
        [x + across * width, y + down * height].map(|number| format!("{number:.0}"))
    }

    pub fn point(&self, [x, y]: &[String; 2]) {
        self.tool(&["mousemove", "--sync", x, y]);
        std::thread::sleep(Duration::from_millis(60));
    }

    pub fn click(&self, name: &str, [across, down]: [f64; 2]) {
        self.point(&self.place(name, across, down));
        self.tool(&["click", "1"]);
    }

    /// Opens or folds away sections of the side panel, from above: each moves all that is under it.
    pub fn fold(&mut self, sections: &[&str]) {
        self.rest();
        for section in sections {
            self.click(section, [0.5, 0.5]);
            self.rest();
        }
    }

    pub fn drag(&self, name: &str, from: [f64; 2], to: [f64; 2]) {
        self.point(&self.place(name, from[0], from[1]));
        self.tool(&["mousedown", "1"]);
        for step in 1..=6 {
            let s = f64::from(step) / 6.0;
            let between = |axis: usize| from[axis] + s * (to[axis] - from[axis]);
            self.point(&self.place(name, between(0), between(1)));
        }
        self.tool(&["mouseup", "1"]);
    }

    pub fn key(&self, keys: &str) {
        self.tool(&["key", keys]);
    }

    /// Saves picture and view by the shortcut; returns their paths in `folder`.
    pub fn save(&mut self, folder: &Path) -> (PathBuf, View) {
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
pub fn missing() -> Option<String> {
    let tools = ["Xvfb", "xdotool"];
    let missing: Vec<&str> = tools.into_iter().filter(|tool| !installed(tool)).collect();
    let gpu = renderer::Gpu::new(&renderer::GpuOptions::default()).err();
    match (missing.is_empty(), gpu) {
        (false, _) => Some(format!("{} not installed", missing.join(" and "))),
        (true, Some(error)) => Some(error.to_string()),
        (true, None) => None,
    }
}
