//! PLY with its rows in text.

use super::error::{Fault, Place};
use super::ply::{Element, Header, Kind};
use super::rows::Scalar;
use super::text::{number, quote};
use crate::frames::{Frame, Metadata, Numbers};

pub(super) fn parse(header: &Header, bytes: &[u8]) -> Result<Frame, Fault> {
    let (before, vertices) = header.vertices()?;
    let (layout, warnings) = vertices.layout()?;
    let text = String::from_utf8_lossy(&bytes[header.start..]);
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, line)| (header.start_line + 1 + index, line.trim()))
        .filter(|(_, line)| !line.is_empty());
    for element in before.iter().filter(|element| !element.properties.is_empty()) {
        for row in 0..element.count {
            lines.next().ok_or_else(|| cut(element, row))?;
        }
    }
    let mut tables = layout.zeroed(0);
    for row in 0..vertices.count {
        let (line, content) = lines.next().ok_or_else(|| cut(vertices, row))?;
        for (table, numbers) in layout.tables.iter().zip(&mut tables) {
            grow(numbers, table.components);
        }
        let mut words = content.split_ascii_whitespace();
        let mut slots = layout.slots.iter();
        for property in &vertices.properties {
            let word = words.next();
            let Some(word) = word else {
                let what = format!(
                    "row has no `{}`, expected {} properties",
                    property.name,
                    vertices.properties.len()
                );
                return Err(Fault::at(what, Place::Line(line)));
            };
            let fault = || {
                let what = format!("expected a number for `{}`, found {}", property.name, quote(word));
                Fault::at(what, Place::Line(line))
            };
            match property.kind {
                Kind::Scalar(scalar) => {
                    if let Some(&(table, component)) = slots.next() {
                        let back = layout.tables[table].components - component;
                        set(&mut tables[table], back, scalar, word).ok_or_else(fault)?;
                    }
                }
                Kind::List { .. } => {
                    let items: usize = word.parse().map_err(|_| fault())?;
                    if items > 0 {
                        words.nth(items - 1).ok_or_else(fault)?;
                    }
                }
            }
        }
    }
    let mut frame = layout.frame(tables, Metadata::default())?;
    frame.warnings = warnings;
    Ok(frame)
}

fn cut(element: &Element, row: u64) -> Fault {
    let what = format!("file ends after {row} of {} rows", element.count);
    Fault::at(what, Place::Part(format!("element {}", element.name)))
}

/// One row of zeros more.
fn grow(numbers: &mut Numbers, components: usize) {
    match numbers {
        Numbers::F32(values) => values.resize(values.len() + components, 0.0),
        Numbers::F64(values) => values.resize(values.len() + components, 0.0),
    }
}

/// Sets the number that is `back` from the end. A `float` is rounded once, from its decimal digits.
fn set(numbers: &mut Numbers, back: usize, scalar: Scalar, word: &str) -> Option<()> {
    match numbers {
        Numbers::F32(values) => {
            let direct = (scalar == Scalar::F32).then(|| word.parse().ok()).flatten();
            let value = direct.or_else(|| number(word).map(|value| value as f32))?;
            let index = values.len() - back;
            values[index] = value;
        }
        Numbers::F64(values) => {
            let index = values.len() - back;
            values[index] = match scalar {
                // Beside an f64 component; the same value that a binary file would give.
                Scalar::F32 => f64::from(number(word)? as f32),
                _ => number(word)?,
            };
        }
    }
    Some(())
}
