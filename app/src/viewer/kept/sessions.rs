//! What is open in each of the windows that run, for the next start: also after a crash.
//!
//! Every session has a file of its own, and beside it a lock that its window holds for as long as it runs: a
//! session whose lock is free was left behind.

use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, anyhow};

use super::{LastSession, now, read};
use crate::io_error::describe;
use crate::places;

/// The sessions of the user.
pub struct Sessions {
    /// Those that were left behind, the newest first.
    pub left: Vec<Left>,
    /// `None` for a user without a home.
    own: Option<Own>,
    /// One that this window goes on with, by its file and what it had open, until that is in this window's file.
    taken_over: Option<(PathBuf, Vec<PathBuf>)>,
}

/// A session whose window is gone.
#[derive(Clone)]
pub struct Left {
    pub session: LastSession,
    file: PathBuf,
}

/// The session of this window.
struct Own {
    file: PathBuf,
    /// Held until the process ends, however it does.
    _lock: File,
}

/// Sessions after a crash that are kept.
const MOST: usize = 5;

impl Sessions {
    /// Finds those that were left behind. Also returns what is wrong with any of them.
    pub fn read() -> (Sessions, Vec<String>) {
        match places::data() {
            Some(folder) => Sessions::read_in(&folder.join("sessions")),
            None => (Sessions { left: Vec::new(), own: None, taken_over: None }, Vec::new()),
        }
    }

    fn read_in(folder: &Path) -> (Sessions, Vec<String>) {
        let mut troubles = Vec::new();
        let left = left_in(folder, &mut troubles);
        let own = Own::claim(folder).map_err(|error| troubles.push(format!("{error:#}"))).ok();
        (Sessions { left, own, taken_over: None }, troubles)
    }

    /// The file of this window's session, which it alone writes.
    pub fn file(&self) -> Option<PathBuf> {
        self.own.as_ref().map(|own| own.file.clone())
    }

    /// Goes on with one of those that were left behind, once its run is open.
    pub fn take_over(&mut self, gone_on: &Left) {
        self.left.retain(|left| left.file != gone_on.file);
        self.taken_over = Some((gone_on.file.clone(), gone_on.session.paths.clone()));
    }

    /// Says that what is `open` is in the file of this window. A session of that which was taken over is deleted.
    pub fn saved(&mut self, open: &[PathBuf]) {
        if let Some((file, _)) = self.taken_over.take_if(|(_, paths)| paths == open) {
            remove(&file);
        }
    }
}

impl Drop for Sessions {
    fn drop(&mut self) {
        // Without a session, the lock says nothing.
        if let Some(own) = self.own.take_if(|own| !own.file.exists()) {
            remove(&own.file);
        }
    }
}

impl Own {
    fn claim(folder: &Path) -> anyhow::Result<Own> {
        fs::create_dir_all(folder)
            .map_err(|error| anyhow!(describe(&error)))
            .with_context(|| folder.display().to_string())?;
        // A second window of this process would have the next number.
        let names =
            (0..).map(|number| folder.join(format!("{}-{}-{number}.json", now(), std::process::id())));
        for file in names.take(100) {
            let lock = lock_of(&file);
            match File::create_new(&lock) {
                Ok(opened) => {
                    // Where nothing can be locked, sessions of other windows look like those after a crash.
                    let _ = opened.try_lock();
                    return Ok(Own { file, _lock: opened });
                }
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => {
                    return Err(anyhow!(describe(&error))).with_context(|| lock.display().to_string());
                }
            }
        }
        Err(anyhow!("{}: has no room for a session", folder.display()))
    }
}

/// All whose window is gone: of those that were ended by the user only the newest, and not too many others.
/// What is older is deleted.
fn left_in(folder: &Path, troubles: &mut Vec<String>) -> Vec<Left> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let locks: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|own| own == "lock")).collect();
    let mut left = Vec::new();
    for lock in locks.iter().filter(|lock| is_free(lock)) {
        let file = lock.with_extension("json");
        match read::<LastSession>(&file) {
            Ok(Some(session)) => left.push(Left { session, file }),
            // One that was made just now may be about to be locked.
            Ok(None) if is_old(lock) => remove(&file),
            Ok(None) => {}
            Err(error) => {
                troubles.push(format!("{error:#}"));
                remove(&file);
            }
        }
    }
    left.sort_by_key(|left| std::cmp::Reverse(left.session.when));
    let mut kept = Vec::new();
    for (index, one) in left.into_iter().enumerate() {
        match kept.len() < MOST && (index == 0 || !one.session.ended) {
            true => kept.push(one),
            false => remove(&one.file),
        }
    }
    kept
}

fn lock_of(file: &Path) -> PathBuf {
    file.with_extension("lock")
}

/// Whether no running window holds this.
fn is_free(lock: &Path) -> bool {
    File::open(lock).is_ok_and(|lock| !matches!(lock.try_lock(), Err(TryLockError::WouldBlock)))
}

/// Whether this was made a while ago.
fn is_old(lock: &Path) -> bool {
    let made = lock.metadata().and_then(|file| file.modified());
    made.is_ok_and(|made| made.elapsed().is_ok_and(|age| age > Duration::from_secs(60)))
}

/// Deletes a session; what cannot be deleted is found again at the next start.
fn remove(file: &Path) {
    let _ = fs::remove_file(file);
    let _ = fs::remove_file(lock_of(file));
}

#[cfg(test)]
mod tests {
    use std::time::SystemTime;

    use renderer::View;

    use super::super::write;
    use super::*;

    fn session(title: &str, when: u64, ended: bool) -> LastSession {
        let paths = vec![title.into()];
        let (title, view) = (title.into(), View::default());
        LastSession { paths, title, frame: 0, view, fits_window: None, when, ended }
    }

    fn open(folder: &Path) -> Sessions {
        let (sessions, troubles) = Sessions::read_in(folder);
        assert_eq!(troubles, Vec::<String>::new());
        sessions
    }

    fn titles(sessions: &Sessions) -> Vec<&str> {
        sessions.left.iter().map(|left| left.session.title.as_str()).collect()
    }

    fn save(sessions: &Sessions, session: &LastSession) {
        write(&sessions.file().unwrap(), session).unwrap();
    }

    #[test]
    fn only_what_nobody_has_open_was_left_behind() {
        let folder = tempfile::tempdir().unwrap();
        let first = open(folder.path());
        save(&first, &session("first", 1, false));
        let second = open(folder.path());
        save(&second, &session("second", 2, false));
        assert!(titles(&second).is_empty(), "its window runs");
        drop(first);
        assert_eq!(titles(&open(folder.path())), ["first"], "its window is gone");
        drop(second);
        assert_eq!(titles(&open(folder.path())), ["second", "first"]);
    }

    #[test]
    fn what_is_taken_over_is_offered_until_it_is_safe_and_then_no_more() {
        let folder = tempfile::tempdir().unwrap();
        save(&open(folder.path()), &session("crashed", 1, false));
        let mut next = open(folder.path());
        let left = next.left[0].clone();
        assert_eq!((titles(&next), left.session.title.as_str()), (vec!["crashed"], "crashed"));
        next.take_over(&left);
        assert!(next.left.is_empty());
        assert_eq!(titles(&open(folder.path())), ["crashed"]);
        save(&next, &session("goes on", 2, false));
        next.saved(&["another".into()]);
        assert_eq!(titles(&open(folder.path())), ["crashed"]);
        next.saved(&["crashed".into()]);
        drop(next);
        assert_eq!(titles(&open(folder.path())), ["goes on"]);
    }

    #[test]
    fn the_newest_are_kept_and_what_is_stale_is_deleted() {
        let folder = tempfile::tempdir().unwrap();
        let windows: Vec<Sessions> = (0..12).map(|_| open(folder.path())).collect();
        for (when, window) in windows.iter().enumerate() {
            save(window, &session(&when.to_string(), when as u64, when % 4 == 3));
        }
        drop(windows);
        assert_eq!(titles(&open(folder.path())), ["11", "10", "9", "8", "6"]);
        let stale = File::create(folder.path().join("7-7-7.lock")).unwrap();
        stale.set_modified(SystemTime::now() - Duration::from_secs(3600)).unwrap();
        drop(stale);
        drop(open(folder.path()));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 10, "five, and their locks");
    }

    #[test]
    fn a_broken_one_is_told_and_set_aside() {
        let folder = tempfile::tempdir().unwrap();
        let window = open(folder.path());
        fs::write(window.file().unwrap(), "{").unwrap();
        drop(window);
        let (sessions, troubles) = Sessions::read_in(folder.path());
        assert!(
            sessions.left.is_empty() && troubles.len() == 1 && troubles[0].contains(".json"),
            "{troubles:?}"
        );
        assert!(Sessions::read_in(folder.path()).1.is_empty());
    }
}
