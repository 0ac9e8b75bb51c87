//! How long reading a frame took.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use super::{Frame, FrameSource, Loading};

/// A source with a stop-watch.
pub struct Timed {
    source: Arc<dyn FrameSource>,
    microseconds: AtomicU64,
}

impl Timed {
    pub fn new(source: Arc<dyn FrameSource>) -> Arc<Timed> {
        Arc::new(Timed { source, microseconds: AtomicU64::new(0) })
    }

    /// Time of the last reading; 0 before the first.
    pub fn milliseconds(&self) -> f64 {
        self.microseconds.load(Ordering::Relaxed) as f64 / 1000.0
    }

    /// The same, told once for each reading: 0 where the frame was not read since.
    pub fn take_milliseconds(&self) -> f64 {
        self.microseconds.swap(0, Ordering::Relaxed) as f64 / 1000.0
    }
}

impl FrameSource for Timed {
    fn load(&self, loading: &Arc<Loading>) -> anyhow::Result<Arc<Frame>> {
        let start = Instant::now();
        let frame = self.source.load(loading);
        self.microseconds.store(start.elapsed().as_micros() as u64, Ordering::Relaxed);
        frame
    }
}
