//! The bytes of one binary array: a header of words, then blocks that may be compressed, all of it
//! raw or as base64.

use std::borrow::Cow;

use flate2::{Decompress, FlushDecompress, Status};
use rayon::prelude::*;

use crate::frames::readers::vtk_numbers::Order;

use super::encoded::Encoded;

/// How the binary arrays of a file are written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Bytes of a header word: 4 or 8.
    pub word: usize,
    pub order: Order,
    pub compressor: Option<Compressor>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compressor {
    Zlib,
    Lz4,
}

impl Compressor {
    /// The most bytes that one compressed byte can stand for.
    fn largest_ratio(self) -> usize {
        match self {
            Compressor::Zlib => 1032,
            Compressor::Lz4 => 255,
        }
    }
}

/// An array whose header was found to say what is expected, and whose bytes may be there.
#[derive(Debug)]
pub(super) enum Opened<'a> {
    Empty,
    Plain {
        encoded: Encoded<'a>,
        word: usize,
        expected: usize,
    },
    Compressed {
        body: Encoded<'a>,
        sizes: Vec<usize>,
        total: usize,
        size: usize,
        expected: usize,
        by: Compressor,
    },
}

/// Checks the header of an array that should hold `expected` bytes against those and against the
/// bytes that are there, so that nothing need be allocated on the word of either.
pub(super) fn open(encoded: Encoded<'_>, layout: Layout, expected: usize) -> Result<Opened<'_>, String> {
    match layout.compressor {
        None => open_plain(encoded, layout, expected),
        Some(by) => open_compressed(encoded, layout, by, expected),
    }
}

fn open_plain(encoded: Encoded<'_>, layout: Layout, expected: usize) -> Result<Opened<'_>, String> {
    let header = encoded.take(layout.word, "an array header")?;
    check_size(words(&header, layout).first().copied().flatten(), expected)?;
    match layout.word.checked_add(expected) {
        Some(total) if total <= encoded.capacity() => {
            Ok(Opened::Plain { encoded, word: layout.word, expected })
        }
        _ => Err(truncated(Some(expected), encoded)),
    }
}

/// Header: the number of blocks, the size of each and of the last one (0: like the others) before
/// compression, and the compressed size of each.
fn open_compressed(
    encoded: Encoded<'_>,
    layout: Layout,
    by: Compressor,
    expected: usize,
) -> Result<Opened<'_>, String> {
    let count = words(&encoded.take(layout.word, "an array header")?, layout).first().copied().flatten();
    let fits = |&count: &usize| count <= encoded.capacity() / layout.word;
    let count = count.filter(fits).ok_or_else(|| {
        format!("expected a number of compressed blocks that fits the file, found {}", shown(count))
    })?;
    if count == 0 {
        return check_size(Some(0), expected).map(|()| Opened::Empty);
    }
    let header_bytes = (count + 3) * layout.word;
    let header = words(&encoded.take(header_bytes, "a header of compressed blocks")?, layout);
    let size = block_size(count, header[1], header[2], expected)?;
    if expected == 0 {
        return Ok(Opened::Empty);
    }
    let sizes: Option<Vec<usize>> = header[3..].iter().copied().collect();
    let total = sizes.as_ref().and_then(|sizes| sizes.iter().try_fold(0usize, |sum, &n| sum.checked_add(n)));
    let body = encoded.after(header_bytes);
    let (Some(sizes), Some(total)) = (sizes, total.filter(|&total| total <= body.capacity())) else {
        return Err(truncated(total, body));
    };
    if expected / by.largest_ratio() > total {
        return Err(format!("expected {expected} bytes, which {total} compressed bytes cannot hold"));
    }
    Ok(Opened::Compressed { body, sizes, total, size, expected, by })
}

/// The size of every block but the last, once the sizes in the header add up to what is expected.
fn block_size(
    count: usize,
    size: Option<usize>,
    last: Option<usize>,
    expected: usize,
) -> Result<usize, String> {
    let last = if last == Some(0) { size } else { last };
    let whole = size.and_then(|size| size.checked_mul(count - 1));
    check_size(whole.zip(last).and_then(|(whole, last)| whole.checked_add(last)), expected)?;
    match (size, last) {
        (Some(size), Some(last)) if last <= size => Ok(size),
        _ => Err(format!("expected a last block of at most {} bytes, found {}", shown(size), shown(last))),
    }
}

impl<'a> Opened<'a> {
    /// The bytes of the array, exactly as many as were expected.
    pub fn bytes(self) -> Result<Cow<'a, [u8]>, String> {
        match self {
            Opened::Empty => Ok(Cow::Borrowed(&[])),
            Opened::Plain { encoded, word, expected } if encoded.breaks_after(word) => {
                encoded.after(word).take(expected, "an array")
            }
            // Header and data were encoded in one go.
            Opened::Plain { encoded, word, expected } => {
                let mut bytes = encoded.take(word + expected, "an array")?.into_owned();
                bytes.drain(..word);
                Ok(Cow::Owned(bytes))
            }
            Opened::Compressed { body, sizes, total, size, expected, by } => {
                let body = body.take(total, "compressed blocks")?;
                decompress(&body, &sizes, size, by, expected).map(Cow::Owned)
            }
        }
    }
}

/// Decompresses blocks of `sizes` compressed bytes each into `expected` bytes, `size` from each
/// block but the last.
fn decompress(
    body: &[u8],
    sizes: &[usize],
    size: usize,
    by: Compressor,
    expected: usize,
) -> Result<Vec<u8>, String> {
    let mut start = 0;
    let blocks: Vec<&[u8]> = sizes
        .iter()
        .map(|&length| {
            start += length;
            &body[start - length..start]
        })
        .collect();
    let mut bytes = vec![0; expected];
    bytes.par_chunks_mut(size).zip(blocks).enumerate().try_for_each(|(index, (into, block))| {
        let wrong = |why: &str| format!("compressed block {index} is damaged: {why}");
        match by {
            Compressor::Zlib => {
                let mut zlib = Decompress::new(true);
                match zlib.decompress(block, into, FlushDecompress::Finish) {
                    Ok(Status::StreamEnd) if zlib.total_out() == into.len() as u64 => Ok(()),
                    Ok(_) => Err(wrong(&format!("expected {} bytes from zlib", into.len()))),
                    Err(error) => Err(wrong(&error.to_string())),
                }
            }
            Compressor::Lz4 => match lz4_flex::block::decompress_into(block, into) {
                Ok(length) if length == into.len() => Ok(()),
                Ok(length) => Err(wrong(&format!("expected {} bytes from LZ4, found {length}", into.len()))),
                Err(error) => Err(wrong(&error.to_string())),
            },
        }
    })?;
    Ok(bytes)
}

/// Header words; `None` for one past the address space.
fn words(bytes: &[u8], layout: Layout) -> Vec<Option<usize>> {
    bytes
        .chunks_exact(layout.word)
        .map(|chunk| {
            let join = |word: u64, &byte: &u8| word << 8 | u64::from(byte);
            let word = match layout.order {
                Order::Little => chunk.iter().rev().fold(0, join),
                Order::Big => chunk.iter().fold(0, join),
            };
            usize::try_from(word).ok()
        })
        .collect()
}

fn check_size(found: Option<usize>, expected: usize) -> Result<(), String> {
    if found == Some(expected) {
        return Ok(());
    }
    Err(format!("expected {expected} bytes, found a header that says {}", shown(found)))
}

fn shown(size: Option<usize>) -> String {
    size.map_or_else(|| "more than any file holds".into(), |size| size.to_string())
}

fn truncated(expected: Option<usize>, encoded: Encoded<'_>) -> String {
    format!("truncated: expected {} bytes, at most {} are left", shown(expected), encoded.capacity())
}

#[cfg(test)]
mod tests;
