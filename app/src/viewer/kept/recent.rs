//! The runs that were open, latest first.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::Kept;
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

    pub fn remove(&mut self, paths: &[PathBuf]) {
        self.runs.retain(|known| known.paths != paths);
    }
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
}
