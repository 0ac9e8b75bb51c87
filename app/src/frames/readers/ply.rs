//! PLY: the header, and binary vertices.

use super::error::{Fault, Place};
use super::layout::{Layout, Source};
use super::rows::{Cells, Endian, Scalar, Target};
use super::{ply_ascii, text::quote};
use crate::frames::{Frame, Metadata};

pub fn parse(bytes: &[u8]) -> Result<Frame, Fault> {
    let header = Header::parse(bytes)?;
    match header.format {
        Format::Ascii => ply_ascii::parse(&header, bytes),
        Format::Binary(endian) => parse_binary(&header, bytes, endian),
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Ascii,
    Binary(Endian),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
}

pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

pub(super) struct Header {
    format: Format,
    elements: Vec<Element>,
    /// Where the data begins: its byte and its line.
    pub start: usize,
    pub start_line: usize,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Header, Fault> {
        let mut format = None;
        let mut elements = Vec::new();
        let mut start = 0;
        let mut line = 0;
        while let Some(end) = bytes[start..].iter().position(|&b| b == b'\n') {
            let content = String::from_utf8_lossy(&bytes[start..start + end]);
            start += end + 1;
            line += 1;
            let words: Vec<&str> = content.split_whitespace().collect();
            let fault = |what: String| Fault::at(what, Place::Line(line));
            match (line, words.as_slice()) {
                (1, ["ply"]) => {}
                (1, _) => {
                    return Err(fault(format!("not a PLY file, expected `ply`, found {}", quote(&content))));
                }
                (_, [] | ["comment" | "obj_info", ..]) => {}
                (_, ["format", name, _version]) => format = Some(parse_format(name).map_err(fault)?),
                (_, ["element", name, count]) => elements.push(parse_element(name, count).map_err(fault)?),
                (_, ["property", rest @ ..]) => {
                    let property = parse_property(rest).map_err(fault)?;
                    let element: &mut Element =
                        elements.last_mut().ok_or_else(|| fault("`property` before any `element`".into()))?;
                    element.properties.push(property);
                }
                (_, ["end_header"]) => {
                    let format = format.ok_or_else(|| fault("header has no `format` line".into()))?;
                    return Ok(Header { format, elements, start, start_line: line });
                }
                _ => {
                    return Err(fault(format!(
                        "expected a line of a PLY header or `end_header`, found {}",
                        quote(&content)
                    )));
                }
            }
        }
        let what = if line == 0 { "not a PLY file, expected `ply`" } else { "file ends before `end_header`" };
        Err(Fault::at(what, Place::Line(line + 1)))
    }

    /// The elements before the vertices, and the vertices.
    pub fn vertices(&self) -> Result<(&[Element], &Element), Fault> {
        let index = self.elements.iter().position(|element| element.name == "vertex");
        match index {
            Some(index) => Ok((&self.elements[..index], &self.elements[index])),
            None => Err(Fault::at("no `element vertex`", Place::Part("header".into()))),
        }
    }
}

fn parse_format(name: &str) -> Result<Format, String> {
    match name {
        "ascii" => Ok(Format::Ascii),
        "binary_little_endian" => Ok(Format::Binary(Endian::Little)),
        "binary_big_endian" => Ok(Format::Binary(Endian::Big)),
        _ => {
            Err(format!("format {}, expected ascii, binary_little_endian or binary_big_endian", quote(name)))
        }
    }
}

fn parse_element(name: &str, count: &str) -> Result<Element, String> {
    let count = count.parse().map_err(|_| {
        format!("element {} has count {}, expected a whole number", quote(name), quote(count))
    })?;
    Ok(Element { name: name.to_owned(), count, properties: Vec::new() })
}

fn parse_property(words: &[&str]) -> Result<Property, String> {
    let (name, kind) = match words {
        ["list", count, item, name] => {
            (name, Kind::List { count: parse_scalar(count)?, item: parse_scalar(item)? })
        }
        [scalar, name] => (name, Kind::Scalar(parse_scalar(scalar)?)),
        _ => return Err("expected `property <type> <name>` or `property list <type> <type> <name>`".into()),
    };
    Ok(Property { name: (*name).to_owned(), kind })
}

fn parse_scalar(name: &str) -> Result<Scalar, String> {
    Ok(match name {
        "char" | "int8" => Scalar::I8,
        "uchar" | "uint8" => Scalar::U8,
        "short" | "int16" => Scalar::I16,
        "ushort" | "uint16" => Scalar::U16,
        "int" | "int32" => Scalar::I32,
        "uint" | "uint32" => Scalar::U32,
        "int64" => Scalar::I64,
        "uint64" => Scalar::U64,
        "float" | "float32" => Scalar::F32,
        "double" | "float64" => Scalar::F64,
        _ => return Err(format!("property type {} is unknown", quote(name))),
    })
}

impl Element {
    /// The columns that particles keep, and a warning for every list that they do not.
    pub fn layout(&self) -> Result<(Layout, Vec<String>), Fault> {
        let mut sources = Vec::new();
        let mut warnings = Vec::new();
        for Property { name, kind } in &self.properties {
            match kind {
                Kind::Scalar(scalar) => {
                    sources.push(Source { name: name.clone(), components: 1, double: scalar.is_double() });
                }
                Kind::List { .. } => {
                    warnings.push(format!("vertex property `{name}` is a list and is left out"))
                }
            }
        }
        let at_vertex = |fault: Fault| Fault { place: Some(Place::Part("element vertex".into())), ..fault };
        Ok((Layout::of(&sources).map_err(at_vertex)?, warnings))
    }

    /// Bytes of a row, where every row has the same.
    fn stride(&self) -> Option<usize> {
        self.properties.iter().try_fold(0, |sum, property| match property.kind {
            Kind::Scalar(scalar) => Some(sum + scalar.bytes()),
            Kind::List { .. } => None,
        })
    }

    /// Where the rows of this element end, given where they begin; every row is shown to `row`.
    fn walk(
        &self,
        bytes: &[u8],
        start: usize,
        endian: Endian,
        mut row: impl FnMut(Scalar, &[u8]),
    ) -> Result<usize, Fault> {
        if let Some(0) = self.stride() {
            return Ok(start);
        }
        let mut at = start;
        for index in 0..self.count {
            for property in &self.properties {
                let cut = || self.cut(index, at);
                match property.kind {
                    Kind::Scalar(scalar) => {
                        row(scalar, bytes.get(at..at + scalar.bytes()).ok_or_else(cut)?);
                        at += scalar.bytes();
                    }
                    Kind::List { count, item } => {
                        let items =
                            list_length(bytes.get(at..at + count.bytes()).ok_or_else(cut)?, count, endian);
                        let items = items.ok_or_else(|| {
                            let what = format!(
                                "a list of property `{}` has a length that is no count",
                                property.name
                            );
                            Fault::at(what, Place::Byte(at as u64))
                        })?;
                        let end = items
                            .checked_mul(item.bytes() as u64)
                            .and_then(|length| length.checked_add((at + count.bytes()) as u64));
                        at = end.filter(|&end| end <= bytes.len() as u64).ok_or_else(cut)? as usize;
                    }
                }
            }
        }
        Ok(at)
    }

    fn cut(&self, row: u64, at: usize) -> Fault {
        let what = format!("file ends in row {row} of {} of element `{}`", self.count, self.name);
        Fault::at(what, Place::Byte(at as u64))
    }

    /// The bytes of all rows, where they are of one size.
    fn fixed<'a>(&self, bytes: &'a [u8], start: usize, stride: usize) -> Result<&'a [u8], Fault> {
        let found = &bytes[start..];
        let needed = self.count.checked_mul(stride as u64).filter(|&needed| needed <= found.len() as u64);
        needed.map(|needed| &found[..needed as usize]).ok_or_else(|| {
            let what = format!(
                "element `{}` has {} rows of {stride} bytes, expected {} bytes, found {}",
                self.name,
                self.count,
                u128::from(self.count) * stride as u128,
                found.len()
            );
            Fault::at(what, Place::Byte(start as u64))
        })
    }
}

fn list_length(bytes: &[u8], scalar: Scalar, endian: Endian) -> Option<u64> {
    let mut wide = [0; 8];
    match endian {
        Endian::Little => wide[..bytes.len()].copy_from_slice(bytes),
        Endian::Big => wide[8 - bytes.len()..].copy_from_slice(bytes),
    }
    let value = if endian == Endian::Little { u64::from_le_bytes(wide) } else { u64::from_be_bytes(wide) };
    let signed = matches!(scalar, Scalar::I8 | Scalar::I16 | Scalar::I32 | Scalar::I64);
    let negative = signed && value >> (8 * bytes.len() - 1) == 1;
    (!negative && !matches!(scalar, Scalar::F32 | Scalar::F64)).then_some(value)
}

fn parse_binary(header: &Header, bytes: &[u8], endian: Endian) -> Result<Frame, Fault> {
    let (before, vertices) = header.vertices()?;
    let (layout, warnings) = vertices.layout()?;
    let mut start = header.start;
    for element in before {
        start = match element.stride() {
            Some(stride) => start + element.fixed(bytes, start, stride)?.len(),
            None => element.walk(bytes, start, endian, |_, _| {})?,
        };
    }
    let packed;
    let rows = match vertices.stride() {
        Some(stride) => vertices.fixed(bytes, start, stride)?,
        None => {
            // Rows with lists differ in size; without the lists they do not.
            let mut scalars = Vec::new();
            vertices.walk(bytes, start, endian, |_, cell| scalars.extend_from_slice(cell))?;
            packed = scalars;
            &packed
        }
    };
    let mut frame = decode(vertices, &layout, rows, endian)?;
    frame.warnings = warnings;
    Ok(frame)
}

fn decode(vertices: &Element, layout: &Layout, rows: &[u8], endian: Endian) -> Result<Frame, Fault> {
    let scalars: Vec<Scalar> = vertices
        .properties
        .iter()
        .filter_map(|property| match property.kind {
            Kind::Scalar(scalar) => Some(scalar),
            Kind::List { .. } => None,
        })
        .collect();
    let stride: usize = scalars.iter().map(|scalar| scalar.bytes()).sum();
    let mut tables = layout.zeroed(rows.len() / stride);
    let mut offset = 0;
    for (&scalar, &(table, first)) in scalars.iter().zip(&layout.slots) {
        let components = layout.tables[table].components;
        let cells = Cells { offset, stride, scalar, endian, count: 1 };
        cells.copy(rows, Target { numbers: &mut tables[table], components, first });
        offset += scalar.bytes();
    }
    layout.frame(tables, Metadata::default())
}
