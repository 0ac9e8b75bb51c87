//! Binary rows and columns of plain numbers, decoded at the precision they need.

use crate::frames::Numbers;

/// A number as a file stores it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Endian {
    Little,
    Big,
}

impl Scalar {
    pub fn bytes(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::I64 | Scalar::U64 | Scalar::F64 => 8,
        }
    }

    /// Whether only an f64 keeps its values: integers of 32 bits and more lose digits in an f32.
    pub fn is_double(self) -> bool {
        !matches!(self, Scalar::I8 | Scalar::U8 | Scalar::I16 | Scalar::U16 | Scalar::F32)
    }
}

/// `count` neighbouring numbers in every row of `stride` bytes.
#[derive(Clone, Copy, Debug)]
pub struct Cells {
    pub offset: usize,
    pub stride: usize,
    pub scalar: Scalar,
    pub endian: Endian,
    pub count: usize,
}

/// Rows of `components` numbers, of which cells fill some from `first` on.
pub struct Target<'a> {
    pub numbers: &'a mut Numbers,
    pub components: usize,
    pub first: usize,
}

/// Zeroed numbers for a table that is filled afterwards.
pub fn zeroed(len: usize, double: bool) -> Numbers {
    if double { Numbers::F64(vec![0.0; len]) } else { Numbers::F32(vec![0.0; len]) }
}

impl Cells {
    /// Copies the cells of all whole rows of `bytes` into the target, row by row.
    pub fn copy(self, bytes: &[u8], target: Target<'_>) {
        let Target { numbers, components, first } = target;
        if bytes.is_empty() {
            // No rows: also where the header of an empty array claims components without end.
            return;
        }
        let dense = self.count == components && self.stride == self.count * self.scalar.bytes();
        if dense {
            let flat = Cells { offset: 0, stride: self.scalar.bytes(), count: 1, ..self };
            return flat.copy_one(bytes, numbers, 1, 0);
        }
        for cell in 0..self.count {
            let offset = self.offset + cell * self.scalar.bytes();
            Cells { offset, count: 1, ..self }.copy_one(bytes, numbers, components, first + cell);
        }
    }

    fn copy_one(self, bytes: &[u8], numbers: &mut Numbers, components: usize, component: usize) {
        macro_rules! decode {
            ($($scalar:ident $number:ty),*) => {
                match (self.scalar, self.endian, numbers) {
                    $(
                        (Scalar::$scalar, Endian::Little, Numbers::F32(out)) =>
                            self.walk(bytes, out, components, component, |b| <$number>::from_le_bytes(b) as f32),
                        (Scalar::$scalar, Endian::Big, Numbers::F32(out)) =>
                            self.walk(bytes, out, components, component, |b| <$number>::from_be_bytes(b) as f32),
                        (Scalar::$scalar, Endian::Little, Numbers::F64(out)) =>
                            self.walk(bytes, out, components, component, |b| <$number>::from_le_bytes(b) as f64),
                        (Scalar::$scalar, Endian::Big, Numbers::F64(out)) =>
                            self.walk(bytes, out, components, component, |b| <$number>::from_be_bytes(b) as f64),
                    )*
                }
            };
        }
        decode!(I8 i8, U8 u8, I16 i16, U16 u16, I32 i32, U32 u32, I64 i64, U64 u64, F32 f32, F64 f64);
    }

    #[inline]
    fn walk<const N: usize, T>(
        self,
        bytes: &[u8],
        out: &mut [T],
        components: usize,
        component: usize,
        decode: impl Fn([u8; N]) -> T,
    ) {
        for (row, out) in bytes.chunks_exact(self.stride).zip(out.chunks_exact_mut(components)) {
            if let Some(cell) = row.get(self.offset..).and_then(|rest| rest.first_chunk::<N>()) {
                out[component] = decode(*cell);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(cells: Cells, bytes: &[u8], rows: usize, components: usize, first: usize) -> Vec<f64> {
        let mut numbers = zeroed(rows * components, true);
        cells.copy(bytes, Target { numbers: &mut numbers, components, first });
        match numbers {
            Numbers::F64(values) => values,
            Numbers::F32(_) => unreachable!("asked for f64"),
        }
    }

    #[test]
    fn cells_of_a_row_land_in_their_components() {
        // Rows of one byte and two big-endian i16.
        let bytes = [9, 0, 1, 0xff, 0xfe, 9, 0, 3, 0, 4];
        let cells = Cells { offset: 1, stride: 5, scalar: Scalar::I16, endian: Endian::Big, count: 2 };
        assert_eq!(read(cells, &bytes, 2, 3, 1), [0.0, 1.0, -2.0, 0.0, 3.0, 4.0]);
    }

    #[test]
    fn dense_rows_are_one_run() {
        let bytes: Vec<u8> = [1.5f32, -2.0, 3.0, 4.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        let cells = Cells { offset: 0, stride: 8, scalar: Scalar::F32, endian: Endian::Little, count: 2 };
        assert_eq!(read(cells, &bytes, 2, 2, 0), [1.5, -2.0, 3.0, 4.0]);
    }
}
