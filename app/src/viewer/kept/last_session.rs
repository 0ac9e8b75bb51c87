//! What was open and how it looked, for the next start: also after a crash.

use std::path::PathBuf;

use renderer::View;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LastSession {
    /// What the run was opened by.
    pub paths: Vec<PathBuf>,
    pub title: String,
    pub frame: usize,
    pub view: View,
    /// Whether the image had the size that it had in the window; older files do not say.
    pub fits_window: Option<bool>,
    /// Seconds since 1970.
    pub when: u64,
    /// Whether the program was ended by the user, and not by a crash.
    pub ended: bool,
}

impl LastSession {
    /// Whether this is the same but for the time.
    pub fn is_like(&self, other: &LastSession) -> bool {
        let LastSession { paths, title, frame, view, fits_window, when: _, ended } = self;
        (paths, title, frame, ended) == (&other.paths, &other.title, &other.frame, &other.ended)
            && (view, fits_window) == (&other.view, &other.fits_window)
    }
}
