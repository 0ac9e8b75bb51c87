//! Crowded cells: cells with so many references that one workgroup would walk over them for too long.
//!
//! Their sums are made ahead of the casting, a portion of the references at a time; casting adds up the
//! portions of a cell in place of walking over its particles.

use crate::error::RenderError;
use crate::gpu::{Buffer, Gpu, Room};
use crate::plan::TileLimits;
use crate::stages::shared::Fields;

/// References of a portion; a cell with more is crowded (`CROWD` of `frame.wgsl`).
pub(crate) const CROWD: u32 = 2048;

/// Bytes of one sum for each sample of a cell.
const SUMS_BYTES: u64 = 64 * 16 * 4;

/// Buffers as `portions.wgsl` describes them.
pub(crate) struct Crowds {
    portions: Buffer,
    sums: Buffer,
    count: u64,
}

impl Crowds {
    pub(super) fn new(gpu: &Gpu) -> Crowds {
        Crowds {
            portions: Buffer::storage(gpu, "portions of crowded cells", 8),
            sums: Buffer::storage(gpu, "sums over portions", SUMS_BYTES),
            count: 0,
        }
    }

    /// Takes `portions`, the cell and the first reference of each, in ascending order.
    pub(crate) fn write(
        &mut self,
        gpu: &Gpu,
        portions: &[[u32; 2]],
        fields: Fields,
    ) -> Result<(), RenderError> {
        self.count = portions.len() as u64;
        self.portions.write(gpu, portions)?;
        self.sums.reserve(gpu, self.count * (1 + fields.count()))
    }

    /// Number of portions.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    pub(super) fn buffers(&self) -> [&Buffer; 2] {
        [&self.portions, &self.sums]
    }

    /// The buffers, and the most elements of each under `limits`.
    pub(super) fn rooms(&mut self, limits: &TileLimits, fields: Fields) -> [Room<'_>; 2] {
        let portions = limits.portions;
        [(&mut self.portions, portions), (&mut self.sums, portions * (1 + fields.count()))]
    }
}

/// Portions of the crowded ones among cells whose references end at `ends`: cell and first reference.
pub(crate) fn portions(ends: &[u32]) -> Vec<[u32; 2]> {
    let begins = std::iter::once(0).chain(ends.iter().copied());
    let crowded = (0..).zip(begins.zip(ends)).filter(|(_, (begin, end))| *end - begin > CROWD);
    crowded
        .flat_map(|(cell, (begin, &end))| {
            (begin..end).step_by(CROWD as usize).map(move |first| [cell, first])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn portions_cover_crowded_cells_and_no_others() {
        let ends = [0, 2048, 2048, 4097, 4100, 10_000];
        let expected = [[3, 2048], [3, 4096], [5, 4100], [5, 6148], [5, 8196]];
        assert_eq!(portions(&ends), expected);
        assert!(portions(&[]).is_empty());
    }

    #[test]
    fn shaders_call_the_same_cells_crowded() {
        let line = format!("const CROWD: u32 = {CROWD}u;");
        assert!(crate::stages::shared::FRAME_WGSL.contains(&line));
    }
}
