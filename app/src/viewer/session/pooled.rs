//! The histogram behind the opacity's nodes: of the frame in view, or of all frames in memory.

use super::Session;
use crate::viewer::analysis::pool::{Question, Ruler};

impl Session {
    /// The frame in memory that is to be counted next for the histogram of all of them.
    pub fn pool_question(&mut self) -> Option<Question> {
        let role = self.role_of_opacity();
        let (field, scale) = self.field_of(role)?;
        let ruler = Ruler { field, range: self.range_of(role)?, scale };
        let loaded = self.run.as_ref()?.stream.loaded();
        self.pool.follow(ruler, &loaded, self.playback.index())
    }
}
