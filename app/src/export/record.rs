//! What a picture was made from, kept in its file: so that one that is there can be told from one that
//! would look different.

use std::time::UNIX_EPOCH;

use renderer::View;
use serde_json::{Value, json};

use crate::frames::Source;

/// The record of the picture that `view` makes of `source`, frame `number` of its run: ASCII on one line.
///
/// `frames` are those of the whole run, where the camera goes by how many there are.
///
/// A file counts as the same while its name, size and time of change are; its folder may be another one,
/// as it is on another computer of a cluster. Numbers are those of `view.json`, so every setting counts.
pub fn of(view: &View, source: &Source, number: usize, frames: Option<usize>, channels: &[&str]) -> String {
    let file = source.path().and_then(|path| path.metadata().ok());
    let changed = file.as_ref().and_then(|file| file.modified().ok()?.duration_since(UNIX_EPOCH).ok());
    let name = source.path().and_then(|path| path.file_name());
    let name = name.map_or_else(|| source.name.clone(), |name| name.to_string_lossy().into_owned());
    let record = json!({
        "program": concat!("sphcast ", env!("CARGO_PKG_VERSION")),
        "frame": {
            "number": number,
            "name": name,
            "bytes": file.map(|file| file.len()),
            "changed": changed.map(|time| time.as_nanos() as u64),
        },
        "frames": frames,
        "channels": channels,
        "view": serde_json::to_value(view).unwrap_or(Value::Null),
    });
    record.to_string().chars().map(escaped).collect()
}

/// A character as JSON writes it in ASCII: inside a string, where alone others may stand.
fn escaped(character: char) -> String {
    if character.is_ascii() {
        return character.into();
    }
    let mut units = [0; 2];
    character.encode_utf16(&mut units).iter().map(|unit| format!("\\u{unit:04x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Sequence;

    #[test]
    fn whatever_changes_the_picture_changes_the_record() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("fläche_1.csv");
        let source = |text: &str| {
            std::fs::write(&path, text).unwrap();
            Sequence::open(std::slice::from_ref(&path)).unwrap().sources()[0].clone()
        };
        let view = View::default();
        let mut coarser = view.clone();
        coarser.sampling.tolerance = Some(0.005);
        let here = source("x,y,z\n0,0,0\n");
        let first = of(&view, &here, 0, None, &[]);
        assert!(first.is_ascii() && serde_json::from_str::<Value>(&first).unwrap()["frame"]["bytes"] == 12);
        let elsewhere = tempfile::tempdir().unwrap();
        let copy = elsewhere.path().join("fläche_1.csv");
        std::fs::copy(&path, &copy).unwrap();
        let changed = path.metadata().unwrap().modified().unwrap();
        std::fs::File::options().write(true).open(&copy).unwrap().set_modified(changed).unwrap();
        let there = Sequence::open(&[copy]).unwrap().sources()[0].clone();
        assert_eq!(first, of(&view, &there, 0, None, &[]), "a copy in another folder");
        for other in [
            of(&coarser, &here, 0, None, &[]),
            of(&view, &here, 0, Some(7), &[]),
            of(&view, &here, 1, None, &[]),
            of(&view, &here, 0, None, &["predicted_error"]),
            of(&view, &source("x,y,z\n0,0,0\n1,1,1\n"), 0, None, &[]),
        ] {
            assert_ne!(first, other);
        }
    }
}
