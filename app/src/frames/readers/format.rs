//! Which reader a file is for: its content where that says so, else its ending.

use std::path::Path;

/// The formats that can be told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    VtkLegacy,
    VtkXml,
    Bgeo,
    Ply,
    Xyz,
    Csv,
    Npy,
    Npz,
    Hdf5,
}

/// What the error for an unknown file lists.
pub const KNOWN: &str =
    ".vtk, .vtu, .vtp, .bgeo, .ply, .xyz, .csv, .tsv, .txt, .dat, .npy, .npz, .hdf5, .h5, .hdf";

/// How a file of a format begins.
const MAGIC: [(&[u8], Format); 13] = [
    (b"# vtk DataFile", Format::VtkLegacy),
    (b"<?xml", Format::VtkXml),
    (b"<VTKFile", Format::VtkXml),
    (b"BgeoV", Format::Bgeo),
    // The new style of Houdini, for its own error.
    (b"\x7fNSJ", Format::Bgeo),
    // Only .bgeo is read compressed.
    (b"\x1f\x8b", Format::Bgeo),
    (b"ply\n", Format::Ply),
    (b"ply\r", Format::Ply),
    (b"\x93NUMPY", Format::Npy),
    (b"PK\x03\x04", Format::Npz),
    (b"PK\x05\x06", Format::Npz),
    (HDF5_SIGNATURE, Format::Hdf5),
    (b"\xef\xbb\xbf<?xml", Format::VtkXml),
];

const HDF5_SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
/// A user block may stand before the signature.
const HDF5_OFFSETS: [usize; 3] = [512, 1024, 2048];

/// Bytes of a file that [`Format::detect`] wants to see.
pub const HEAD: u64 = 4096;

impl Format {
    /// The format of a file that begins with `head`; `None` where neither content nor ending is known.
    pub fn detect(head: &[u8], path: &Path) -> Option<Format> {
        let by_content = MAGIC.iter().find(|(magic, _)| head.starts_with(magic)).map(|&(_, format)| format);
        let hdf5 =
            || HDF5_OFFSETS.iter().any(|&at| head.get(at..).is_some_and(|h| h.starts_with(HDF5_SIGNATURE)));
        by_content.or_else(|| hdf5().then_some(Format::Hdf5)).or_else(|| Format::by_ending(path))
    }

    fn by_ending(path: &Path) -> Option<Format> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match ending.as_str() {
            "vtk" => Format::VtkLegacy,
            "vtu" | "vtp" => Format::VtkXml,
            "bgeo" => Format::Bgeo,
            "ply" => Format::Ply,
            "xyz" | "extxyz" => Format::Xyz,
            "csv" | "tsv" | "txt" | "dat" => Format::Csv,
            "npy" => Format::Npy,
            "npz" => Format::Npz,
            "hdf5" | "h5" | "hdf" | "he5" => Format::Hdf5,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_goes_before_the_ending() {
        let detect = |head: &[u8], path: &str| Format::detect(head, Path::new(path));
        assert_eq!(detect(b"ply\nformat", "a.csv"), Some(Format::Ply));
        assert_eq!(detect(b"x,y,z\n", "a.CSV"), Some(Format::Csv));
        assert_eq!(detect(b"", "a.vtk"), Some(Format::VtkLegacy));
        assert_eq!(detect(b"\x1f\x8b\x08", "a"), Some(Format::Bgeo));
        assert_eq!(detect(b"hello", "a.png"), None);
        let mut head = vec![0; 600];
        head[512..520].copy_from_slice(HDF5_SIGNATURE);
        assert_eq!(detect(&head, "a"), Some(Format::Hdf5));
    }
}
