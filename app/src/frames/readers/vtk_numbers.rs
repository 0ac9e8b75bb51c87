//! The number types of VTK files, from their bytes or their text to a column's numbers.

use std::str::FromStr;

use crate::frames::Numbers;

/// A number type as a VTK file names it, by its width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Eight to a byte, the first in the highest bit.
    Bit,
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Float32,
    Float64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

impl Kind {
    /// Bytes that `count` numbers take in a binary file; `None` past the address space.
    pub fn bytes_for(self, count: usize) -> Option<usize> {
        match self {
            Kind::Bit => Some(count.div_ceil(8)),
            Kind::Int8 | Kind::UInt8 => Some(count),
            Kind::Int16 | Kind::UInt16 => count.checked_mul(2),
            Kind::Int32 | Kind::UInt32 | Kind::Float32 => count.checked_mul(4),
            Kind::Int64 | Kind::UInt64 | Kind::Float64 => count.checked_mul(8),
        }
    }

    /// Bytes that `count` numbers take in memory once decoded; `None` past the address space.
    pub fn decoded_bytes_for(self, count: usize) -> Option<usize> {
        count.checked_mul(if self.is_single() { 4 } else { 8 })
    }

    /// Whether numbers of this type are kept as f32: a bit as f64 would take 64 times its size.
    fn is_single(self) -> bool {
        matches!(self, Kind::Float32 | Kind::Bit)
    }

    /// The `count` numbers that `bytes` hold.
    pub fn decode(self, bytes: &[u8], count: usize, order: Order) -> Numbers {
        use Order::{Big, Little};
        match (self, order) {
            (Kind::Bit, _) => Numbers::F32(
                (0..count).map(|i| f32::from(u8::from(bytes[i / 8] & (0x80 >> (i % 8)) != 0))).collect(),
            ),
            (Kind::Float32, Little) => Numbers::F32(each(bytes, f32::from_le_bytes)),
            (Kind::Float32, Big) => Numbers::F32(each(bytes, f32::from_be_bytes)),
            (Kind::Float64, Little) => each(bytes, f64::from_le_bytes).into(),
            (Kind::Float64, Big) => each(bytes, f64::from_be_bytes).into(),
            (Kind::Int8, _) => each(bytes, |b| f64::from(i8::from_le_bytes(b))).into(),
            (Kind::UInt8, _) => each(bytes, |[b]| f64::from(b)).into(),
            (Kind::Int16, Little) => each(bytes, |b| f64::from(i16::from_le_bytes(b))).into(),
            (Kind::Int16, Big) => each(bytes, |b| f64::from(i16::from_be_bytes(b))).into(),
            (Kind::UInt16, Little) => each(bytes, |b| f64::from(u16::from_le_bytes(b))).into(),
            (Kind::UInt16, Big) => each(bytes, |b| f64::from(u16::from_be_bytes(b))).into(),
            (Kind::Int32, Little) => each(bytes, |b| f64::from(i32::from_le_bytes(b))).into(),
            (Kind::Int32, Big) => each(bytes, |b| f64::from(i32::from_be_bytes(b))).into(),
            (Kind::UInt32, Little) => each(bytes, |b| f64::from(u32::from_le_bytes(b))).into(),
            (Kind::UInt32, Big) => each(bytes, |b| f64::from(u32::from_be_bytes(b))).into(),
            (Kind::Int64, Little) => each(bytes, |b| i64::from_le_bytes(b) as f64).into(),
            (Kind::Int64, Big) => each(bytes, |b| i64::from_be_bytes(b) as f64).into(),
            (Kind::UInt64, Little) => each(bytes, |b| u64::from_le_bytes(b) as f64).into(),
            (Kind::UInt64, Big) => each(bytes, |b| u64::from_be_bytes(b) as f64).into(),
        }
    }
}

/// One number from every `N` bytes.
fn each<const N: usize, T>(bytes: &[u8], number: impl Fn([u8; N]) -> T) -> Vec<T> {
    bytes.as_chunks::<N>().0.iter().map(|&chunk| number(chunk)).collect()
}

/// Words of a text between white space, and how far it was read.
#[derive(Clone, Debug)]
pub(super) struct Words<'a> {
    pub bytes: &'a [u8],
    /// Offset of the first byte not read yet.
    pub position: usize,
}

impl<'a> Words<'a> {
    pub fn remaining(&self) -> usize {
        self.bytes.len() - self.position
    }

    pub fn skip_white_space(&mut self) {
        let rest = &self.bytes[self.position..];
        self.position += rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        self.skip_white_space();
        let rest = &self.bytes[self.position..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.position += length;
        (length > 0).then_some(&rest[..length])
    }
}

/// Why a text does not hold the numbers that it should, after how many that it does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum TextFault {
    Ended { after: usize },
    NotANumber { word: String, after: usize },
}

/// The next `count` numbers of a text; on a fault `words` stand before the word at fault.
pub(super) fn read_text(words: &mut Words<'_>, kind: Kind, count: usize) -> Result<Numbers, TextFault> {
    if kind.is_single() {
        read_words::<f32>(words, count).map(Numbers::F32)
    } else {
        read_words::<f64>(words, count).map(Numbers::F64)
    }
}

fn read_words<T: FromStr + From<f32>>(words: &mut Words<'_>, count: usize) -> Result<Vec<T>, TextFault> {
    // Every number takes a digit and, but for the last, a space: a larger count is a lie.
    let mut numbers = Vec::with_capacity(count.min(words.remaining() / 2 + 1));
    while numbers.len() < count {
        words.skip_white_space();
        let start = words.position;
        let Some(word) = words.next() else {
            return Err(TextFault::Ended { after: numbers.len() });
        };
        match number(word) {
            Some(number) => numbers.push(number),
            None => {
                words.position = start;
                return Err(TextFault::NotANumber { word: shown(word), after: numbers.len() });
            }
        }
    }
    Ok(numbers)
}

fn number<T: FromStr + From<f32>>(word: &[u8]) -> Option<T> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| non_finite(text).map(T::from))
}

/// NaN and infinity as some C libraries print them, which Rust does not read.
fn non_finite(text: &str) -> Option<f32> {
    let (sign, rest) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let lower = rest.to_ascii_lowercase();
    if lower.starts_with("1.#inf") {
        return Some(sign * f32::INFINITY);
    }
    ["nan(", "1.#qnan", "1.#snan", "1.#ind"].iter().any(|nan| lower.starts_with(nan)).then_some(f32::NAN)
}

/// A word of a file as an error shows it: short, and printable whatever its bytes are.
pub(super) fn shown(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&word[..word.len().min(LONGEST)]);
    let dots = if word.len() > LONGEST { "..." } else { "" };
    format!("`{}{dots}`", text.escape_debug())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(kind: Kind, text: &str, count: usize) -> Result<Numbers, TextFault> {
        read_text(&mut Words { bytes: text.as_bytes(), position: 0 }, kind, count)
    }

    #[test]
    fn binary_numbers_of_both_orders() {
        assert_eq!(Kind::Float32.decode(&1.5f32.to_be_bytes(), 1, Order::Big), Numbers::F32(vec![1.5]));
        assert_eq!(Kind::Float64.decode(&1.5f64.to_le_bytes(), 1, Order::Little), Numbers::F64(vec![1.5]));
        assert_eq!(Kind::Int8.decode(&[0xff], 1, Order::Big), Numbers::F64(vec![-1.0]));
        assert_eq!(Kind::UInt16.decode(&[1, 2, 0, 3], 2, Order::Big), Numbers::F64(vec![258.0, 3.0]));
        assert_eq!(Kind::Int64.decode(&(-7i64).to_le_bytes(), 1, Order::Little), Numbers::F64(vec![-7.0]));
        assert_eq!(Kind::Bit.decode(&[0b1010_0000, 0x80], 9, Order::Big).len(), 9);
        assert_eq!(Kind::Bit.decode(&[0b1010_0000], 3, Order::Big), Numbers::F32(vec![1.0, 0.0, 1.0]));
    }

    #[test]
    fn text_keeps_the_precision_of_its_type() {
        assert_eq!(text(Kind::Float32, "0.1\n-2e3", 2), Ok(Numbers::F32(vec![0.1, -2e3])));
        assert_eq!(text(Kind::Float64, " 0.1 ", 1), Ok(Numbers::F64(vec![0.1])));
        assert_eq!(text(Kind::UInt8, "255", 1), Ok(Numbers::F64(vec![255.0])));
    }

    #[test]
    fn text_reads_what_c_prints_for_non_finite_numbers() {
        let Ok(Numbers::F32(read)) =
            text(Kind::Float32, "nan -nan(ind) 1.#QNAN -1.#IND00 inf -1.#INF -inf", 7)
        else {
            panic!("not read");
        };
        assert!(read[..4].iter().all(|x| x.is_nan()));
        assert_eq!(read[4..], [f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY]);
    }

    #[test]
    fn text_faults_say_after_how_many() {
        assert_eq!(text(Kind::Float32, "1 2", 3), Err(TextFault::Ended { after: 2 }));
        assert_eq!(
            text(Kind::Float32, "1 x2 3", 3),
            Err(TextFault::NotANumber { word: "`x2`".into(), after: 1 })
        );
        assert_eq!(text(Kind::Float32, "1", usize::MAX), Err(TextFault::Ended { after: 1 }));
    }

    #[test]
    fn words_are_shown_short_and_printable() {
        assert_eq!(shown(b"POINTS"), "`POINTS`");
        assert_eq!(shown(b"\x00\n"), "`\\0\\n`");
        assert!(shown(&[b'x'; 1000]).len() < 60);
    }
}
