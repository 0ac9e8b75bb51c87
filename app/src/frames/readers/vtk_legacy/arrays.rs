//! Arrays of a legacy file: their type names, their numbers, and how to pass over them.

use crate::frames::Numbers;
use crate::frames::readers::error::Fault;
use crate::frames::readers::vtk_numbers::{Kind, Order, TextFault, read_text, shown};

use super::cursor::Cursor;

/// What an array's elements are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Element {
    Number(Kind),
    Text,
}

/// The next word as an element type.
pub(super) fn element(cursor: &mut Cursor<'_>) -> Result<Element, Fault> {
    let (word, start) = cursor.word("a data type such as float")?;
    let name = word.to_ascii_lowercase();
    Ok(Element::Number(match name.as_slice() {
        b"bit" => Kind::Bit,
        b"char" | b"signed_char" | b"vtktypeint8" => Kind::Int8,
        b"unsigned_char" | b"vtktypeuint8" => Kind::UInt8,
        b"short" | b"vtktypeint16" => Kind::Int16,
        b"unsigned_short" | b"vtktypeuint16" => Kind::UInt16,
        // VTK writes its index type as int into legacy files, whatever its width in memory.
        b"int" | b"vtktypeint32" | b"vtkidtype" => Kind::Int32,
        b"unsigned_int" | b"vtktypeuint32" => Kind::UInt32,
        b"long" | b"long_long" | b"vtktypeint64" => Kind::Int64,
        b"unsigned_long" | b"unsigned_long_long" | b"vtktypeuint64" => Kind::UInt64,
        b"float" | b"vtktypefloat32" => Kind::Float32,
        b"double" | b"vtktypefloat64" => Kind::Float64,
        b"string" | b"utf8_string" => return Ok(Element::Text),
        _ => {
            let what = format!("expected a data type such as float, found {}", shown(word));
            return Err(cursor.fault_at(start, what));
        }
    }))
}

/// The next word as a number type.
pub(super) fn number_kind(cursor: &mut Cursor<'_>) -> Result<Kind, Fault> {
    let start = cursor.position();
    match element(cursor)? {
        Element::Number(kind) => Ok(kind),
        Element::Text => Err(cursor.fault_at(start, "expected a data type such as float, found string")),
    }
}

/// `rows * components`, or the fault that no file holds so many.
pub(super) fn size(cursor: &Cursor<'_>, rows: usize, components: usize, what: &str) -> Result<usize, Fault> {
    rows.checked_mul(components).ok_or_else(|| {
        cursor.fault(format!("{what}: {rows} x {components} values are more than any file holds"))
    })
}

/// The `count` numbers that follow the line that announces them.
pub(super) fn numbers(
    cursor: &mut Cursor<'_>,
    kind: Kind,
    count: usize,
    what: &str,
) -> Result<Numbers, Fault> {
    if cursor.binary {
        let bytes = cursor.bytes(kind.bytes_for(count), what)?;
        return Ok(kind.decode(bytes, count, Order::Big));
    }
    if count > cursor.words.remaining() / 2 + 1 {
        let left = cursor.words.remaining();
        return Err(
            cursor.fault(format!("truncated: expected {count} values of {what}, {left} bytes are left"))
        );
    }
    read_text(&mut cursor.words, kind, count).map_err(|fault| match fault {
        TextFault::Ended { after } => {
            cursor.fault(format!("truncated: expected {count} values of {what}, the file ends after {after}"))
        }
        TextFault::NotANumber { word, after } => {
            cursor.fault(format!("expected {count} values of {what}, found {word} after {after}"))
        }
    })
}

/// Passes over `count` elements.
pub(super) fn skip(cursor: &mut Cursor<'_>, element: Element, count: usize, what: &str) -> Result<(), Fault> {
    match element {
        Element::Number(kind) if cursor.binary => cursor.bytes(kind.bytes_for(count), what).map(|_| ()),
        Element::Number(_) => {
            // In parts, so that passing over numbers takes no memory.
            const PART: usize = 4096;
            (0..count.div_ceil(PART)).try_for_each(|part| {
                numbers(cursor, Kind::Float64, PART.min(count - part * PART), what).map(|_| ())
            })
        }
        Element::Text => (0..count).try_for_each(|_| skip_string(cursor, what)),
    }
}

/// Passes over one string: a line of a text file; in a binary one its length, whose first two bits
/// say how many bytes the length itself takes, then its bytes.
fn skip_string(cursor: &mut Cursor<'_>, what: &str) -> Result<(), Fault> {
    if !cursor.binary {
        if cursor.at_end() {
            return Err(cursor.fault(format!("truncated: expected a string of {what}, the file ends")));
        }
        cursor.line();
        return Ok(());
    }
    let first = cursor.bytes(Some(1), what)?[0];
    let more = match first >> 6 {
        3 => 0,
        2 => 1,
        1 => 3,
        _ => 7,
    };
    let start = u64::from(first & 0x3f);
    let length = cursor.bytes(Some(more), what)?.iter().fold(start, |length, &b| length << 8 | u64::from(b));
    cursor.bytes(usize::try_from(length).ok(), what).map(|_| ())
}

/// Passes over the lines of a METADATA block, which an empty line or the end of the file ends.
pub(super) fn skip_metadata(cursor: &mut Cursor<'_>) {
    cursor.line();
    while !cursor.line().is_empty() {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_values_are_counted() {
        let mut cursor = Cursor::new(b"1 2 3 x");
        assert_eq!(numbers(&mut cursor, Kind::Int32, 3, "cells"), Ok(Numbers::F64(vec![1.0, 2.0, 3.0])));
        let fault = numbers(&mut cursor, Kind::Int32, 1, "cells").unwrap_err();
        assert!(fault.what.contains("`x`"), "{}", fault.what);
        assert!(numbers(&mut cursor, Kind::Int32, usize::MAX, "cells").is_err());
    }

    #[test]
    fn strings_are_passed_over_in_text_and_binary() {
        let mut cursor = Cursor::new(b"a b\nc\nPOINTS");
        skip(&mut cursor, Element::Text, 2, "names").unwrap();
        assert!(cursor.take_word("POINTS", true));
        assert!(skip(&mut cursor, Element::Text, 1, "names").is_err());

        let mut cursor = Cursor::new(b"\xc2ab\x80\x01cPOINTS");
        cursor.binary = true;
        skip(&mut cursor, Element::Text, 2, "names").unwrap();
        assert!(cursor.take_word("POINTS", true));
        let mut cursor = Cursor::new(b"\x3f\xff\xff\xff\xff\xff\xff\xff");
        cursor.binary = true;
        assert!(skip(&mut cursor, Element::Text, 1, "names").is_err());
    }

    #[test]
    fn metadata_ends_at_an_empty_line() {
        let mut cursor = Cursor::new(b"\nINFORMATION 1\nNAME a LOCATION b\n\nCELLS");
        skip_metadata(&mut cursor);
        assert!(cursor.take_word("CELLS", true));
        skip_metadata(&mut cursor);
        assert!(cursor.at_end());
    }
}
