//! One reader a format. Each turns the bytes of one file into a [`Frame`](super::Frame), or says
//! what is wrong and where.

mod error;
pub mod pvd;
mod vtk_cells;
pub mod vtk_legacy;
mod vtk_numbers;
pub mod vtk_xml;

pub use error::ReadError;
