//! Standard output, whose reader may have left: after `sphcast info run/ | head` nobody wants the rest.

use std::fmt::Display;
use std::io::{ErrorKind, Write, stdout};

use anyhow::Context;

/// Writes `text` to standard output. A reader who has left is no error; a full disk is.
pub fn say(text: impl Display) -> anyhow::Result<()> {
    let mut out = stdout().lock();
    match write!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("standard output"),
    }
}
