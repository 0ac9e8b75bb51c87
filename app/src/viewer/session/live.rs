//! What the session does about a run that is still being written.

use std::path::Path;

use super::{RangeSource, Session};
use crate::frames::Changes;

impl Session {
    /// Whether frames may come to the run.
    pub fn may_grow(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.grows_in().is_some())
    }

    /// Where the first frame is waited for; `None` where there is one.
    pub fn waits_in(&self) -> Option<&str> {
        self.run.as_ref().filter(|run| run.stream.is_empty())?.grows_in()
    }

    /// Goes to the newest frame, and to every new one from now on; or no more.
    pub fn follow(&mut self, on: bool) {
        self.following = on;
        if on {
            self.playback.pause();
            self.go_to_newest();
        }
    }

    pub fn is_following(&self) -> bool {
        self.following
    }

    fn go_to_newest(&mut self) {
        self.playback.jump(self.playback.count().saturating_sub(1));
        self.request();
    }

    /// Takes in what was found out about the files of the run.
    pub(super) fn take_changes(&mut self) {
        let changes = self.run.as_mut().map(|run| run.take_changes()).unwrap_or_default();
        changes.into_iter().for_each(|changes| self.take_change(&changes));
    }

    /// The same for what one look found.
    pub fn take_change(&mut self, changes: &Changes) {
        let Some(run) = &mut self.run else { return };
        let before = run.stream.len();
        let insertion = run.insert(&changes.added);
        let (count, title) = (run.stream.len(), run.title.clone());
        let changed: Vec<usize> = changes.changed.iter().flat_map(|path| run.places(path)).collect();
        for &index in &changed {
            run.stream.reload(index);
        }
        // Their numbers go up with the playhead's, which must not be past the end meanwhile.
        self.playback.extend(count);
        if !insertion.is_behind() {
            self.renumber(insertion);
        }
        for index in changed {
            // It may be good now, and is told again where it is not.
            self.told.remove(&index);
            self.told_left_out.remove(&index);
            self.ranges.forget(index);
            self.ranges.begin_survey_again();
            self.log(format!("changed frame={index}"));
        }
        if count > before {
            self.grow(before, count, &title);
        }
        if !changes.vanished.is_empty() {
            self.tell_vanished(&changes.vanished);
        }
    }

    fn grow(&mut self, before: usize, count: usize, title: &str) {
        if before <= 1 && count > 1 {
            self.range_sources().into_iter().for_each(RangeSource::steady);
        }
        self.log(format!("appended {title} frames={count}"));
        if self.following {
            self.go_to_newest();
        }
    }

    fn tell_vanished(&mut self, paths: &[std::path::PathBuf]) {
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let names: Vec<String> = paths.iter().take(3).map(|path| name(path)).collect();
        let (names, more) = (names.join(", "), paths.len().saturating_sub(3));
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        self.messages.warn(format!("{names}{more}: gone from the disk; what is in memory can still be seen"));
        self.log(format!("vanished {}", paths.len()));
    }
}

#[cfg(test)]
#[path = "live_tests.rs"]
mod tests;
