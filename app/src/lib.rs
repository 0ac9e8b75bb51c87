//! The sphcast application: frames from files, the command line, and the window.

mod annotate;
pub mod camera_path;
mod camera_text;
pub mod cli;
mod difference;
mod export;
pub mod frames;
pub mod image_file;
mod io_error;
mod numbers;
mod overlay;
mod paraview;
pub mod places;
pub mod projection;
mod say;
pub mod scene;
pub mod view_file;
pub mod viewer;
pub mod whole_file;
