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
    let bytes = std::fs::read(path).map_err(|error| error::Fault::new(error.to_string()).in_file(path))?;
    let frame = match path.extension().and_then(|e| e.to_str()) {
        Some("vtk") => vtk_legacy::parse(&bytes),
        Some("vtu" | "vtp") => vtk_xml::parse(&bytes),
        _ => Err(error::Fault::new("there is no reader for this format")),
    };
    frame.map_err(|fault| fault.in_file(path))
}
