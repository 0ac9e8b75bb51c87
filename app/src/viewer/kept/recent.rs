//! The runs that were open, latest first.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Kept, read, write};
use crate::places;

/// A run that was open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recent {
    /// What it was opened by: absolute, or the name of a generated run.
    pub paths: Vec<PathBuf>,
    pub title: String,
    pub frames: usize,
    /// Seconds since 1970.
    pub when: u64,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct RecentRuns {
    pub runs: Vec<Recent>,
}

const MOST: usize = 12;

impl RecentRuns {
    /// Puts a run first; one by the same paths is the same.
    pub fn add(&mut self, run: Recent) {
        self.remove(&run.paths);
        self.runs.insert(0, run);
        self.runs.truncate(MOST);
    }

    /// Changes the list in its file, to which other windows write, too.
    ///
    /// # Errors
    /// Those of the file; the path comes first.
    pub fn change(change: impl FnOnce(&mut RecentRuns)) -> anyhow::Result<()> {
        match RecentRuns::folder() {
            Some(folder) => change_in(&folder.join(RecentRuns::FILE), change),
            None => Ok(()),
        }
    }

    pub fn remove(&mut self, paths: &[PathBuf]) {
        self.runs.retain(|known| known.paths != paths);
    }
}

fn change_in(path: &Path, change: impl FnOnce(&mut RecentRuns)) -> anyhow::Result<()> {
    let mut recent = read::<RecentRuns>(path)?.unwrap_or_default();
    change(&mut recent);
    write(path, &recent)
}

impl Kept for RecentRuns {
    const FILE: &'static str = "recent.json";

    fn folder() -> Option<PathBuf> {
        places::data()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(name: &str, when: u64) -> Recent {
        Recent { paths: vec![name.into()], title: name.into(), frames: 1, when }
    }

    #[test]
    fn the_latest_comes_first_and_none_twice() {
        let mut recent = RecentRuns::default();
        for when in 0..20 {
            recent.add(run(&format!("run {}", when % 15), when));
        }
        assert_eq!(recent.runs.len(), MOST);
        assert_eq!((recent.runs[0].title.as_str(), recent.runs[0].when), ("run 4", 19));
        let same = recent.runs.iter().filter(|run| run.title == "run 4").count();
        assert_eq!(same, 1);
    }

    #[test]
    fn two_windows_write_one_list() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("recent.json");
        for (when, name) in ["first", "second", "third"].into_iter().enumerate() {
            change_in(&path, |recent| recent.add(run(name, when as u64))).unwrap();
        }
        change_in(&path, |recent| recent.remove(&["second".into()])).unwrap();
        let recent = read::<RecentRuns>(&path).unwrap().unwrap();
        let titles: Vec<&str> = recent.runs.iter().map(|run| run.title.as_str()).collect();
        assert_eq!(titles, ["third", "first"]);
    }
}
