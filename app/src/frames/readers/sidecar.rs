//! `run.json` beside a frame: what the file itself does not say about the run.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use crate::frames::{Frame, Metadata};

/// A sidecar is a page of text; a larger file is something else.
const LARGEST: u64 = 16 << 20;

const KEYS: [&str; 6] =
    ["support_radius", "particle_radius", "particle_mass", "time", "frame_dt", "frame_list"];

/// Fills in what the frame at `path` leaves open from `<stem>.json`, `frame.json` and `run.json`
/// beside it, in this order. A sidecar that cannot be used is a warning of the frame.
pub fn apply(path: &Path, frame: &mut Frame) {
    for sidecar in candidates(path) {
        apply_file(&sidecar, path, frame);
    }
}

fn candidates(path: &Path) -> Vec<PathBuf> {
    let mut candidates = vec![path.with_extension("json"), path.with_file_name("frame.json")];
    candidates.push(path.with_file_name("run.json"));
    candidates.dedup();
    candidates.retain(|candidate| candidate != path);
    candidates
}

/// Fills in from one sidecar; a file that is not there, or is no sidecar, changes nothing.
fn apply_file(sidecar: &Path, path: &Path, frame: &mut Frame) {
    let text = match read(sidecar) {
        Ok(Some(text)) => text,
        Ok(None) => return,
        Err(what) => return frame.warnings.push(format!("{}: {what}", sidecar.display())),
    };
    match serde_json::from_str::<Value>(&text) {
        Ok(Value::Object(object)) if KEYS.iter().any(|key| object.contains_key(*key)) => {
            let mut entries = Entries { object: &object, sidecar, warnings: &mut frame.warnings };
            entries.fill(&mut frame.metadata, frame_number(path));
        }
        Ok(_) => {}
        Err(error) => frame.warnings.push(format!("{}: broken sidecar: {error}", sidecar.display())),
    }
}

fn read(sidecar: &Path) -> Result<Option<String>, String> {
    let Ok(metadata) = sidecar.metadata() else { return Ok(None) };
    if !metadata.is_file() || metadata.len() > LARGEST {
        return Ok(None);
    }
    let mut text = String::new();
    let file = File::open(sidecar).map_err(|error| format!("sidecar cannot be read: {error}"))?;
    file.take(LARGEST).read_to_string(&mut text).map_err(|error| format!("broken sidecar: {error}"))?;
    Ok(Some(text))
}

/// The number at the end of a name: 16 of `ParticleData_Fluid_16.vtk`.
fn frame_number(path: &Path) -> Option<u64> {
    let stem = path.file_stem()?.to_str()?;
    let digits = stem.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    stem[digits..].parse().ok()
}

struct Entries<'a> {
    object: &'a Map<String, Value>,
    sidecar: &'a Path,
    warnings: &'a mut Vec<String>,
}

impl Entries<'_> {
    fn fill(&mut self, metadata: &mut Metadata, frame: Option<u64>) {
        let length = |value: f64| value > 0.0;
        for (key, slot) in [
            ("support_radius", &mut metadata.support_radius),
            ("particle_radius", &mut metadata.particle_radius),
            ("particle_mass", &mut metadata.particle_mass),
        ] {
            if slot.is_none() {
                *slot = self.number(self.object, key, "a positive number", length);
            }
        }
        if metadata.time.is_none() {
            metadata.time = self.number(self.object, "time", "a number", |_| true);
        }
        // `frame_dt` alone is no time: it is not said which frame is the first.
        if let (None, Some(entry)) = (metadata.time, frame.and_then(|frame| self.entry(frame))) {
            metadata.time = self.number(entry, "time", "a number", |_| true);
        }
    }

    /// The entry of the list `frame_list` that has this number.
    fn entry<'b>(&self, frame: u64) -> Option<&'b Map<String, Value>>
    where
        Self: 'b,
    {
        let frames = self.object.get("frame_list")?.as_array()?;
        let is_frame =
            |entry: &&Map<String, Value>| entry.get("frame").and_then(Value::as_u64) == Some(frame);
        frames.iter().filter_map(Value::as_object).find(is_frame)
    }

    fn number(
        &mut self,
        object: &Map<String, Value>,
        key: &str,
        expected: &str,
        good: impl Fn(f64) -> bool,
    ) -> Option<f64> {
        let value = object.get(key)?;
        let number = value.as_f64().filter(|&number| number.is_finite() && good(number));
        if number.is_none() && !value.is_null() {
            let sidecar = self.sidecar.display();
            self.warnings.push(format!("{sidecar}: `{key}` is {value}, expected {expected}; it is left out"));
        }
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Column;

    fn frame_beside(files: &[(&str, &str)], name: &str) -> Frame {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let mut frame =
            Frame::new(Column::new(3, vec![0.0f32; 3]).unwrap(), Vec::new(), Metadata::default()).unwrap();
        apply(&folder.path().join(name), &mut frame);
        frame
    }

    #[test]
    fn the_nearer_sidecar_wins_and_the_list_gives_the_time() {
        let run = r#"{"support_radius": 0.1, "particle_mass": 2, "frame_dt": 0.5,
                      "frame_list": [{"frame": 1, "time": 0}, {"frame": 12, "time": 5.5}]}"#;
        let frame =
            frame_beside(&[("run.json", run), ("f_12.json", r#"{"support_radius": 0.2}"#)], "f_12.vtk");
        assert_eq!(frame.metadata.support_radius, Some(0.2));
        assert_eq!(frame.metadata.particle_mass, Some(2.0));
        assert_eq!(frame.metadata.time, Some(5.5));
        assert_eq!(frame_beside(&[("run.json", run)], "f_13.vtk").metadata.time, None);
    }

    #[test]
    fn what_cannot_be_used_is_a_warning_that_names_the_file() {
        for text in
            [r#"{"support_radius": "#, r#"{"support_radius": -1}"#, r#"{"support_radius": "a"}"#, "\u{0}"]
        {
            let frame = frame_beside(&[("run.json", text)], "a.csv");
            assert_eq!(frame.metadata, Metadata::default(), "{text}");
            assert!(frame.warnings.len() == 1 && frame.warnings[0].contains("run.json"), "{text}");
        }
    }

    #[test]
    fn other_json_is_left_alone() {
        for text in ["[]", "{}", r#"{"Configuration": 1}"#, "3"] {
            assert!(frame_beside(&[("run.json", text)], "a.csv").warnings.is_empty());
        }
        let deep = "[".repeat(100_000);
        assert_eq!(frame_beside(&[("run.json", &deep)], "a.csv").warnings.len(), 1);
    }
}
