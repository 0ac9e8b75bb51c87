//! NumPy archives: a zip of arrays, with the fields named as the members are.

use std::io::{Cursor, Read};

use zip::ZipArchive;
use zip::result::ZipError;

use super::error::Fault;
use super::layout::{Layout, Source, from_columns};
use super::npy::{Array, in_array};
use super::npy_header::DType;
use crate::frames::{Column, Frame, Metadata};

/// The most that deflate can make of one byte, rounded up.
const DEFLATE_RATIO: u64 = 1100;
/// Arrays of another length than the particles are parameters up to this size (a box, gravity), and
/// a mistake above it.
const LARGEST_PARAMETER: u64 = 16;

pub fn parse(bytes: &[u8]) -> Result<Frame, Fault> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| zip_fault(&error))?;
    // All members together: they may lie over each other in the file.
    let mut budget = (bytes.len() as u64).saturating_mul(DEFLATE_RATIO);
    let mut contents = Contents::default();
    for index in 0..archive.len() {
        let mut member = archive.by_index(index).map_err(|error| zip_fault(&error))?;
        let path = member.name().map_err(|error| zip_fault(&error))?.into_owned();
        let Some(name) = path.strip_suffix(".npy") else { continue };
        let expected =
            member.size().min(member.compressed_size().saturating_mul(4)).min(bytes.len() as u64 * 4);
        let mut content = Vec::with_capacity(expected as usize);
        (&mut member)
            .take(budget + 1)
            .read_to_end(&mut content)
            .map_err(|error| in_array(name, Fault::new(format!("archive member is damaged ({error})"))))?;
        budget = budget
            .checked_sub(content.len() as u64)
            .ok_or_else(|| in_array(name, Fault::new("archive swells beyond what its compression can do")))?;
        contents.add(name, &content).map_err(|fault| in_array(name, fault))?;
    }
    contents.frame()
}

fn zip_fault(error: &ZipError) -> Fault {
    Fault::new(format!("not a whole zip archive ({error}), expected an .npz of NumPy arrays"))
}

/// What the members hold.
#[derive(Default)]
struct Contents {
    columns: Vec<(String, Column)>,
    metadata: Metadata,
    warnings: Vec<String>,
}

impl Contents {
    fn add(&mut self, name: &str, content: &[u8]) -> Result<(), Fault> {
        let array = Array::parse(content)?;
        let header = &array.header;
        if !matches!(header.dtype, DType::Plain(..)) {
            self.warnings.push(format!("`{name}` ({}) is left out", header.describe()));
            return Ok(());
        }
        let slot = match name.trim().to_ascii_lowercase().as_str() {
            "particle_radius" => Some(&mut self.metadata.particle_radius),
            "support_radius" => Some(&mut self.metadata.support_radius),
            "particle_mass" => Some(&mut self.metadata.particle_mass),
            "time" => Some(&mut self.metadata.time),
            _ => None,
        };
        match slot {
            Some(slot) if array.scalar().is_some() => *slot = array.scalar(),
            _ if header.shape.is_empty() => {}
            _ if header.fortran && header.shape.len() > 2 => {
                self.warnings.push(format!("`{name}` ({}, Fortran order) is left out", header.describe()));
            }
            _ if header.components() == 0 => {
                self.warnings.push(format!("`{name}` ({}) is left out", header.describe()));
            }
            _ => self.columns.push((name.to_owned(), array.column()?)),
        }
        Ok(())
    }

    fn frame(mut self) -> Result<Frame, Fault> {
        let sources: Vec<Source> =
            self.columns.iter().map(|(name, column)| Source::of(name, column)).collect();
        let whole = Layout::of(&sources)?;
        let rows =
            self.columns.iter().zip(&whole.slots).find(|(_, slot)| slot.0 == 0).map_or(0, |(c, _)| c.1.len());
        let mut kept = Vec::new();
        for (name, column) in self.columns {
            let numbers = column.numbers().len() as u64;
            if column.len() == rows {
                kept.push((name, column));
            } else if numbers <= LARGEST_PARAMETER {
                self.warnings
                    .push(format!("`{name}` has {} rows for {rows} particles and is left out", column.len()));
            } else {
                let what = format!("{} rows, expected {rows}, one for each particle", column.len());
                return Err(in_array(&name, Fault::new(what)));
            }
        }
        let mut frame = from_columns(kept, self.metadata)?;
        frame.warnings = self.warnings;
        Ok(frame)
    }
}
