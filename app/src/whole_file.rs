//! Files that are there whole or not at all.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use crate::io_error::describe;

/// The path of a file, and why it cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Unwritten(String);

/// Writes `bytes` to `path` so that a reader, and whoever comes after a crash, finds the old file or
/// the new one, and never a part.
pub fn write_whole(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    write_file(path, |file| Ok(file.write_all(bytes)?))
}

/// Whether what is written to `path` goes on to somebody else: a device or a pipe.
pub fn is_stream(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// Gives `path` what `write` puts into a file, whole or not at all. A link stays one; a device or a pipe, as
/// `/dev/stdout`, gets the bytes as they come.
///
/// # Errors
/// [`Unwritten`].
pub fn write_file(path: &Path, write: impl FnOnce(&mut File) -> anyhow::Result<()>) -> anyhow::Result<()> {
    let written = if is_stream(path) {
        File::options().write(true).open(path).map_err(Into::into).and_then(|mut stream| write(&mut stream))
    } else {
        replace(&path.canonicalize().unwrap_or_else(|_| path.to_owned()), write)
    };
    written.map_err(|error| {
        let what = error.downcast_ref().map_or_else(|| error.to_string(), describe);
        Unwritten(format!("{}: cannot be written: {what}", path.display())).into()
    })
}

/// Puts a new file in the place of the one at `path`, if there is one.
fn replace(path: &Path, write: impl FnOnce(&mut File) -> anyhow::Result<()>) -> anyhow::Result<()> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".sphcast-");
    // A temporary file is for its owner's eyes only; the picture is as open as other new files.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    write(file.as_file_mut())?;
    // Only then is a name that is there after a crash that of a whole file.
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}
