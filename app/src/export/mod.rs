//! Pictures of a run to files: what the command line and the window's exports have in common.
//!
//! - [`Film`] reads the frames of a run one after the other, and settles what must not change between them.
//! - [`Pictures`] makes the files of each frame; [`Output`] names them, [`record`] tells whose they are.
//! - [`Listener`] is whoever waits for that: a terminal, or a window.

mod film;
mod layer;
mod listener;
mod order;
mod output;
mod pictures;
mod record;
mod shard;
mod stats_file;
mod survey;
pub mod video;

pub use film::{Content, Fatal, Film, Run};
pub use layer::Layer;
pub use listener::{Listener, Stage};
pub use order::{Order, Summary};
pub use output::Output;
pub use pictures::{Made, Overlay, Pictures, Target};
pub use shard::Shard;
pub use stats_file::StatsFile;
pub use survey::Steady;

/// An error with its causes, on one line.
pub fn one_line(error: &anyhow::Error) -> String {
    format!("{error:#}").split_whitespace().collect::<Vec<_>>().join(" ")
}
