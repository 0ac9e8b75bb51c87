//! From command-line arguments to an ordered list of frames.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::generate::Generated;
use super::stream::FrameSource;
use super::{Frame, Insertion, Loading, demo, natural, readers};
use crate::io_error::describe;

/// The frames of a run, in the order in which they are shown.
#[derive(Clone, Debug, Default)]
pub struct Sequence {
    sources: Vec<Arc<Source>>,
    notes: Vec<String>,
    may_grow: bool,
}

/// Whether a file is a frame of the run already.
type IsKnown<'a> = &'a dyn Fn(&Path) -> bool;

/// One frame, not read yet.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// What messages and the timeline call it: the path as given, or the demo's name.
    pub name: String,
    /// In the unit of the run, where it is known without reading the file.
    pub time: Option<f64>,
    origin: Origin,
}

#[derive(Clone, Debug, PartialEq)]
enum Origin {
    File(PathBuf),
    Demo(usize),
    Generated(Generated),
}

/// What is wrong with an argument that should name frames.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{argument}: {what}")]
pub struct SequenceError {
    pub argument: String,
    pub what: String,
}

impl Sequence {
    /// Opens what `arguments` name: frame files (in natural order), directories, globs, `.pvd`
    /// collections (in the order of time), `demo`, `demo:radial:N`, `demo:checker:N`. Several
    /// arguments follow one another; without any it is the embedded demo. Reads no frame.
    ///
    /// # Errors
    /// The first argument that names no frame, and why.
    pub fn open(arguments: &[PathBuf]) -> Result<Sequence, SequenceError> {
        Sequence::gather(arguments, None)
    }

    /// The same for a run that is still being written: a folder may be without any frame as yet, and its
    /// frames are those of the series that has a known file, if there is one.
    ///
    /// # Errors
    /// As for [`Sequence::open`].
    pub fn open_growing(arguments: &[PathBuf], known: IsKnown) -> Result<Sequence, SequenceError> {
        Sequence::gather(arguments, Some(known))
    }

    fn gather(arguments: &[PathBuf], growing: Option<IsKnown>) -> Result<Sequence, SequenceError> {
        let mut sequence = Sequence::default();
        if arguments.is_empty() {
            sequence.add(Path::new("demo"), growing)?;
        }
        let mut files = Vec::new();
        for argument in arguments {
            // Files that follow one another are sorted together: a shell puts 10 before 2.
            if argument.is_file() && !has_ending(argument, "pvd") {
                files.push(argument.clone());
                continue;
            }
            sequence.add_files(std::mem::take(&mut files));
            sequence.add(argument, growing)?;
        }
        sequence.add_files(files);
        Ok(sequence)
    }

    /// Number of frames, never 0 for a sequence that [`Sequence::open`] gave.
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    pub fn sources(&self) -> &[Arc<Source>] {
        &self.sources
    }

    /// What the user should know about how the arguments were understood, one line each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Whether this is the embedded demo and nothing else.
    pub fn is_demo(&self) -> bool {
        !self.is_empty() && self.sources.iter().all(|source| matches!(source.origin, Origin::Demo(_)))
    }

    /// The frames for a [`FrameStream`](super::FrameStream).
    pub fn frame_sources(&self) -> Vec<Arc<dyn FrameSource>> {
        self.sources.iter().map(|source| Arc::clone(source) as Arc<dyn FrameSource>).collect()
    }

    /// Keeps the frames in these places only.
    ///
    /// # Panics
    /// Where a place is past the end.
    pub fn select(&mut self, places: impl Iterator<Item = usize>) {
        self.sources = places.map(|place| Arc::clone(&self.sources[place])).collect();
    }

    /// Puts new frames in, each at the place that it has from then on, which ascend.
    pub fn insert(&mut self, added: &[(usize, Arc<Source>)]) -> Insertion {
        let known = self.len();
        for (place, source) in added {
            self.sources.insert((*place).min(self.len()), Arc::clone(source));
        }
        Insertion::new(known, added.iter().map(|(place, _)| *place).collect())
    }

    /// The places of those frames of `listed` that are new, for [`Sequence::insert`]: behind the frame that
    /// comes before them in the list.
    pub fn places(&self, listed: &Sequence, is_new: impl Fn(&Source) -> bool) -> Vec<(usize, Arc<Source>)> {
        let known: HashMap<&str, usize> =
            self.sources.iter().enumerate().map(|(place, source)| (source.name.as_str(), place)).collect();
        let mut behind = 0;
        let mut new = Vec::new();
        for source in &listed.sources {
            match known.get(source.name.as_str()) {
                Some(place) => behind = place + 1,
                None if is_new(source) => new.push((behind, Arc::clone(source))),
                None => {}
            }
        }
        // The known ones may be in another order than they are listed in by now.
        new.sort_by_key(|(behind, _)| *behind);
        new.into_iter().enumerate().map(|(before, (behind, source))| (before + behind, source)).collect()
    }

    /// Whether frames may come to it: where a folder, a pattern or a collection was named.
    pub fn may_grow(&self) -> bool {
        self.may_grow
    }

    fn add(&mut self, argument: &Path, growing: Option<IsKnown>) -> Result<(), SequenceError> {
        let text = argument.to_string_lossy();
        let error = |what: String| SequenceError { argument: text.clone().into_owned(), what };
        self.may_grow |= argument.is_dir() || argument.is_file() || is_pattern(&text);
        if text == "demo" {
            self.add_demo().map_err(error)?;
        } else if let Some(scene) = text.strip_prefix("demo:") {
            let generated = Generated::parse(scene).map_err(error)?;
            self.push(text.to_string(), None, Origin::Generated(generated));
        } else if argument.is_dir() {
            let files = self.series(argument, growing).map_err(error)?;
            self.add_files(files);
        } else if argument.is_file() {
            self.add_collection(argument).map_err(error)?;
        } else if is_pattern(&text) {
            self.add_files(matches(&text).map_err(error)?);
        } else {
            // The system's own words: not found, no permission, a broken link.
            let what = std::fs::metadata(argument).err().map(|error| describe(&error));
            return Err(error(what.unwrap_or_else(|| "is neither a file nor a directory".into())));
        }
        Ok(())
    }

    fn push(&mut self, name: String, time: Option<f64>, origin: Origin) {
        self.sources.push(Arc::new(Source { name, time, origin }));
    }

    fn add_demo(&mut self) -> Result<(), String> {
        let times = demo::times().map_err(|error| format!("{error:#}"))?;
        for (index, time) in times.into_iter().enumerate() {
            self.push(format!("demo frame {index}"), Some(time), Origin::Demo(index));
        }
        Ok(())
    }

    fn add_files(&mut self, mut files: Vec<PathBuf>) {
        files.sort_by(|a, b| natural::compare(&a.to_string_lossy(), &b.to_string_lossy()));
        for file in files {
            self.push(file.display().to_string(), None, Origin::File(file));
        }
    }

    /// The frames that a ParaView collection lists.
    fn add_collection(&mut self, path: &Path) -> Result<(), String> {
        let bytes = std::fs::read(path).map_err(|error| describe(&error))?;
        let entries = readers::pvd::parse(&bytes).map_err(|fault| match fault.place {
            Some(place) => format!("{}: {place}", fault.what),
            None => fault.what,
        })?;
        if entries.is_empty() {
            return Err("lists no frames".into());
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        for entry in entries {
            // `join` leaves an absolute path as it is.
            let file = folder.join(&entry.path);
            self.push(file.display().to_string(), Some(entry.time), Origin::File(file));
        }
        Ok(())
    }

    /// The largest series of frames in a directory, or that of known files; says so where there are others.
    fn series(&mut self, directory: &Path, growing: Option<IsKnown>) -> Result<Vec<PathBuf>, String> {
        let entries = std::fs::read_dir(directory).map_err(|error| describe(&error))?;
        let mut series: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
        for entry in entries {
            let path = entry.map_err(|error| describe(&error))?.path();
            if is_readable(&path) && path.is_file() {
                series.entry(series_of(&path)).or_default().push(path);
            }
        }
        let found = series.len();
        // The first one of the largest, in the order of the names.
        let is_known = |file: &PathBuf| growing.is_some_and(|known| known(file));
        let rank = |files: &[PathBuf]| (files.iter().any(is_known), files.len());
        let largest = series.into_iter().rev().max_by_key(|(_, files)| rank(files));
        let Some((name, files)) = largest else {
            if growing.is_some() {
                return Ok(Vec::new());
            }
            return Err(format!("has no particle files ({})", ENDINGS.join(", ")));
        };
        if found > 1 {
            self.notes.push(format!(
                "{}: {found} series of files; took `{name}`, the largest ({} frames)",
                directory.display(),
                files.len()
            ));
        }
        Ok(files)
    }
}

impl Source {
    /// Reads the frame, and tells `loading` how far it is. The error does not repeat the name.
    pub fn load(&self, loading: &Arc<Loading>) -> anyhow::Result<Frame> {
        let mut frame = match &self.origin {
            Origin::Demo(index) => demo::frame(*index)?,
            Origin::Generated(scene) => scene.frame(),
            Origin::File(path) => readers::read(path, loading).map_err(|error| match error.place {
                Some(place) => anyhow::anyhow!("{}: {place}", error.what),
                None => anyhow::anyhow!(error.what),
            })?,
        };
        // A collection knows the times of files that do not say it themselves.
        frame.metadata.time = frame.metadata.time.or(self.time);
        Ok(frame)
    }

    /// The file, where the frame has one.
    pub fn path(&self) -> Option<&Path> {
        match &self.origin {
            Origin::File(path) => Some(path),
            Origin::Demo(_) | Origin::Generated(_) => None,
        }
    }
}

impl FrameSource for Source {
    fn load(&self, loading: &Arc<Loading>) -> anyhow::Result<Arc<Frame>> {
        Source::load(self, loading).map(Arc::new)
    }
}

/// Endings of the files that there are readers for, in lower case. A `.json` is a sidecar.
const ENDINGS: [&str; 12] =
    ["vtk", "vtu", "vtp", "bgeo", "ply", "xyz", "csv", "npz", "npy", "hdf5", "h5", "hdf"];

fn is_pattern(argument: &str) -> bool {
    argument.contains(['*', '?', '['])
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

fn is_readable(path: &Path) -> bool {
    ENDINGS.iter().any(|ending| has_ending(path, ending))
}

/// Name of a file's series: its number becomes `#`.
fn series_of(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    match natural::series(&stem) {
        Some((before, after)) => format!("{before}#{after}.{ending}"),
        // Files without a number are one series: a directory of unlike names is still a list of frames.
        None => format!("*.{ending}"),
    }
}

/// The files that a glob finds; those of readable endings only, if there are any.
fn matches(pattern: &str) -> Result<Vec<PathBuf>, String> {
    let paths = glob::glob(pattern).map_err(|error| format!("is not a pattern: {error}"))?;
    let files: Vec<PathBuf> = paths.flatten().filter(|path| path.is_file()).collect();
    let readable: Vec<PathBuf> = files.iter().filter(|path| is_readable(path)).cloned().collect();
    let found = if readable.is_empty() { files } else { readable };
    if found.is_empty() { Err("matches no file".into()) } else { Ok(found) }
}
