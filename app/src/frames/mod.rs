//! Frames: what an SPH run is made of, from file to memory.

mod column;
pub mod demo;
mod frame;
mod generate;
mod insertion;
mod loading;
pub mod names;
mod natural;
mod packed;
mod range;
pub mod readers;
mod sequence;
mod spacing;
mod stream;
mod timed;
mod watch;

pub use column::{Column, Numbers};
pub use frame::{Field, Frame, FrameError, Metadata};
pub use generate::{Generated, Pattern};
pub use insertion::Insertion;
pub use loading::{Cancelled, Counted, Loading};
pub use packed::PackedRun;
pub use range::FrameRange;
pub use sequence::{Sequence, SequenceError, Source};
pub use spacing::median_spacing;
pub use stream::{Cached, FrameSource, FrameState, FrameStream};
pub use timed::Timed;
pub use watch::{Changes, Watcher};
