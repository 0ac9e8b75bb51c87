//! What is wrong with a file, and where in it.

use std::fmt;
use std::path::{Path, PathBuf};

/// A place inside a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// One-based line of a text file.
    Line(usize),
    /// Byte offset from the start of the file, or of its decompressed content.
    Byte(u64),
    /// A named part: an XML element, a PLY element, a data set, an archive member.
    Part(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte(offset) => write!(f, "byte {offset}"),
            Place::Part(name) => f.write_str(name),
        }
    }
}

/// `<file>: <what is wrong>[: <where>]`, as the contract's section 3 has it.
#[derive(Debug, thiserror::Error)]
pub struct ReadError {
    pub path: PathBuf,
    pub what: String,
    pub place: Option<Place>,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.what)?;
        match &self.place {
            Some(place) => write!(f, ": {place}"),
            None => Ok(()),
        }
    }
}

/// What a format's parser returns: it sees bytes, not paths.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    pub what: String,
    pub place: Option<Place>,
}

impl Fault {
    pub fn new(what: impl Into<String>) -> Self {
        Fault { what: what.into(), place: None }
    }

    pub fn at(what: impl Into<String>, place: Place) -> Self {
        Fault { what: what.into(), place: Some(place) }
    }

    pub fn in_file(self, path: &Path) -> ReadError {
        ReadError { path: path.to_owned(), what: self.what, place: self.place }
    }
}
