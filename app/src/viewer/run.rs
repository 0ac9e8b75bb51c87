//! An open run: its frames, and the stream that reads them ahead.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::frames::{FrameSource, FrameStream, Sequence, Timed};

use super::Wake;

pub struct Run {
    /// For the window's title: the file, or what the files have in common.
    pub title: String,
    /// One a frame.
    names: Vec<String>,
    /// One a frame.
    sources: Vec<Arc<Timed>>,
    pub sequence: Sequence,
    pub stream: FrameStream,
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
        Run { title, names, sources, sequence: sequence.clone(), stream }
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

/// Finds the frames that `paths` name: looks at folders and collections, so not for the window's thread.
pub fn find(paths: &[PathBuf]) -> Result<Sequence, String> {
    Sequence::open(paths).map_err(|error| error.to_string())
}

fn file_name(path: &str) -> String {
    Path::new(path).file_name().map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned())
}

fn folder_name(path: &str) -> String {
    let folder = Path::new(path).parent().and_then(Path::file_name);
    folder.map_or_else(|| file_name(path), |name| name.to_string_lossy().into_owned())
}
