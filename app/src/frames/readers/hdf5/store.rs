//! The file behind the layouts: members, columns and attributes, with faults that name them.

use hdf5_reader::datatype_api::H5Type;
use hdf5_reader::error::Error;
use hdf5_reader::storage::DynStorage;
use hdf5_reader::{Dataset, Datatype, Hdf5File, OpenOptions};

use crate::frames::readers::error::{Fault, Place};
use crate::frames::{Column, Numbers};

/// The most that deflate can make of one byte, rounded up: a dataset that claims more is damaged.
const DEFLATE_RATIO: usize = 1100;

pub struct Store {
    file: Hdf5File,
    largest_read: usize,
}

fn fault(error: &Error, part: &str) -> Fault {
    Fault::at(format!("HDF5 file is damaged or of an unknown kind ({error})"), Place::Part(part.to_owned()))
}

impl Store {
    pub fn open(storage: DynStorage) -> Result<Store, Fault> {
        let size = usize::try_from(storage.len()).unwrap_or(usize::MAX);
        let largest_read = size.saturating_mul(DEFLATE_RATIO);
        let options =
            OpenOptions::default().with_max_read_bytes(largest_read).with_max_chunk_bytes(largest_read);
        let file = Hdf5File::from_storage_with_options(storage, options).map_err(|error| match error {
            Error::InvalidMagic => Fault::at("not an HDF5 file: no HDF5 signature", Place::Byte(0)),
            error => fault(&error, "superblock"),
        })?;
        Ok(Store { file, largest_read })
    }

    /// Names of the groups and of the datasets in a group.
    pub fn members(&self, group: &str) -> Result<(Vec<String>, Vec<String>), Fault> {
        let at_group = |error: Error| fault(&error, group);
        self.file.group(group).map_err(at_group)?.member_names().map_err(at_group)
    }

    fn dataset(&self, path: &str) -> Result<Dataset, Fault> {
        self.file.dataset(path).map_err(|error| fault(&error, path))
    }

    /// A dataset as rows; `None` where it does not hold numbers. With `rows`, it must have as many.
    pub fn column(&self, path: &str, rows: Option<usize>) -> Result<Option<Column>, Fault> {
        let dataset = self.dataset(path)?;
        let in_dataset = |what: String| Fault::at(what, Place::Part(path.to_owned()));
        let shape = dataset.shape().to_vec();
        let Some((&found, inner)) = shape.split_first() else { return Ok(None) };
        if let Some(rows) = rows.filter(|&rows| rows as u64 != found) {
            return Err(in_dataset(format!("{found} rows, expected {rows}, one for each particle")));
        }
        let components =
            inner.iter().try_fold(1u64, |product, &n| product.checked_mul(n)).unwrap_or(u64::MAX);
        let bytes = found.saturating_mul(components).saturating_mul(8);
        if components == 0 || bytes / 8 > self.largest_read as u64 {
            return Err(in_dataset(format!("shape {shape:?} is more than this file can hold")));
        }
        let Some(numbers) = read_numbers(&dataset).map_err(|error| fault(&error, path))? else {
            return Ok(None);
        };
        let column = Column::new(components as usize, numbers);
        column
            .filter(|column| column.len() as u64 == found)
            .map(Some)
            .ok_or_else(|| in_dataset("data does not fill whole rows".into()))
    }

    /// All numbers of a dataset, also of one that holds a single number.
    pub fn numbers(&self, path: &str) -> Result<Option<Vec<f64>>, Fault> {
        let dataset = self.dataset(path)?;
        let numbers = read_numbers(&dataset).map_err(|error| fault(&error, path))?;
        Ok(numbers.map(|numbers| match numbers {
            Numbers::F32(values) => values.into_iter().map(f64::from).collect(),
            Numbers::F64(values) => values,
        }))
    }

    /// The numbers of an attribute; `None` where there is no such attribute of numbers.
    pub fn attribute(&self, group: &str, name: &str) -> Option<Vec<f64>> {
        let attribute = self.file.group(group).ok()?.attribute(name).ok()?;
        macro_rules! read {
            ($number:ty) => {
                attribute
                    .read_1d::<$number>()
                    .ok()
                    .map(|values| values.into_iter().map(|v| v as f64).collect())
            };
        }
        match attribute.datatype {
            Datatype::FloatingPoint { size: 4, .. } => read!(f32),
            Datatype::FloatingPoint { size: 8, .. } => read!(f64),
            Datatype::FixedPoint { size: 4, signed: true, .. } => read!(i32),
            Datatype::FixedPoint { size: 4, signed: false, .. } => read!(u32),
            Datatype::FixedPoint { size: 8, signed: true, .. } => read!(i64),
            Datatype::FixedPoint { size: 8, signed: false, .. } => read!(u64),
            _ => None,
        }
    }

    pub fn attribute_text(&self, group: &str, name: &str) -> Option<String> {
        self.file.group(group).ok()?.attribute(name).ok()?.read_string().ok()
    }
}

fn read_numbers(dataset: &Dataset) -> Result<Option<Numbers>, Error> {
    macro_rules! read {
        ($number:ty, $kind:ident, $kept:ty) => {{
            let values = read_values::<$number>(dataset)?;
            Numbers::$kind(values.into_iter().map(|value| value as $kept).collect())
        }};
    }
    // Integers of 32 bits and more lose digits in an f32.
    let numbers = match dataset.dtype() {
        Datatype::FloatingPoint { size: 4, .. } => Numbers::F32(read_values(dataset)?),
        Datatype::FloatingPoint { size: 8, .. } => Numbers::F64(read_values(dataset)?),
        Datatype::FixedPoint { size: 1, signed: true, .. } => read!(i8, F32, f32),
        Datatype::FixedPoint { size: 1, signed: false, .. } => read!(u8, F32, f32),
        Datatype::FixedPoint { size: 2, signed: true, .. } => read!(i16, F32, f32),
        Datatype::FixedPoint { size: 2, signed: false, .. } => read!(u16, F32, f32),
        Datatype::FixedPoint { size: 4, signed: true, .. } => read!(i32, F64, f64),
        Datatype::FixedPoint { size: 4, signed: false, .. } => read!(u32, F64, f64),
        Datatype::FixedPoint { size: 8, signed: true, .. } => read!(i64, F64, f64),
        Datatype::FixedPoint { size: 8, signed: false, .. } => read!(u64, F64, f64),
        _ => return Ok(None),
    };
    Ok(Some(numbers))
}

fn read_values<T: H5Type>(dataset: &Dataset) -> Result<Vec<T>, Error> {
    let array = dataset.read_array_parallel::<T>()?;
    // Read in C order, from the start.
    Ok(array.into_raw_vec_and_offset().0)
}
