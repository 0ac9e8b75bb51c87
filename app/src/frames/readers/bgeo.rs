//! Houdini's old `.bgeo` (BgeoV, version 5), plain or in gzip, as Partio and SPlisHSPlasH write it.

use std::io::{self, Read};

use flate2::read::GzDecoder;

use super::cursor::Cursor;
use super::error::{Fault, Place};
use super::layout::{Layout, Source};
use super::rows::{Cells, Endian, Scalar, Target};
use crate::frames::{Frame, Metadata};

const GZIP: [u8; 2] = [0x1f, 0x8b];
/// A header of some attributes takes hundreds of bytes; one longer than this is damaged.
const LONGEST_HEADER: u64 = 1 << 20;
/// The most that deflate can make of one byte, rounded up.
const DEFLATE_RATIO: u64 = 1100;
/// x, y, z and w of every point.
const POSITION_BYTES: usize = 16;

pub fn parse(bytes: &[u8]) -> Result<Frame, Fault> {
    if bytes.starts_with(&GZIP) { parse_gzip(bytes) } else { Header::parse(bytes)?.frame(bytes) }
}

/// Reads the header first, and then as much as it asks for: no stream can swell beyond that.
fn parse_gzip(bytes: &[u8]) -> Result<Frame, Fault> {
    let head = inflate(&mut GzDecoder::new(bytes).take(LONGEST_HEADER), LONGEST_HEADER)?;
    let header = Header::parse(&head)?;
    let needed = header.end();
    if needed > (bytes.len() as u64).saturating_mul(DEFLATE_RATIO) {
        return Err(header.too_many(bytes.len() as u64, "a gzip stream of"));
    }
    let mut stream = GzDecoder::new(bytes);
    let content = inflate(&mut stream, needed)?;
    let frame = header.frame(&content)?;
    // What follows the points is of no use, but the checksum stands behind it.
    io::copy(&mut stream, &mut io::sink()).map_err(|error| gzip_fault(&error, needed))?;
    Ok(frame)
}

fn inflate(stream: &mut impl Read, limit: u64) -> Result<Vec<u8>, Fault> {
    let mut content = Vec::new();
    match stream.take(limit).read_to_end(&mut content) {
        Ok(_) => Ok(content),
        Err(error) => Err(gzip_fault(&error, content.len() as u64)),
    }
}

fn gzip_fault(error: &io::Error, offset: u64) -> Fault {
    let what = match error.kind() {
        io::ErrorKind::UnexpectedEof => "gzip stream is truncated".to_owned(),
        _ => format!("gzip stream is damaged ({error})"),
    };
    Fault::at(what, Place::Byte(offset))
}

struct Attribute {
    name: String,
    components: usize,
    scalar: Scalar,
}

struct Header {
    points: u64,
    attributes: Vec<Attribute>,
    /// Bytes of one point.
    stride: usize,
    /// Where the points begin.
    start: usize,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Header, Fault> {
        check_magic(bytes)?;
        let mut cursor = Cursor::new(bytes);
        cursor.take(5, "the header")?;
        let version = i32::from_be_bytes(cursor.array("the header")?);
        if version != 5 {
            return Err(Fault::at(format!("BgeoV version {version}, expected 5"), Place::Byte(5)));
        }
        let points = i32::from_be_bytes(cursor.array("the header")?);
        let points = u64::try_from(points)
            .map_err(|_| Fault::at(format!("point count is {points}, expected 0 or more"), Place::Byte(9)))?;
        // Primitives, point groups, primitive groups.
        cursor.take(12, "the header")?;
        let count = i32::from_be_bytes(cursor.array("the header")?);
        // Attributes of vertices, primitives and the whole.
        cursor.take(12, "the header")?;
        let mut attributes = Vec::new();
        for index in 0..count {
            attributes.push(Attribute::parse(&mut cursor, index)?);
        }
        let stride =
            POSITION_BYTES + attributes.iter().map(|attribute| 4 * attribute.components).sum::<usize>();
        Ok(Header { points, attributes, stride, start: cursor.offset() })
    }

    /// Where the points end.
    fn end(&self) -> u64 {
        // At most 2^31 points of at most 2^35 bytes: attributes are counted in what the file holds.
        self.start as u64 + self.points.saturating_mul(self.stride as u64)
    }

    fn too_many(&self, found: u64, of: &str) -> Fault {
        let Header { points, stride, .. } = self;
        let needed = self.points.saturating_mul(*stride as u64);
        let what = format!("{points} points of {stride} bytes, expected {needed} bytes, found {of} {found}");
        Fault::at(what, Place::Byte(self.start as u64))
    }

    fn frame(&self, bytes: &[u8]) -> Result<Frame, Fault> {
        let found = &bytes[self.start.min(bytes.len())..];
        let Some(points) = self.end().checked_sub(self.start as u64).filter(|&n| n <= found.len() as u64)
        else {
            return Err(self.too_many(found.len() as u64, "only"));
        };
        let points = &found[..points as usize];
        let mut sources = vec![Source { name: "position".into(), components: 3, double: false }];
        let mut cells = vec![Cells {
            offset: 0,
            stride: self.stride,
            scalar: Scalar::F32,
            endian: Endian::Big,
            count: 3,
        }];
        let mut offset = POSITION_BYTES;
        for Attribute { name, components, scalar } in &self.attributes {
            sources.push(Source { name: name.clone(), components: *components, double: scalar.is_double() });
            cells.push(Cells { offset, scalar: *scalar, count: *components, ..cells[0] });
            offset += 4 * components;
        }
        let layout = Layout::of(&sources)?;
        let mut tables = layout.zeroed(self.points as usize);
        for (cells, &(table, first)) in cells.into_iter().zip(&layout.slots) {
            let components = layout.tables[table].components;
            cells.copy(points, Target { numbers: &mut tables[table], components, first });
        }
        layout.frame(tables, Metadata::default())
    }
}

fn check_magic(bytes: &[u8]) -> Result<(), Fault> {
    if bytes.starts_with(b"BgeoV") {
        return Ok(());
    }
    let json = bytes.starts_with(b"\x7fNSJ") || bytes.starts_with(b"[");
    let what = if json {
        "the new JSON style of .bgeo (Houdini 12 and later) is not read, expected the old style `BgeoV`"
    } else {
        "not an old-style .bgeo file, expected it to begin with `BgeoV`"
    };
    Err(Fault::at(what, Place::Byte(0)))
}

impl Attribute {
    fn parse(cursor: &mut Cursor<'_>, index: i32) -> Result<Attribute, Fault> {
        let what = format!("point attribute {}", index + 1);
        let length = u16::from_be_bytes(cursor.array(&what)?);
        let name = String::from_utf8_lossy(cursor.take(usize::from(length), &what)?).into_owned();
        let components = usize::from(u16::from_be_bytes(cursor.array(&what)?));
        let place = cursor.here();
        let kind = i32::from_be_bytes(cursor.array(&what)?);
        if components == 0 {
            return Err(Fault::at(format!("point attribute `{name}` has size 0, expected 1 or more"), place));
        }
        let scalar = match kind {
            0 | 5 => Scalar::F32,
            1 | 4 => Scalar::I32,
            _ => {
                let what = format!(
                    "point attribute `{name}` has type {kind}, expected 0 (float), 1 (integer), 4 (index of strings) or 5 (vector)"
                );
                return Err(Fault::at(what, place));
            }
        };
        if kind == 4 {
            let strings = i32::from_be_bytes(cursor.array(&what)?);
            for _ in 0..strings {
                let length = u16::from_be_bytes(cursor.array(&what)?);
                cursor.take(usize::from(length), &what)?;
            }
        } else {
            // Default values.
            cursor.take(4 * components, &what)?;
        }
        Ok(Attribute { name, components, scalar })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One point with a string attribute of two strings and a vector.
    fn small() -> Vec<u8> {
        let mut bytes = b"BgeoV".to_vec();
        for number in [5i32, 1, 0, 0, 0, 2, 0, 0, 0] {
            bytes.extend(number.to_be_bytes());
        }
        bytes.extend([0, 4]);
        bytes.extend(b"kind");
        bytes.extend([0, 1, 0, 0, 0, 4, 0, 0, 0, 2, 0, 1, b'a', 0, 2, b'b', b'c']);
        bytes.extend([0, 1, b'v', 0, 3, 0, 0, 0, 5]);
        bytes.extend([0; 12]);
        for number in [1.0f32, 2.0, 3.0, 1.0] {
            bytes.extend(number.to_be_bytes());
        }
        bytes.extend(1i32.to_be_bytes());
        for number in [4.0f32, 5.0, 6.0] {
            bytes.extend(number.to_be_bytes());
        }
        bytes
    }

    #[test]
    fn attributes_of_every_kind() {
        let frame = parse(&small()).unwrap();
        assert_eq!(frame.position(0), [1.0, 2.0, 3.0]);
        assert_eq!(frame.field("kind").unwrap().column.get(0, 0), 1.0);
        assert_eq!(frame.field("v").unwrap().column.get(0, 2), 6.0);
    }

    #[test]
    fn a_cut_anywhere_is_an_error_with_its_place() {
        let bytes = small();
        for len in 0..bytes.len() {
            let fault = parse(&bytes[..len]).unwrap_err();
            assert!(matches!(fault.place, Some(Place::Byte(_))), "{len}: {fault:?}");
        }
    }

    #[test]
    fn counts_and_types_are_checked() {
        let mut bytes = small();
        bytes[9..13].copy_from_slice(&i32::MAX.to_be_bytes());
        assert!(parse(&bytes).unwrap_err().what.contains("2147483647 points"));
        let mut bytes = small();
        bytes[5..9].copy_from_slice(&7i32.to_be_bytes());
        assert!(parse(&bytes).unwrap_err().what.contains("version 7"));
        assert!(parse(b"\x7fNSJb").unwrap_err().what.contains("JSON"));
    }
}
