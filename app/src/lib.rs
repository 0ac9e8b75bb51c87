//! The sphcast application: frames from files, the command line, and the window.

pub mod frames;
pub mod scene;
