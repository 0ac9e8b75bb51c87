//! The platform's places for what outlives a run of the program.

use std::path::PathBuf;

use directories::ProjectDirs;

/// What the user has chosen for good: settings, keys.
pub fn config() -> Option<PathBuf> {
    project().map(|project| project.config_dir().to_owned())
}

/// What the user has made: transfer functions, and the session to go on with.
pub fn data() -> Option<PathBuf> {
    project().map(|project| project.data_dir().to_owned())
}

/// `None` for a user without a home.
fn project() -> Option<ProjectDirs> {
    ProjectDirs::from("", "", "sphcast")
}
