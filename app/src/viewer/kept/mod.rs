//! What outlives the program, each in a file of its own in the platform's places: settings, the runs
//! that were open, and the sessions to go on with.

mod last_session;
pub mod library;
mod recent;
mod sessions;
mod settings;
mod writer;

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, anyhow};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::io_error::describe;
use crate::whole_file::write_whole;

pub use last_session::LastSession;
pub use recent::{Recent, RecentRuns};
pub use sessions::{Left, Sessions};
pub use settings::Settings;
pub use writer::Writer;

/// Something that is kept in a file.
pub trait Kept: Serialize + DeserializeOwned {
    const FILE: &'static str;

    /// The folder of the file; `None` for a user without a home.
    fn folder() -> Option<PathBuf>;

    /// What was kept; `None` where nothing was.
    ///
    /// # Errors
    /// A file that is there but says nothing. It is set aside under another name, which the message
    /// tells, so that nothing of it is lost when the next one is written.
    fn read() -> anyhow::Result<Option<Self>> {
        match Self::folder() {
            Some(folder) => read(&folder.join(Self::FILE)),
            None => Ok(None),
        }
    }

    /// Keeps it.
    ///
    /// # Errors
    /// Whatever the system has against the file; the path comes first.
    fn write(&self) -> anyhow::Result<()> {
        match Self::folder() {
            Some(folder) => write(&folder.join(Self::FILE), self),
            None => Ok(()),
        }
    }
}

fn read<T: DeserializeOwned>(path: &Path) -> anyhow::Result<Option<T>> {
    let name = || path.display().to_string();
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(anyhow!(describe(&error))).with_context(name),
    };
    match serde_json::from_str(&text) {
        Ok(kept) => Ok(Some(kept)),
        Err(error) => {
            let aside = path.with_extension("json.broken");
            let kept = match std::fs::rename(path, &aside) {
                Ok(()) => format!("it is set aside as {}", aside.display()),
                Err(error) => format!("it cannot be set aside either ({})", describe(&error)),
            };
            Err(anyhow!("{error}; {kept}")).with_context(name)
        }
    }
}

/// Keeps something in the file at `path`.
///
/// # Errors
/// Whatever the system has against the file; the path comes first.
pub fn write<T: Serialize>(path: &Path, kept: &T) -> anyhow::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)
            .map_err(|error| anyhow!("{}: cannot be made: {}", folder.display(), describe(&error)))?;
    }
    write_whole(path, format!("{}\n", serde_json::to_string_pretty(kept)?).as_bytes())
}

/// Seconds since 1970.
pub fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// How long ago that was, in words.
pub fn ago(when: u64, now: u64) -> String {
    let minutes = now.saturating_sub(when) / 60;
    let (number, unit) = match minutes {
        0 => return "just now".into(),
        1..60 => (minutes, "minute"),
        60..1440 => (minutes / 60, "hour"),
        _ => (minutes / 1440, "day"),
    };
    format!("{number} {unit}{} ago", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/down/settings.json");
        assert_eq!(read::<Settings>(&path).unwrap(), None);
        let settings = Settings { adapter: Some("llvmpipe".into()), ..Settings::default() };
        write(&path, &settings).unwrap();
        assert_eq!(read(&path).unwrap(), Some(settings));
    }

    #[test]
    fn a_broken_file_is_told_and_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.json");
        std::fs::write(&path, "{\"adapter\": 7}").unwrap();
        let error = format!("{:#}", read::<Settings>(&path).unwrap_err());
        assert!(error.contains("settings.json: ") && error.contains("line 1"), "{error}");
        assert_eq!(read::<Settings>(&path).unwrap(), None);
        let aside = std::fs::read_to_string(folder.path().join("settings.json.broken")).unwrap();
        assert_eq!(aside, "{\"adapter\": 7}");
    }

    #[test]
    fn times_are_told_in_words() {
        assert_eq!(ago(1000, 1030), "just now");
        assert_eq!(ago(1000, 1060), "1 minute ago");
        assert_eq!(ago(0, 7200), "2 hours ago");
        assert_eq!(ago(0, 86_400), "1 day ago");
        assert_eq!(ago(10, 0), "just now", "a clock that was set back");
    }
}
