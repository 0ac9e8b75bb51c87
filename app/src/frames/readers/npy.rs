//! NumPy arrays: the `.npy` header and the numbers behind it.

use super::cursor::Cursor;
use super::error::{Fault, Place};
use super::layout::{Layout, Source};
use super::npy_header::{DType, Header};
use super::rows::{Cells, Target, zeroed};
use crate::frames::{Column, Frame, Metadata, Numbers};

/// Reads one array: positions of shape (N, 3), or a structured array with named columns.
pub fn parse(bytes: &[u8]) -> Result<Frame, Fault> {
    let array = Array::parse(bytes)?;
    match &array.header.dtype {
        DType::Record(fields) => {
            if array.header.shape.len() != 1 {
                return Err(Fault::new(format!("{}, expected one dimension", array.header.describe())));
            }
            let sources: Vec<Source> = fields
                .iter()
                .map(|field| Source {
                    name: field.name.clone(),
                    components: field.count,
                    double: field.scalar.is_double(),
                })
                .collect();
            let layout = Layout::of(&sources)?;
            let mut tables = layout.zeroed(array.header.rows());
            let stride = fields.iter().map(|field| field.count * field.scalar.bytes()).sum();
            let mut offset = 0;
            for (field, &(table, first)) in fields.iter().zip(&layout.slots) {
                let cells =
                    Cells { offset, stride, scalar: field.scalar, endian: field.endian, count: field.count };
                let components = layout.tables[table].components;
                cells.copy(array.data, Target { numbers: &mut tables[table], components, first });
                offset += field.count * field.scalar.bytes();
            }
            layout.frame(tables, Metadata::default())
        }
        _ => {
            if array.header.shape.get(1) != Some(&3) || array.header.shape.len() != 2 {
                return Err(Fault::new(format!(
                    "{}, expected positions of shape (N, 3)",
                    array.header.describe()
                )));
            }
            Frame::new(array.column()?, Vec::new(), Metadata::default())
                .map_err(|error| Fault::new(error.to_string()))
        }
    }
}

/// A header, and the bytes that it asks for.
pub struct Array<'a> {
    pub header: Header,
    data: &'a [u8],
}

impl<'a> Array<'a> {
    pub fn parse(bytes: &'a [u8]) -> Result<Array<'a>, Fault> {
        let mut cursor = Cursor::new(bytes);
        let header = Header::parse(&mut cursor)?;
        let found = cursor.rest();
        let needed = header.bytes().filter(|&needed| needed <= found.len());
        let data = needed.map(|needed| &found[..needed]).ok_or_else(|| {
            let needed = header.bytes().map_or("more than any file has".to_owned(), |n| n.to_string());
            let what =
                format!("{}, expected {needed} bytes of data, found {}", header.describe(), found.len());
            Fault::at(what, cursor.here())
        })?;
        Ok(Array { header, data })
    }

    /// The array as rows: the first dimension counts particles, the others are components.
    pub fn column(&self) -> Result<Column, Fault> {
        let (scalar, endian) = match &self.header.dtype {
            DType::Plain(scalar, endian) => (*scalar, *endian),
            _ => return Err(Fault::new(format!("{}, expected numbers", self.header.describe()))),
        };
        let rows = self.header.rows();
        let components = self.header.components();
        let size = scalar.bytes();
        let mut numbers = zeroed(rows * components, scalar.is_double());
        if rows == 0 {
            // Nothing to copy, however many components the header claims.
        } else if self.header.fortran && components > 1 {
            // One column after the other.
            for component in 0..components {
                let column = &self.data[component * rows * size..(component + 1) * rows * size];
                let cells = Cells { offset: 0, stride: size, scalar, endian, count: 1 };
                cells.copy(column, Target { numbers: &mut numbers, components, first: component });
            }
        } else if components > 0 {
            let cells = Cells { offset: 0, stride: size * components, scalar, endian, count: components };
            cells.copy(self.data, Target { numbers: &mut numbers, components, first: 0 });
        }
        Column::new(components, numbers)
            .ok_or_else(|| Fault::new(format!("{}, expected at least one component", self.header.describe())))
    }

    /// The number of an array that holds just one.
    pub fn scalar(&self) -> Option<f64> {
        let single = self.header.shape.iter().all(|&n| n == 1);
        let column = single.then(|| self.column().ok()).flatten()?;
        match column.numbers() {
            Numbers::F32(values) => values.first().map(|&value| f64::from(value)),
            Numbers::F64(values) => values.first().copied(),
        }
    }
}

/// Names the array that a fault is in.
pub fn in_array(name: &str, fault: Fault) -> Fault {
    let what = match fault.place {
        Some(place) => format!("{} at {place}", fault.what),
        None => fault.what,
    };
    Fault::at(what, Place::Part(format!("array `{name}`")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn npy(header: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        bytes
    }

    fn f32s(values: &[f32]) -> Vec<u8> {
        values.iter().flat_map(|v| v.to_be_bytes()).collect()
    }

    #[test]
    fn orders_and_byte_orders() {
        let c = npy(
            "{'descr': '>f4', 'fortran_order': False, 'shape': (2, 3), }",
            &f32s(&[1., 2., 3., 4., 5., 6.]),
        );
        let f = npy("{'descr':'>f4','fortran_order':True,'shape':(2,3)}", &f32s(&[1., 4., 2., 5., 3., 6.]));
        assert_eq!(parse(&c).unwrap(), parse(&f).unwrap());
        assert_eq!(parse(&c).unwrap().position(1), [4.0, 5.0, 6.0]);
    }

    #[test]
    fn structured_arrays_have_named_columns() {
        let header =
            "{'descr': [('pos', '>f4', (3,)), ('id', '|u1')], 'fortran_order': False, 'shape': (1,), }";
        let mut data = f32s(&[1., 2., 3.]);
        data.push(7);
        let frame = parse(&npy(header, &data)).unwrap();
        assert_eq!(frame.position(0), [1.0, 2.0, 3.0]);
        assert_eq!(frame.fields()[0].column.get(0, 0), 7.0);
    }

    #[test]
    fn empty_arrays_with_endless_components_end() {
        let header = "{'descr': '<f4', 'fortran_order': True, 'shape': (0, 1099511627776), }";
        assert!(Array::parse(&npy(header, &[])).unwrap().column().unwrap().is_empty());
        let header = "{'descr': [('a', '<f4', (1099511627776,)), ('pos', '<f4', 3)], 'fortran_order': False, 'shape': (0,), }";
        assert!(parse(&npy(header, &[])).unwrap().is_empty());
    }

    #[test]
    fn shapes_are_checked_against_the_data() {
        for shape in
            ["(3, 3)", "(4611686018427387904, 3)", "(99999999999999999999, 3)", "(3,)", "(1, 0)", "(-1, 3)"]
        {
            let header = format!("{{'descr': '>f4', 'fortran_order': False, 'shape': {shape}, }}");
            assert!(parse(&npy(&header, &f32s(&[1., 2., 3.]))).is_err(), "{shape}");
        }
        let header = "{'descr': '|O', 'fortran_order': False, 'shape': (2, 3), }";
        assert!(parse(&npy(header, &[])).unwrap_err().what.contains("Python objects"));
    }
}
