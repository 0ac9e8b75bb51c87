//! `.xyz`: raw little-endian f32 triplets, rows of text, or the XYZ format of chemistry; content decides.

use super::csv;
use super::error::{Fault, Place};
use super::rows::{Cells, Endian, Scalar, Target, zeroed};
use super::text::{self, DataLines, quote};
use crate::frames::{Column, Frame, Metadata, Numbers};

/// Reads positions; no bytes at all are no particles.
pub fn parse(bytes: &[u8]) -> Result<Frame, Fault> {
    if is_text(bytes) { parse_text(&text::decode(bytes)) } else { parse_raw(bytes) }
}

/// Raw coordinates hold control bytes or broken UTF-8 within a few numbers.
fn is_text(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(4096)];
    if head.starts_with(&[0xff, 0xfe]) || head.starts_with(&[0xfe, 0xff]) {
        return head.contains(&b'\n');
    }
    let control = |b: &u8| *b == 0x7f || (*b < 0x20 && !matches!(b, b'\t' | b'\r' | b'\n' | 0x0c));
    let utf8 = match std::str::from_utf8(head) {
        Ok(_) => true,
        // A character may be cut at the end of the head.
        Err(error) => error.error_len().is_none(),
    };
    !head.is_empty() && utf8 && !head.iter().any(control) && (head.is_ascii() || head.contains(&b'\n'))
}

fn parse_raw(bytes: &[u8]) -> Result<Frame, Fault> {
    if !bytes.len().is_multiple_of(12) {
        let what = format!(
            "raw positions are 12 bytes each (three little-endian f32), found {} bytes: {} are left over",
            bytes.len(),
            bytes.len() % 12
        );
        return Err(Fault::at(what, Place::Byte((bytes.len() - bytes.len() % 12) as u64)));
    }
    let mut numbers = zeroed(bytes.len() / 4, false);
    let cells = Cells { offset: 0, stride: 12, scalar: Scalar::F32, endian: Endian::Little, count: 3 };
    cells.copy(bytes, Target { numbers: &mut numbers, components: 3, first: 0 });
    frame(numbers)
}

fn frame(numbers: Numbers) -> Result<Frame, Fault> {
    let positions = Column::new(3, numbers).ok_or_else(|| Fault::new("positions do not fill whole rows"))?;
    Frame::new(positions, Vec::new(), Metadata::default()).map_err(|error| Fault::new(error.to_string()))
}

fn parse_text(content: &str) -> Result<Frame, Fault> {
    let mut lines = text::data_lines(content);
    let rows = lines.clone();
    let Some((line, first)) = lines.next() else { return frame(Numbers::F64(Vec::new())) };
    let mut cells = cells(first);
    match (cells.next(), cells.next()) {
        (Some(count), None) => {
            let count = count.parse::<u64>().map_err(|_| {
                let what = format!("expected `x y z` or the number of atoms, found {}", quote(count));
                Fault::at(what, Place::Line(line))
            })?;
            parse_chemistry(lines, count)
        }
        // A header makes it a table.
        (Some(name), _) if text::number(name).is_none() => csv::parse(content.as_bytes()),
        _ => parse_rows(rows),
    }
}

fn cells(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| c.is_whitespace() || c == ',').filter(|cell| !cell.is_empty())
}

/// Three numbers from `cells`, and whether more follow.
fn triplet<'a>(line: usize, cells: &mut impl Iterator<Item = &'a str>) -> Result<([f64; 3], bool), Fault> {
    let mut position = [0.0; 3];
    for (axis, value) in ["x", "y", "z"].into_iter().zip(&mut position) {
        let cell = cells.next().ok_or_else(|| Fault::at(format!("row has no {axis}"), Place::Line(line)))?;
        *value = text::number(cell).ok_or_else(|| {
            Fault::at(format!("expected a number for {axis}, found {}", quote(cell)), Place::Line(line))
        })?;
    }
    Ok((position, cells.next().is_some()))
}

const MORE_COLUMNS: &str = "columns after x y z have no names and are left out";

fn parse_rows(rows: DataLines<'_>) -> Result<Frame, Fault> {
    let mut values = Vec::new();
    let mut more = false;
    for (line, row) in rows {
        let (position, rest) = triplet(line, &mut cells(row))?;
        values.extend(position);
        more |= rest;
    }
    let mut frame = frame(Numbers::F64(values))?;
    if more {
        frame.warnings.push(MORE_COLUMNS.to_owned());
    }
    Ok(frame)
}

/// A comment line, then `count` rows of symbol x y z.
fn parse_chemistry(mut lines: DataLines<'_>, count: u64) -> Result<Frame, Fault> {
    let mut last = lines.next_raw().map_or(1, |(line, _)| line);
    let mut values = Vec::new();
    let mut more = false;
    for atom in 0..count {
        let (line, row) = lines.next().ok_or_else(|| {
            Fault::at(format!("the count says {count} atoms, found {atom}"), Place::Line(last + 1))
        })?;
        let mut cells = cells(row);
        cells.next();
        let (position, rest) = triplet(line, &mut cells)?;
        values.extend(position);
        more |= rest;
        last = line;
    }
    let mut frame = frame(Numbers::F64(values))?;
    if more {
        frame.warnings.push(MORE_COLUMNS.to_owned());
    }
    if let Some((line, _)) = lines.next() {
        frame.warnings.push(format!("only the first frame is read; the rest begins in line {line}"));
    }
    Ok(frame)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_decides_between_raw_and_text() {
        let raw: Vec<u8> = [0.5f32, -1.0, 2.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        for (bytes, expected) in [
            (raw.as_slice(), [0.5, -1.0, 2.0]),
            (b"0.5 -1 2\n".as_slice(), [0.5, -1.0, 2.0]),
            (b"# c\n0.5, -1, 2\n", [0.5, -1.0, 2.0]),
            (b"1\n\xc3\x85ngstr\xc3\xb6m\nH 0.5 -1 2\n", [0.5, -1.0, 2.0]),
            (b"1\n\nH 0.5 -1 2 9\n", [0.5, -1.0, 2.0]),
            (b"x y z\n0.5 -1 2\n", [0.5, -1.0, 2.0]),
        ] {
            let frame = parse(bytes).unwrap();
            assert_eq!((frame.len(), frame.position(0)), (1, expected));
        }
        assert!(parse(b"").unwrap().is_empty());
    }

    #[test]
    fn faults_say_where() {
        let place = |bytes: &[u8]| parse(bytes).unwrap_err().place;
        assert_eq!(place(&[0; 25]), Some(Place::Byte(24)));
        assert_eq!(place(b"1 2 3\n1 2\n"), Some(Place::Line(2)));
        assert_eq!(place(b"1 2 3\n1 b 3\n"), Some(Place::Line(2)));
        assert_eq!(place(b"999999999999\ncomment\nH 1 2 3\n"), Some(Place::Line(4)));
        assert_eq!(place(b"-4\n"), Some(Place::Line(1)));
    }
}
