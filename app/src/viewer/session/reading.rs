//! Frames on their way into memory.

use std::sync::Arc;
use std::time::Duration;

use super::Session;
use crate::frames::Frame;

/// Bytes of a file that nobody waits for without being told how long.
const LARGE_FILE: u64 = 64 << 20;
/// How often its progress is looked at.
pub const GLANCE: Duration = Duration::from_millis(100);

impl Session {
    /// Whether the first picture of the frame in view is still to come.
    pub fn awaits_picture(&self) -> bool {
        let failed = |(index, _): &(usize, Arc<Frame>)| self.without_picture == Some(*index);
        self.picture.is_none() && self.frame.as_ref().is_some_and(|frame| !failed(frame))
    }

    /// Bytes read of the frame at the playhead and bytes in all, while one that takes a while is read.
    pub fn reading(&self) -> Option<[u64; 2]> {
        let large = |bytes: &[u64; 2]| bytes[1] >= LARGE_FILE;
        self.run.as_ref()?.stream.progress(self.playback.index()).filter(large)
    }

    /// Gives up reading the frame at the playhead.
    pub fn cancel_reading(&mut self) {
        if let Some(run) = &self.run {
            run.stream.cancel(self.playback.index());
        }
    }

    /// Keeps no more than `bytes` of frames beside the one in view.
    pub fn limit_frames(&self, bytes: usize) {
        if let Some(run) = &self.run {
            run.stream.limit(bytes);
        }
    }
}
