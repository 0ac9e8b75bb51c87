//! Time: which frame is wanted, and when it moves on. Pure: no window, no clock of its own.

use std::time::{Duration, Instant};

use crate::frames::Insertion;

/// How the playhead came to where it is: a frame that cannot be read is passed over in the
/// direction of travel, but stays in view where the user pointed at it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    Jumped,
    Forwards,
    Backwards,
}

/// The playhead of a sequence of `count` frames.
#[derive(Clone, Debug)]
pub struct Playback {
    count: usize,
    index: usize,
    arrival: Arrival,
    playing: bool,
    pub looping: bool,
    /// Frames a second.
    pub speed: f64,
    /// When the current frame became the current one.
    since: Option<Instant>,
}

impl Playback {
    /// Speeds on offer, in frames a second.
    pub const SPEEDS: [f64; 9] = [0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 24.0, 30.0, 60.0];

    pub fn new(count: usize) -> Playback {
        Playback {
            count,
            index: 0,
            arrival: Arrival::Forwards,
            playing: false,
            looping: true,
            speed: 10.0,
            since: None,
        }
    }

    /// The same way of playing, at the start of another sequence.
    pub fn restarted(&self, count: usize) -> Playback {
        Playback { looping: self.looping, speed: self.speed, ..Playback::new(count) }
    }

    /// Goes on in a sequence that has become longer.
    pub fn extend(&mut self, count: usize) {
        self.count = self.count.max(count);
    }

    /// Stays at its frame where others come before it.
    pub fn renumber(&mut self, insertion: &Insertion) {
        self.index = insertion.moved(self.index);
    }

    pub fn count(&self) -> usize {
        self.count
    }

    pub fn index(&self) -> usize {
        self.index
    }

    pub fn arrival(&self) -> Arrival {
        self.arrival
    }

    pub fn playing(&self) -> bool {
        self.playing
    }

    /// Starts or pauses; at the end of a sequence that does not loop, starts over.
    pub fn toggle(&mut self) {
        self.playing = !self.playing && self.count > 1;
        if self.playing && self.index + 1 == self.count && !self.looping {
            self.index = 0;
        }
        self.arrival = if self.playing { Arrival::Forwards } else { self.arrival };
        self.since = None;
    }

    pub fn pause(&mut self) {
        self.playing = false;
    }

    /// Goes to a frame; one past the end is the last.
    pub fn jump(&mut self, index: usize) {
        self.index = index.min(self.count.saturating_sub(1));
        self.arrival = Arrival::Jumped;
        self.since = None;
    }

    /// Goes to the next frame (or the one before) for which `readable` holds, round the ends where
    /// it loops. Returns whether there is one.
    pub fn step(&mut self, forwards: bool, readable: impl Fn(usize) -> bool) -> bool {
        let next = (1..self.count).map(|steps| {
            let back = self.count - steps;
            let index = (self.index + if forwards { steps } else { back }) % self.count;
            let around = if forwards { index < self.index } else { index > self.index };
            (index, around)
        });
        let found =
            next.take_while(|(_, around)| self.looping || !around).find(|(index, _)| readable(*index));
        self.since = None;
        let Some((index, _)) = found else { return false };
        self.index = index;
        self.arrival = if forwards { Arrival::Forwards } else { Arrival::Backwards };
        true
    }

    /// Moves on when the current frame was in view for its time. `shown` says whether its picture
    /// is there; `readable` holds for frames not known to be bad. Returns whether the frame changed.
    pub fn advance(&mut self, now: Instant, shown: bool, readable: impl Fn(usize) -> bool) -> bool {
        if !self.playing || !shown {
            return false;
        }
        let since = *self.since.get_or_insert(now);
        if now.duration_since(since) < self.interval() {
            return false;
        }
        let moved = self.step(true, readable);
        self.playing = moved;
        // Counted from when the frame was due, so that the speed holds although the clock is coarse.
        let late = now.duration_since(since) > 2 * self.interval();
        self.since = Some(if late { now } else { since + self.interval() });
        moved
    }

    /// When to look again while playing.
    pub fn due(&self) -> Option<Instant> {
        self.since.filter(|_| self.playing).map(|since| since + self.interval())
    }

    fn interval(&self) -> Duration {
        Duration::from_secs_f64(1.0 / self.speed.clamp(0.1, 1000.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(start: Instant, milliseconds: u64) -> Instant {
        start + Duration::from_millis(milliseconds)
    }

    #[test]
    fn plays_at_its_speed_and_only_what_was_shown() {
        let start = Instant::now();
        let mut playback = Playback::new(5);
        playback.toggle();
        assert!(!playback.advance(start, true, |_| true), "the first frame has its time");
        assert!(!playback.advance(at(start, 90), true, |_| true));
        assert!(!playback.advance(at(start, 110), false, |_| true), "its picture is not there yet");
        assert!(playback.advance(at(start, 120), true, |_| true));
        assert_eq!(playback.index(), 1);
        assert_eq!(playback.due(), Some(at(start, 200)));
    }

    #[test]
    fn stops_at_the_end_or_loops() {
        let start = Instant::now();
        let mut playback = Playback { looping: false, ..Playback::new(2) };
        playback.toggle();
        playback.advance(start, true, |_| true);
        assert!(playback.advance(at(start, 100), true, |_| true));
        playback.advance(at(start, 200), true, |_| true);
        assert!(!playback.playing() && playback.index() == 1);
        playback.toggle();
        assert_eq!(playback.index(), 0, "starts over");
        playback.looping = true;
        playback.jump(1);
        assert!(playback.step(true, |_| true));
        assert_eq!(playback.index(), 0);
        assert!(playback.step(false, |_| true));
        assert_eq!(playback.index(), 1);
    }

    #[test]
    fn bad_frames_are_passed_over() {
        let mut playback = Playback::new(5);
        assert!(playback.step(true, |index| index > 2));
        assert_eq!((playback.index(), playback.arrival()), (3, Arrival::Forwards));
        assert!(playback.step(false, |index| index == 0));
        assert_eq!((playback.index(), playback.arrival()), (0, Arrival::Backwards));
        assert!(!playback.step(true, |_| false), "nothing left to show");
        playback.jump(99);
        assert_eq!((playback.index(), playback.arrival()), (4, Arrival::Jumped));
    }

    #[test]
    fn one_frame_does_not_play() {
        let mut playback = Playback::new(1);
        playback.toggle();
        assert!(!playback.playing());
        let mut none = Playback::new(0);
        none.toggle();
        assert!(!none.step(true, |_| true) && none.index() == 0);
    }
}
