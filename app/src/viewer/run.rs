//! An open run: its frames, and the stream that reads them ahead.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::frames::{Changes, FrameSource, FrameStream, Insertion, Sequence, Source, Timed};

use super::Wake;
use super::live::Live;

pub struct Run {
    /// For the window's title: the file, or what the files have in common.
    pub title: String,
    /// One a frame.
    names: Vec<String>,
    /// One a frame.
    sources: Vec<Arc<Timed>>,
    pub sequence: Sequence,
    pub stream: FrameStream,
    live: Option<Live>,
    /// Where frames may come to, for the reader; `None` where none can.
    grows_in: Option<String>,
    /// Files that may be half written; `None` until the files of a live run were looked at.
    unsettled: Option<HashSet<PathBuf>>,
}

impl Run {
    /// Keeps up to `cache` bytes of frames beside the one in view.
    pub fn new(sequence: &Sequence, cache: usize, wake: &Wake) -> Run {
        let names: Vec<String> = sequence.sources().iter().map(|source| file_name(&source.name)).collect();
        let title = match sequence.sources() {
            _ if sequence.is_demo() => "demo".to_owned(),
            [only] => file_name(&only.name),
            several => several.first().map_or_else(String::new, |first| folder_name(&first.name)),
        };
        let wake = Wake::clone(wake);
        let sources: Vec<Arc<Timed>> = sequence.frame_sources().into_iter().map(Timed::new).collect();
        let timed = sources.iter().map(|source| Arc::clone(source) as Arc<dyn FrameSource>).collect();
        let stream = FrameStream::new(timed, cache, move || wake());
        Run {
            title,
            names,
            sources,
            sequence: sequence.clone(),
            stream,
            live: None,
            grows_in: None,
            unsettled: None,
        }
    }

    /// Looks after the files that `paths`, of which this run was made, name from now on.
    pub fn watch(&mut self, paths: &[PathBuf], wake: &Wake) {
        self.live = Live::start(paths, &self.sequence, wake);
        if !self.sequence.may_grow() {
            return;
        }
        let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        self.grows_in = Some(names.join(", "));
        if let ([only], 0..2) = (paths, self.sequence.len()) {
            // A file would not be what the others are called by, too.
            let path = std::path::absolute(only).unwrap_or_else(|_| only.clone());
            self.title = file_name(&path.to_string_lossy());
        }
    }

    /// Where frames may come to, as it was named; `None` where none can.
    pub fn grows_in(&self) -> Option<&str> {
        self.grows_in.as_deref()
    }

    pub fn is_live(&self) -> bool {
        self.live.is_some()
    }

    /// What was found out about the files since the last call.
    pub fn take_changes(&mut self) -> Vec<Changes> {
        let changes = self.live.as_ref().map(Live::take).unwrap_or_default();
        if let Some(last) = changes.last() {
            self.unsettled = Some(last.unsettled.clone());
        }
        changes
    }

    /// Whether frame `index` may be still being written, so that it is no wonder if it cannot be read.
    pub fn is_unsettled(&self, index: usize) -> bool {
        let path = self.sequence.sources().get(index).and_then(|source| source.path());
        let unsettled = |path| self.unsettled.as_ref().is_none_or(|files| files.contains(path));
        self.is_live() && path.is_some_and(unsettled)
    }

    /// Puts new frames in, each at the place that it has from then on, which ascend.
    pub fn insert(&mut self, added: &[(usize, Arc<Source>)]) -> Insertion {
        let mut streamed = Vec::new();
        for (place, source) in added {
            let timed = Timed::new(Arc::clone(source) as Arc<dyn FrameSource>);
            streamed.push((*place, Arc::clone(&timed) as Arc<dyn FrameSource>));
            self.names.insert(*place, file_name(&source.name));
            self.sources.insert(*place, timed);
        }
        self.stream.insert(streamed.into_iter());
        self.sequence.insert(added)
    }

    /// The frames that come from a file.
    pub fn places(&self, path: &Path) -> Vec<usize> {
        let sources = self.sequence.sources().iter().enumerate();
        sources.filter(|(_, source)| source.path() == Some(path)).map(|(index, _)| index).collect()
    }

    /// Milliseconds that reading frame `index` took, told once for each time that it was read.
    pub fn take_reading(&self, index: usize) -> f64 {
        self.sources.get(index).map_or(0.0, |source| source.take_milliseconds())
    }

    /// What frame `index` is called.
    pub fn name(&self, index: usize) -> &str {
        self.names.get(index).map_or("", String::as_str)
    }
}

/// Finds the frames that `paths` name, if only a folder that they will come to: looks at folders and collections, so not for the window's thread.
pub fn find(paths: &[PathBuf]) -> Result<Sequence, String> {
    Sequence::open_growing(paths, &|_| false).map_err(|error| error.to_string())
}

fn file_name(path: &str) -> String {
    Path::new(path).file_name().map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned())
}

fn folder_name(path: &str) -> String {
    let folder = Path::new(path).parent().and_then(Path::file_name);
    folder.map_or_else(|| file_name(path), |name| name.to_string_lossy().into_owned())
}
