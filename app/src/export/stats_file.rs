//! `--stats`: what the pictures cost, in a file that is whole at any time, or on standard output at the end.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use renderer::Stats;
use serde_json::Value;

use crate::say::say;
use crate::whole_file::{is_stream, write_whole};

/// Stats of the pictures so far.
pub struct StatsFile {
    path: PathBuf,
    /// Whether `path` is a stream, whose reader wants the whole once.
    at_end: bool,
    /// Whether the file holds an array; else the stats of an only picture.
    several: bool,
    /// By the number of the frame.
    entries: BTreeMap<usize, Value>,
    /// Of pictures that an earlier run of the program made, until it shows that they are still good.
    before: BTreeMap<usize, Value>,
}

/// Key of a frame's number in an array.
const FRAME: &str = "frame";

/// In place of a file's name: standard output.
const STANDARD_OUTPUT: &str = "-";

impl StatsFile {
    /// Whether `path` stands for standard output.
    pub fn is_standard_output(path: &Path) -> bool {
        path.as_os_str() == STANDARD_OUTPUT
    }

    /// With `resumes`, what a file at `path` says of pictures that are left as they are stays there.
    pub fn new(path: PathBuf, several: bool, resumes: bool) -> StatsFile {
        let at_end = StatsFile::is_standard_output(&path) || is_stream(&path);
        // Nobody reads from a stream that is to be written: a pipe would wait for ever.
        let is_there = resumes && !at_end;
        let text = if is_there { std::fs::read_to_string(&path).unwrap_or_default() } else { String::new() };
        // A file that is not one of ours says nothing, and is written anew.
        let before: Vec<Value> = serde_json::from_str(&text).unwrap_or_default();
        let numbered = |entry: Value| Some((entry.get(FRAME)?.as_u64()? as usize, entry));
        let before = before.into_iter().filter_map(numbered).collect();
        StatsFile { path, at_end, several, entries: BTreeMap::new(), before }
    }

    /// Takes the stats of frame `number` in.
    pub fn add(&mut self, number: usize, stats: &Stats) -> anyhow::Result<()> {
        let mut entry = serde_json::to_value(stats)?;
        if let (true, Some(entry)) = (self.several, entry.as_object_mut()) {
            entry.insert(FRAME.to_owned(), number.into());
        }
        self.entries.insert(number, entry);
        if self.at_end { Ok(()) } else { self.write() }
    }

    /// Keeps what the file said of frame `number`.
    pub fn keep(&mut self, number: usize) {
        if let Some(entry) = self.before.remove(&number) {
            self.entries.insert(number, entry);
        }
    }

    /// Writes what there is.
    pub fn write(&self) -> anyhow::Result<()> {
        let entries: Vec<&Value> = self.entries.values().collect();
        let text = match (self.several, entries.as_slice()) {
            (false, [only]) => serde_json::to_string_pretty(only),
            // The only picture is left as it is, and so is what was said of it.
            (false, _) => return Ok(()),
            (true, entries) => serde_json::to_string_pretty(entries),
        };
        let text = format!("{}\n", text?);
        if StatsFile::is_standard_output(&self.path) {
            return say(text);
        }
        write_whole(&self.path, text.as_bytes())
    }
}
