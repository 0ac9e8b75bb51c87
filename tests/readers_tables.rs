//! Readers outside the VTK family: every format gives the same frame, damaged files give an error
//! that says where, and nothing makes them panic, hang or swallow memory.

#[path = "readers_tables/agreement.rs"]
mod agreement;
#[path = "readers_tables/damage.rs"]
mod damage;
#[path = "readers_tables/metered.rs"]
mod metered;
#[path = "readers_tables/shared_data.rs"]
mod shared_data;

use std::path::{Path, PathBuf};

use sphcast::frames::Frame;
use sphcast::frames::readers::read;

/// All fixtures of this test.
const FIXTURES: [&str; 16] = [
    "ascii.ply",
    "binary.ply",
    "binary_big_endian.ply",
    "chemistry.xyz",
    "comma.csv",
    "deflated.npz",
    "gadget.hdf5",
    "gzip.bgeo",
    "phantom.h5",
    "plain.bgeo",
    "positions.npy",
    "pysph.hdf5",
    "raw.xyz",
    "records.npy",
    "rows.xyz",
    "stored_fortran_f64.npz",
];

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/tables").join(name)
}

/// The folder of real runs beside the repository; `None`, with a line that says so, where it is absent.
fn shared_data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    if !folder.is_dir() {
        eprintln!("skipped: {} is absent", folder.display());
        return None;
    }
    Some(folder)
}

fn read_ok(path: &Path) -> Frame {
    read(path, &Default::default()).unwrap_or_else(|error| panic!("{error}"))
}
