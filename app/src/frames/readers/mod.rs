//! One reader a format. Each turns the bytes of one file into a [`Frame`], or says what is wrong
//! and where.

mod bgeo;
mod csv;
mod cursor;
mod error;
mod format;
mod hdf5;
mod layout;
mod npy;
mod npy_header;
mod npz;
mod ply;
mod ply_ascii;
pub mod pvd;
mod rows;
mod sidecar;
mod text;
mod vtk_cells;
pub mod vtk_legacy;
mod vtk_numbers;
pub mod vtk_xml;
mod xyz;

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;
use std::sync::Arc;

use super::{Counted, Frame, Loading};
pub use error::{Fault, Place, ReadError};
use format::Format;

/// Reads one frame, and what the sidecars beside it add. Tells `loading` how far it is.
pub fn read(path: &Path, loading: &Arc<Loading>) -> Result<Frame, ReadError> {
    let mut frame = read_file(path, loading).map_err(|fault| fault.in_file(path))?;
    sidecar::apply(path, &mut frame);
    Ok(frame)
}

fn read_file(path: &Path, loading: &Arc<Loading>) -> Result<Frame, Fault> {
    let unreadable = |error: std::io::Error| Fault::new(format!("cannot be read: {error}"));
    // Opening a pipe would wait for its other end.
    let about = path.metadata().map_err(unreadable)?;
    if !about.is_file() {
        return Err(Fault::new("not a file"));
    }
    loading.begin(about.len());
    let mut file = File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    (&mut file).take(format::HEAD).read_to_end(&mut bytes).map_err(unreadable)?;
    let format = Format::detect(&bytes, path).ok_or_else(|| {
        Fault::new(format!("not a particle file that is known here, expected one of {}", format::KNOWN))
    })?;
    if format == Format::Hdf5 {
        file.rewind().map_err(unreadable)?;
        return hdf5::parse_file(file, loading);
    }
    Counted { inner: file, loading }.read_to_end(&mut bytes).map_err(unreadable)?;
    parse(format, &bytes)
}

fn parse(format: Format, bytes: &[u8]) -> Result<Frame, Fault> {
    match format {
        Format::VtkLegacy => vtk_legacy::parse(bytes),
        Format::VtkXml => vtk_xml::parse(bytes),
        Format::Bgeo => bgeo::parse(bytes),
        Format::Ply => ply::parse(bytes),
        Format::Xyz => xyz::parse(bytes),
        Format::Csv => csv::parse(bytes),
        Format::Npy => npy::parse(bytes),
        Format::Npz => npz::parse(bytes),
        Format::Hdf5 => Err(Fault::new("is read from its file, not from bytes")),
    }
}
