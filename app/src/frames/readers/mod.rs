//! One reader a format. Each turns the bytes of one file into a [`Frame`](super::Frame), or says
//! what is wrong and where.

mod error;
pub mod pvd;
mod vtk_cells;
pub mod vtk_legacy;
mod vtk_numbers;
pub mod vtk_xml;

pub use error::ReadError;

/// Reads the frame in a file.
pub fn read(path: &std::path::Path) -> Result<super::Frame, ReadError> {
    Err(error::Fault::new("there is no reader for this format").in_file(path))
}

pub mod pvd {
    pub use super::error::Fault;

    pub struct Entry {
        pub time: f64,
        pub file: String,
    }

    pub fn parse(_bytes: &[u8]) -> Result<Vec<Entry>, Fault> {
        Err(Fault::new("there is no reader for this format"))
    }
}
