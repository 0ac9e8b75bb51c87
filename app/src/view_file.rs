//! `view.json` from a file.

use std::path::Path;

use anyhow::{Context, anyhow};
use renderer::View;

use crate::io_error::describe;

/// Reads a view.
///
/// # Errors
/// A file that cannot be read, is not a view, or holds a value out of range; the file comes first,
/// then the key, or the line and column.
pub fn read(path: &Path) -> anyhow::Result<View> {
    let name = || path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| anyhow!(describe(&error))).with_context(name)?;
    // A byte order mark is no part of JSON, but editors write one.
    let view = View::from_json(text.trim_start_matches('\u{feff}')).map_err(|error| {
        // `<what>: <where>`, as for every other file.
        let what = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        let what = what.strip_suffix(&place).unwrap_or(&what).to_owned();
        anyhow!("{what}: line {}, column {}", error.line(), error.column())
    });
    let view = view.with_context(name)?;
    view.validate().with_context(name)?;
    Ok(view)
}
