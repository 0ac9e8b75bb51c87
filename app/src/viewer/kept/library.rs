//! Transfer functions that the user has saved under a name, each a file in the platform's place for data.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, ensure};
use renderer::TransferView;

use crate::io_error::describe;
use crate::places;
use crate::whole_file::write_whole;

/// A saved function.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    pub name: String,
    pub transfer: TransferView,
}

/// The folder of the files; `None` for a user without a home.
pub fn folder() -> Option<PathBuf> {
    places::data().map(|data| data.join("transfer functions"))
}

/// The functions in `folder` by name, and what is wrong with the files that are none.
pub fn list(folder: &Path) -> (Vec<Saved>, Vec<String>) {
    let (mut saved, mut wrong) = (Vec::new(), Vec::new());
    // A folder that is not there holds nothing.
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()) {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let Some(name) = name.filter(|_| path.extension().is_some_and(|ending| ending == "json")) else {
            continue;
        };
        match read(&path) {
            Ok(transfer) => saved.push(Saved { name, transfer }),
            Err(error) => wrong.push(format!("{error:#}")),
        }
    }
    saved.sort_by_key(|function| function.name.to_lowercase());
    (saved, wrong)
}

fn read(path: &Path) -> anyhow::Result<TransferView> {
    let name = || path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| anyhow!(describe(&error))).with_context(name)?;
    let transfer: TransferView = serde_json::from_str(&text).with_context(name)?;
    transfer.function().with_context(name)?;
    Ok(transfer)
}

/// Saves `transfer` as `name`, in the place of one that has it. The length that opacities belong to is the
/// run's, and no part of it.
///
/// # Errors
/// A name that is no file's, or whatever the system has against the file.
pub fn save(folder: &Path, name: &str, transfer: &TransferView) -> anyhow::Result<()> {
    let path = path(folder, name)?;
    let transfer = TransferView { reference_length: None, ..transfer.clone() };
    std::fs::create_dir_all(folder)
        .map_err(|error| anyhow!(describe(&error)))
        .with_context(|| folder.display().to_string())?;
    let text = serde_json::to_string_pretty(&transfer)?;
    write_whole(&path, text.as_bytes())
}

/// Deletes what was saved as `name`.
///
/// # Errors
/// Whatever the system has against it.
pub fn delete(folder: &Path, name: &str) -> anyhow::Result<()> {
    let path = path(folder, name)?;
    std::fs::remove_file(&path)
        .map_err(|error| anyhow!(describe(&error)))
        .with_context(|| path.display().to_string())
}

fn path(folder: &Path, name: &str) -> anyhow::Result<PathBuf> {
    let plain = |c: char| !c.is_control() && !"/\\:*?\"<>|".contains(c);
    let possible = !name.trim().is_empty() && name.chars().all(plain) && !name.starts_with('.');
    ensure!(possible && name.len() <= 100, "`{name}` cannot be the name of a file");
    Ok(folder.join(format!("{}.json", name.trim())))
}

#[cfg(test)]
mod tests {
    use renderer::MapView;

    use super::*;

    #[test]
    fn what_is_saved_is_listed_until_it_is_deleted() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("not there yet");
        assert_eq!(list(&folder), (Vec::new(), Vec::new()));
        let transfer = TransferView { map: Some(MapView::named("vik")), ..TransferView::default() };
        let long = TransferView { reference_length: Some(3.0), ..transfer.clone() };
        save(&folder, "Thin shell", &long).unwrap();
        save(&folder, "another", &TransferView::default()).unwrap();
        let (saved, wrong) = list(&folder);
        assert_eq!(saved.iter().map(|one| one.name.as_str()).collect::<Vec<_>>(), ["another", "Thin shell"]);
        assert_eq!((saved[1].transfer.clone(), wrong.len()), (transfer, 0));
        delete(&folder, "Thin shell").unwrap();
        assert_eq!(list(&folder).0.len(), 1);
        assert!(delete(&folder, "Thin shell").is_err());
    }

    #[test]
    fn a_broken_file_is_told_and_the_others_go_on() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path();
        save(folder, "good", &TransferView::default()).unwrap();
        std::fs::write(folder.join("bad.json"), "{\"points\": [").unwrap();
        std::fs::write(folder.join("unknown.json"), "{\"map\": {\"name\": \"jet\"}}").unwrap();
        std::fs::write(folder.join("notes.txt"), "no function").unwrap();
        let (saved, mut wrong) = list(folder);
        wrong.sort();
        assert_eq!(saved.len(), 1);
        assert_eq!(wrong.len(), 2);
        assert!(
            wrong[0].contains("bad.json") && wrong[1].contains("unknown.json: transfer.map.name"),
            "{wrong:?}"
        );
    }

    #[test]
    fn names_stay_in_the_folder() {
        let root = tempfile::tempdir().unwrap();
        for name in ["", "  ", "../up", "a/b", ".hidden", "c:\\d"] {
            assert!(save(root.path(), name, &TransferView::default()).is_err(), "{name}");
        }
    }
}
