//! The sphcast application: frames from files, the command line, and the window.

pub mod cli;
pub mod frames;
pub mod image_file;
pub mod scene;
pub mod viewer;
