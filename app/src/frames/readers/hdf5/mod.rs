//! HDF5: snapshots of GADGET, SWIFT and AREPO, output of PySPH, dumps of Phantom; contents decide.

mod gadget;
mod phantom;
mod pysph;
mod store;

use std::fs::File;
use std::sync::Arc;

use hdf5_reader::FileStorage;
use hdf5_reader::storage::{Storage, StorageBuffer};

use super::error::Fault;
use crate::frames::{Frame, Loading};
use store::Store;

/// Reads a file piece by piece: a snapshot may be far larger than its gas.
pub fn parse_file(file: File, loading: &Arc<Loading>) -> Result<Frame, Fault> {
    let storage = FileStorage::from_file(file).map_err(|error| Fault::new(error.to_string()))?;
    let counted = CountedStorage { inner: storage, loading: Arc::clone(loading) };
    parse_store(&Store::open(Arc::new(counted))?)
}

/// A file whose pieces are counted.
struct CountedStorage {
    inner: FileStorage,
    loading: Arc<Loading>,
}

impl Storage for CountedStorage {
    fn len(&self) -> u64 {
        self.inner.len()
    }

    fn read_range(&self, offset: u64, len: usize) -> hdf5_reader::error::Result<StorageBuffer> {
        self.loading.advance(len as u64).map_err(std::io::Error::other)?;
        self.inner.read_range(offset, len)
    }
}

fn parse_store(store: &Store) -> Result<Frame, Fault> {
    let (groups, datasets) = store.members("/")?;
    if groups.iter().any(|group| group.starts_with("PartType")) {
        return gadget::parse(store, &groups);
    }
    if groups.iter().any(|group| group == "particles") {
        let (arrays, datasets) = store.members("particles")?;
        if datasets.iter().any(|name| name == "xyz") {
            return phantom::parse(store, &datasets);
        }
        return pysph::parse(store, &arrays);
    }
    if gadget::is_snapshot_without_gas(store, &groups)? {
        return gadget::empty(store);
    }
    let mut found = groups;
    found.extend(datasets);
    found.truncate(20);
    Err(Fault::new(format!(
        "no particles known here: expected PartType0 (GADGET, SWIFT, AREPO) or particles (PySPH, Phantom), found {}",
        if found.is_empty() { "nothing".to_owned() } else { found.join(", ") }
    )))
}
