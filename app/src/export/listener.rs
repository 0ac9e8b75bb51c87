//! Whoever waits for pictures.

/// What is being done with a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// All frames are read, to find out what they have in common.
    Survey,
    Pictures,
}

/// Follows the work, from the thread that does it.
pub trait Listener: Send + Sync {
    /// Of `count` frames, those before `index` are done, and that one to the `share`.
    fn show(&self, stage: Stage, index: usize, share: f32, count: usize);

    /// Takes a line that the user should read.
    fn say(&self, line: &str);

    /// Whether the work is to end at the next safe point.
    fn wants_end(&self) -> bool;
}

/// The error of work that ended because it was told to.
pub const INTERRUPTED: &str = "sphcast: interrupted";
