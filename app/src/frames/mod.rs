//! Frames: what an SPH run is made of, from file to memory.

mod column;
mod frame;
pub mod names;
pub mod readers;

pub use column::{Column, Numbers};
pub use frame::{Field, Frame, FrameError, Metadata};
