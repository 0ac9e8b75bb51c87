//! Exclusive prefix sum over the cells' counts, in place (`scan.wgsl`).

use bytemuck::{Pod, Zeroable};

use crate::error::RenderError;
use crate::gpu::{Access, Buffer, Gpu, Pipeline, PipelineDescription};

/// Numbers that one workgroup sums (`BLOCK` of the shader).
const BLOCK: u64 = 2048;
/// Enough for 2048⁴ numbers.
const MAX_LEVELS: usize = 4;

/// `Level` of `scan.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Level {
    begin: u32,
    next: u32,
    length: u32,
    count_cells: u32,
}

pub struct Scan {
    scan: Pipeline,
    add: Pipeline,
    levels: [Buffer; MAX_LEVELS],
}

impl Scan {
    pub fn new(gpu: &Gpu) -> Scan {
        use Access::{Uniform, Write};
        let pipeline = |entry_point| {
            Pipeline::new(
                gpu,
                &PipelineDescription {
                    label: entry_point,
                    sources: &[super::shared::FRAME_WGSL, include_str!("scan.wgsl")],
                    entry_point,
                    constants: &[],
                    bindings: &[Uniform, Write, Write],
                },
            )
        };
        let levels = std::array::from_fn(|_| Buffer::uniform::<Level>(gpu, "scan level"));
        Scan { scan: pipeline("scan"), add: pipeline("add"), levels }
    }

    /// Numbers that the buffer of `length` counts must hold, upper levels included.
    pub fn buffer_length(length: u64) -> u64 {
        levels(length).last().map_or(1, |level| u64::from(level.next) + 1)
    }

    /// Replaces the first `length` numbers of `sums` by the sums of those before them; writes the
    /// sum of all to `totals[0]`, and how many were above zero to `totals[1]`, which must be 0 before.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        sums: &Buffer,
        totals: &Buffer,
        length: u64,
    ) -> Result<(), RenderError> {
        let levels = levels(length);
        for (level, uniform) in levels.iter().zip(&mut self.levels) {
            uniform.write(gpu, std::slice::from_ref(level))?;
            let blocks = u64::from(level.length).div_ceil(BLOCK);
            self.scan.dispatch(gpu, pass, &[uniform.binding(), sums.binding(), totals.binding()], blocks);
        }
        // The topmost level is a single block, complete in itself.
        for (level, uniform) in levels.iter().zip(&self.levels).rev().skip(1) {
            let blocks = u64::from(level.length).div_ceil(BLOCK);
            self.add.dispatch(gpu, pass, &[uniform.binding(), sums.binding(), totals.binding()], blocks);
        }
        Ok(())
    }
}

/// Levels of a sum over `length` numbers; the last one is a single block.
fn levels(length: u64) -> Vec<Level> {
    let mut levels = Vec::new();
    let (mut begin, mut length) = (0, length.max(1));
    loop {
        let next = begin + length;
        let count_cells = u32::from(levels.is_empty());
        levels.push(Level { begin: begin as u32, next: next as u32, length: length as u32, count_cells });
        if length <= BLOCK {
            return levels;
        }
        (begin, length) = (next, length.div_ceil(BLOCK));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_lie_as_the_shader_expects() {
        let source = [crate::stages::shared::FRAME_WGSL, include_str!("scan.wgsl")].concat();
        crate::stages::layout::check_layout!(&source, "Level", Level, begin, next, length, count_cells);
    }

    #[test]
    fn levels_shrink_to_one_block() {
        assert_eq!(levels(1).len(), 1);
        assert_eq!(levels(2048).len(), 1);
        assert_eq!(levels(2049).len(), 2);
        let large = levels(2048 * 2048 + 1);
        assert_eq!(large.len(), 3);
        assert_eq!(large[1].begin, large[0].next);
        assert_eq!(large[2].length, 2);
        assert_eq!(Scan::buffer_length(2049), 2049 + 2 + 1);
    }
}
