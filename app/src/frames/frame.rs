//! One time step as it was read: positions, fields, and what the file says about itself.

use super::column::Column;
use super::names;

/// A named array over the particles of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// As the file writes it.
    pub name: String,
    pub column: Column,
}

/// What a file, or the `run.json` beside it, says about a frame as a whole. Lengths in the unit of the positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    pub time: Option<f64>,
    /// Radius at which the kernel reaches zero, one for all particles.
    pub support_radius: Option<f64>,
    pub particle_radius: Option<f64>,
    /// One mass for all particles.
    pub particle_mass: Option<f64>,
    /// Support radius in units of the `smoothing_length` field: 1 where that field is the support
    /// radius itself (GADGET), 2 for codes whose kernels reach two smoothing lengths (PySPH, Phantom).
    pub support_per_smoothing_length: Option<f64>,
}

/// One time step of a run.
///
/// Every field has as many rows as there are positions; [`Frame::new`] is the only way in, so this
/// holds for every frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    positions: Column,
    fields: Vec<Field>,
    pub metadata: Metadata,
    /// What the reader had to work round, one line each, for the user to see.
    pub warnings: Vec<String>,
}

/// Why arrays do not make a frame.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    #[error("positions have {0} components, expected 3")]
    PositionComponents(usize),
    #[error("field `{name}` has {found} rows, expected {expected}, one for each particle")]
    FieldLength { name: String, found: usize, expected: usize },
}

impl Frame {
    /// A frame of `positions` (three components) and `fields` (one row for each position).
    pub fn new(positions: Column, fields: Vec<Field>, metadata: Metadata) -> Result<Self, FrameError> {
        if positions.components() != 3 {
            return Err(FrameError::PositionComponents(positions.components()));
        }
        for field in &fields {
            if field.column.len() != positions.len() {
                return Err(FrameError::FieldLength {
                    name: field.name.clone(),
                    found: field.column.len(),
                    expected: positions.len(),
                });
            }
        }
        Ok(Frame { positions, fields, metadata, warnings: Vec::new() })
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    pub fn positions(&self) -> &Column {
        &self.positions
    }

    pub fn position(&self, particle: usize) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.positions.get(particle, axis))
    }

    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// The field of that name, by any of its usual names, without regard to case; the name as
    /// written wins over an alias.
    pub fn field(&self, name: &str) -> Option<&Field> {
        let written = |field: &&Field| field.name.trim().eq_ignore_ascii_case(name.trim());
        let canonical = names::canonical(name);
        self.fields
            .iter()
            .find(written)
            .or_else(|| self.fields.iter().find(|field| names::canonical(&field.name) == canonical))
    }

    /// Bytes that the arrays take.
    pub fn bytes(&self) -> usize {
        self.positions.bytes() + self.fields.iter().map(|field| field.column.bytes()).sum::<usize>()
    }
}
