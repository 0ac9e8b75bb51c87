//! Runs that are still being written: what has changed on the disk since the last look.
//!
//! Looks again and again instead of being told by the system, which network file systems do not do.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use super::{Sequence, Source};

/// Looks after the files that the arguments of a run name.
pub struct Watcher {
    arguments: Vec<PathBuf>,
    /// The frames that are shown, in their order.
    sequence: Sequence,
    files: HashMap<PathBuf, File>,
    /// Whether the files of the run were looked at before.
    began: bool,
}

/// What differs from the look before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// New frames with the places that they have from now on, which ascend.
    pub added: Vec<(usize, Arc<Source>)>,
    /// Files that were written again, or were perhaps not whole when they were read.
    pub changed: Vec<PathBuf>,
    /// Files that are not there any more.
    pub vanished: Vec<PathBuf>,
    /// Files that somebody may be writing at the moment.
    pub unsettled: HashSet<PathBuf>,
}

/// A file of the run.
struct File {
    /// As it was at the last look; `None` where it was not there.
    stamp: Option<Stamp>,
    /// Whether it may be still in the making.
    unsettled: bool,
    /// Whether it is a frame of the run, and not only about to become one.
    shown: bool,
}

/// Size in bytes and time of the last change.
type Stamp = (u64, Option<SystemTime>);

/// A file that was changed within this time before the first look may be half written.
const YOUNG: Duration = Duration::from_secs(10);
/// A file that was changed within this time is not done, although it was the same at two looks: solvers
/// pause between two arrays.
const FRESH: Duration = Duration::from_secs(5);

impl Watcher {
    /// For the run that `arguments` named when it was opened, with the frames of `known`.
    pub fn new(arguments: Vec<PathBuf>, known: &Sequence) -> Watcher {
        let file = |path: &Path| (path.to_owned(), File { stamp: None, unsettled: false, shown: true });
        let files = known.sources().iter().filter_map(|source| source.path()).map(file).collect();
        Watcher { arguments, sequence: known.clone(), files, began: false }
    }

    /// Whether there is any file to look at, or to come.
    pub fn is_idle(&self) -> bool {
        self.files.is_empty() && !self.sequence.may_grow()
    }

    /// Looks at all files, and for new ones. Waits for the disk.
    pub fn look(&mut self, now: SystemTime) -> Changes {
        let mut changes = Changes::default();
        for (path, file) in &mut self.files {
            file.look(path, now, self.began, &mut changes);
        }
        self.began = true;
        self.find(&mut changes);
        let unsettled = self.files.iter().filter(|(_, file)| file.unsettled && file.shown);
        changes.unsettled = unsettled.map(|(path, _)| path.clone()).collect();
        changes
    }

    /// Finds files that are new. One becomes a frame once it is the same at two looks, and not fresh.
    fn find(&mut self, changes: &mut Changes) {
        // What cannot be listed now may be there at the next look.
        let known = |path: &Path| self.files.get(path).is_some_and(|file| file.shown);
        let Ok(found) = Sequence::open_growing(&self.arguments, &known) else { return };
        let paths = || found.sources().iter().filter_map(|source| source.path());
        if !self.sequence.is_empty() && !paths().any(known) {
            // All that was shown is gone: what is there now is another run.
            return;
        }
        let mut new = HashSet::new();
        for path in paths() {
            match self.files.get_mut(path) {
                Some(file) if !file.shown && !file.unsettled => {
                    file.shown = true;
                    new.insert(path);
                }
                Some(_) => {}
                None => {
                    let file = File { stamp: stamp(path), unsettled: true, shown: false };
                    self.files.insert(path.to_owned(), file);
                }
            }
        }
        if !new.is_empty() {
            let is_new = |source: &Source| source.path().is_some_and(|path| new.contains(path));
            changes.added = self.sequence.places(&found, is_new);
            self.sequence.insert(&changes.added);
        }
    }
}

impl File {
    fn look(&mut self, path: &Path, now: SystemTime, began: bool, changes: &mut Changes) {
        let (before, stamp) = (self.stamp, stamp(path));
        self.stamp = stamp;
        match stamp {
            None if before.is_some() && self.shown => {
                self.unsettled = false;
                changes.vanished.push(path.to_owned());
            }
            None => {}
            Some((_, time)) if !began => {
                let age = time.and_then(|time| now.duration_since(time).ok());
                self.unsettled = age.is_none_or(|age| age < YOUNG);
            }
            Some(_) if stamp != before => self.unsettled = true,
            // Some make a file first and write it later.
            Some((0, _)) if !self.shown => {}
            Some((_, Some(time))) if now.duration_since(time).is_ok_and(|age| age < FRESH) => {}
            Some(_) if self.unsettled => {
                self.unsettled = false;
                if self.shown {
                    changes.changed.push(path.to_owned());
                }
            }
            Some(_) => {}
        }
    }
}

fn stamp(path: &Path) -> Option<Stamp> {
    let file = path.metadata().ok()?;
    Some((file.len(), file.modified().ok()))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Folder(tempfile::TempDir);

    impl Folder {
        fn with(names: &[&str]) -> Folder {
            let folder = Folder(tempfile::tempdir().unwrap());
            names.iter().for_each(|name| folder.write(name, "x,y,z\n0,0,0\n"));
            folder
        }

        fn path(&self, name: &str) -> PathBuf {
            self.0.path().join(name)
        }

        fn write(&self, name: &str, text: &str) {
            std::fs::write(self.path(name), text).unwrap();
        }

        fn watcher(&self) -> Watcher {
            let arguments = vec![self.0.path().to_owned()];
            let known = Sequence::open(&arguments).unwrap();
            Watcher::new(arguments, &known)
        }
    }

    /// Long after everything was written.
    fn later() -> SystemTime {
        SystemTime::now() + Duration::from_secs(3600)
    }

    fn name(source: &Source) -> String {
        source.path().unwrap().file_name().unwrap().to_string_lossy().into_owned()
    }

    fn names(added: &[(usize, Arc<Source>)]) -> Vec<String> {
        added.iter().map(|(_, source)| name(source)).collect()
    }

    /// What is shown after all that was found since the run was opened.
    fn shown(watcher: &mut Watcher, known: &mut Sequence) -> Vec<String> {
        (0..2).for_each(|_| {
            known.insert(&watcher.look(later()).added);
        });
        known.sources().iter().map(|source| name(source)).collect()
    }

    #[test]
    fn a_run_at_rest_does_not_change() {
        let folder = Folder::with(&["a_1.csv", "a_2.csv"]);
        let mut watcher = folder.watcher();
        for _ in 0..3 {
            assert_eq!(watcher.look(later()), Changes::default());
        }
    }

    #[test]
    fn new_frames_come_once_they_are_whole_and_in_order() {
        let folder = Folder::with(&["a_1.csv"]);
        let mut watcher = folder.watcher();
        watcher.look(later());
        folder.write("a_10.csv", "");
        folder.write("a_9.csv", "x,y,z\n");
        folder.write("notes.txt", "no frame");
        assert!(watcher.look(later()).added.is_empty(), "seen for the first time");
        folder.write("a_9.csv", "x,y,z\n0,0,0\n");
        assert!(watcher.look(later()).added.is_empty(), "one grows, the other is empty");
        folder.write("a_10.csv", "x,y,z\n0,0,0\n");
        assert_eq!(names(&watcher.look(later()).added), ["a_9.csv"]);
        assert_eq!(names(&watcher.look(later()).added), ["a_10.csv"]);
        assert_eq!(watcher.look(later()), Changes::default());
    }

    #[test]
    fn a_file_that_is_written_again_is_told_when_that_is_over() {
        let folder = Folder::with(&["a_1.csv", "a_2.csv"]);
        let mut watcher = folder.watcher();
        watcher.look(later());
        folder.write("a_2.csv", "x,y,z\n1,");
        let writing = watcher.look(later());
        assert!(writing.changed.is_empty() && writing.unsettled.contains(&folder.path("a_2.csv")));
        folder.write("a_2.csv", "x,y,z\n1,1,1\n2,2,2\n");
        assert!(watcher.look(later()).changed.is_empty());
        let done = watcher.look(later());
        assert_eq!((done.changed, done.unsettled.len()), (vec![folder.path("a_2.csv")], 0));
    }

    #[test]
    fn a_file_just_written_may_not_have_been_whole_when_it_was_read() {
        let folder = Folder::with(&["a_1.csv"]);
        let mut watcher = folder.watcher();
        assert!(watcher.look(SystemTime::now()).unsettled.contains(&folder.path("a_1.csv")));
        let soon = |seconds| SystemTime::now() + Duration::from_secs(seconds);
        assert!(watcher.look(soon(2)).changed.is_empty(), "the solver may only pause");
        assert_eq!(watcher.look(soon(8)).changed, [folder.path("a_1.csv")]);
        assert_eq!(watcher.look(soon(9)), Changes::default());
    }

    #[test]
    fn what_vanishes_is_told_once_and_may_come_back() {
        let folder = Folder::with(&["a_1.csv", "a_2.csv"]);
        let mut watcher = folder.watcher();
        watcher.look(later());
        std::fs::remove_file(folder.path("a_2.csv")).unwrap();
        assert_eq!(watcher.look(later()).vanished, [folder.path("a_2.csv")]);
        assert_eq!(watcher.look(later()), Changes::default());
        folder.write("a_2.csv", "x,y,z\n0,0,0\n");
        watcher.look(later());
        let back = watcher.look(later());
        assert_eq!((back.changed, back.added), (vec![folder.path("a_2.csv")], vec![]));
    }

    #[test]
    fn a_frame_that_comes_late_goes_where_its_name_belongs() {
        let folder = Folder::with(&["a_2.csv", "a_9.csv"]);
        let (mut watcher, mut known) =
            (folder.watcher(), Sequence::open(&[folder.0.path().to_owned()]).unwrap());
        shown(&mut watcher, &mut known);
        ["a_10.csv", "a_1.csv", "a_3.csv", "a_11.csv"].iter().for_each(|name| folder.write(name, "x,y,z\n"));
        let names = ["a_1.csv", "a_2.csv", "a_3.csv", "a_9.csv", "a_10.csv", "a_11.csv"];
        assert_eq!(shown(&mut watcher, &mut known), names);
        // Frames that are gone keep their places, and others still find theirs.
        std::fs::remove_file(folder.path("a_9.csv")).unwrap();
        folder.write("a_4.csv", "x,y,z\n");
        let names = ["a_1.csv", "a_2.csv", "a_3.csv", "a_4.csv", "a_9.csv", "a_10.csv", "a_11.csv"];
        assert_eq!(shown(&mut watcher, &mut known), names);
    }

    #[test]
    fn an_empty_folder_is_waited_in() {
        let folder = Folder::with(&[]);
        let arguments = vec![folder.0.path().to_owned()];
        let mut known = Sequence::open_growing(&arguments, &|_| false).unwrap();
        let mut watcher = Watcher::new(arguments, &known);
        assert!(known.is_empty() && !watcher.is_idle());
        assert!(shown(&mut watcher, &mut known).is_empty());
        folder.write("a_5.csv", "x,y,z\n");
        assert_eq!(shown(&mut watcher, &mut known), ["a_5.csv"]);
        folder.write("a_4.csv", "x,y,z\n");
        assert_eq!(shown(&mut watcher, &mut known), ["a_4.csv", "a_5.csv"]);
    }

    #[test]
    fn another_series_that_outgrows_the_run_is_not_the_run() {
        let folder = Folder::with(&["a_1.csv", "a_2.csv"]);
        let mut watcher = folder.watcher();
        watcher.look(later());
        (1..5).for_each(|number| folder.write(&format!("b_{number}.csv"), "x,y,z\n0,0,0\n"));
        for _ in 0..3 {
            assert_eq!(watcher.look(later()), Changes::default());
        }
        folder.write("a_3.csv", "x,y,z\n");
        watcher.look(later());
        assert_eq!(names(&watcher.look(later()).added), ["a_3.csv"], "which goes on growing");
    }
}
