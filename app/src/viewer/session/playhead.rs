//! Which frame is in view: going to one, playing, and what becomes of frames that cannot be read.

use std::sync::Arc;
use std::time::Instant;

use super::Session;
use crate::frames::{Frame, FrameState};
use crate::viewer::playback::Arrival;

impl Session {
    pub fn jump(&mut self, index: usize) {
        // Who points at a frame wants to see that one.
        self.following = false;
        self.playback.jump(index);
        self.request();
    }

    /// Goes to the next frame that is not known to be bad, or the one before.
    pub fn step(&mut self, forwards: bool) -> bool {
        let told = &self.told;
        let moved = self.playback.step(forwards, |index| !told.contains(&index));
        self.request();
        moved
    }

    pub fn toggle_playing(&mut self) {
        self.playback.toggle();
        self.following &= !self.playback.playing();
        self.log(if self.playback.playing() { "playing" } else { "paused" });
        self.request();
    }

    /// Asks for the frame at the playhead.
    pub(super) fn request(&self) {
        if let Some(run) = &self.run {
            run.stream.request(self.playback.index());
        }
    }

    /// Takes in what is there of the frame at the playhead, and goes on while playing.
    pub(super) fn move_playhead(&mut self, now: Instant) {
        // Bad frames may follow one another, and what comes after them may be in memory already.
        for _ in 0..=self.playback.count() {
            let index = self.playback.index();
            self.look(index);
            let pictured = self.picture.as_ref().is_some_and(|picture| picture.index == index);
            let shown = pictured || self.without_picture == Some(index);
            let told = &self.told;
            if self.playback.advance(now, shown, |index| !told.contains(&index)) {
                self.request();
            }
            if self.playback.index() == index {
                return;
            }
        }
    }

    /// Takes in what is known of the frame at the playhead.
    fn look(&mut self, index: usize) {
        let Some(run) = &self.run else { return };
        match run.stream.get(index) {
            FrameState::Ready(frame) => self.arrive(index, frame),
            // It is read again when it is whole.
            FrameState::Failed(_) if run.is_unsettled(index) => {}
            FrameState::Failed(why) => self.pass_over(index, &why),
            FrameState::NotLoaded | FrameState::Loading => {}
        }
    }

    fn arrive(&mut self, index: usize, frame: Arc<Frame>) {
        if self.frame.as_ref().is_some_and(|(known, here)| *known == index && Arc::ptr_eq(here, &frame)) {
            return;
        }
        let name = self.run.as_ref().map_or("", |run| run.name(index));
        for warning in &frame.warnings {
            self.messages.warn(format!("{name}: {warning}"));
        }
        self.drop_missing_fields(&frame);
        self.frame = Some((index, frame));
    }

    fn pass_over(&mut self, index: usize, why: &str) {
        if self.told.insert(index) {
            let name = self.run.as_ref().map_or("", |run| run.name(index));
            let what = if self.playback.count() > 1 { "left out" } else { "not readable" };
            self.messages.error(format!("Frame {index} ({name}) is {what}: {why}"));
            self.log(format!("bad frame={index}"));
        }
        let forwards = match self.playback.arrival() {
            Arrival::Jumped if !self.playback.playing() => return,
            Arrival::Backwards => false,
            Arrival::Jumped | Arrival::Forwards => true,
        };
        if !self.step(forwards) {
            self.playback.pause();
            self.playback.jump(index);
        }
    }
}
