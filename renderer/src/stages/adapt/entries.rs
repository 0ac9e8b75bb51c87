//! What the analysis leaves on the device, as the host reads it (`hull.wgsl`).

use bytemuck::{Pod, Zeroable};
use half::f16;

use crate::cell_map::Slope;
use crate::sampling::BrickWidth;

/// `CellEntry`: what is known of a cell, and what became of it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct CellEntry {
    pub values: [f32; 2],
    /// Place of its bricks + [`FIRST_SLOT`]; less where they are not known.
    pub slot: u32,
    pub class_index: u32,
    pub sampled: [u32; 2],
    pub coarse: [u32; 2],
}

/// The least slot that has bricks, and the one of a cell of which only the whole is known.
pub(crate) const FIRST_SLOT: u32 = 4;
pub(crate) const WHOLE_KNOWN: u32 = 1;

/// `BundleEntry`: where a bundle ends, and what is charged to its columns.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct BundleEntry {
    pub end_layer: u32,
    pub charged: [f32; 16],
}

/// `ColumnValues`: bounds of the quantity in the four bricks of a column.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct ColumnValues {
    pub low: [f32; 4],
    pub high: [f32; 4],
    /// How the quantity runs through them: [`ColumnValues`] of the shader says how.
    pub middle: [f32; 4],
    pub across: [u32; 4],
    pub along: [u32; 4],
}

impl ColumnValues {
    /// How u runs through a brick in which every sample meets a particle.
    pub(crate) fn slope(&self, brick: usize, width: BrickWidth) -> Option<Slope> {
        let half = |bits: u32| f16::from_bits(bits as u16).to_f32() / SLOPE_UNIT;
        let pair = |bits: u32| [half(bits), half(bits >> 16)];
        let [[right, up], [back, off]] = [self.across[brick], self.along[brick]].map(pair);
        let slope = Slope { middle: self.middle[brick], rise: [right, up, back], off, width };
        (self.high[brick] >= COVERED).then_some(slope)
    }
}

/// `Offers` of `offers.wgsl`: costs of the steps by which the bricks of a column are sampled less.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct Offers {
    pub first: [f32; 4],
    pub second: [f32; 4],
}

impl Offers {
    /// What it costs in all to show a brick unsampled; `None` where no light comes from it.
    pub(crate) fn to_show(self, brick: usize) -> Option<f32> {
        let cost = self.first[brick] + self.second[brick].max(0.0);
        (self.first[brick] >= 0.0).then_some(cost)
    }

    /// What it costs to sample a brick at level 2 or to let it follow its slope, where that is a step of its own.
    pub(crate) fn to_coarsen(self, brick: usize) -> Option<f32> {
        (self.first[brick] >= 0.0 && self.second[brick] >= 0.0).then_some(self.first[brick])
    }
}

/// What is added to the upper bound of a brick in which every sample meets a particle.
pub(crate) const COVERED: f32 = 2.0;
/// How many times as large slopes are kept: so no half float is less than 2⁻¹⁴ that matters.
const SLOPE_UNIT: f32 = 4096.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::layout::check_layout;
    use crate::stages::shared::{BUNDLE_WGSL, FRAME_WGSL, Fields, HULL_WGSL, KERNEL_WGSL, TRANSFER_WGSL};

    const OFFERS_WGSL: &str = include_str!("offers.wgsl");

    #[test]
    fn slopes_are_kept_in_the_unit_of_the_shaders() {
        assert!(HULL_WGSL.contains(&format!("const SLOPE_UNIT: f32 = {SLOPE_UNIT:?};")));
        let halves = |low: f32, high: f32| {
            [low, high].map(|value| f16::from_f32(SLOPE_UNIT * value).to_bits()).map(u32::from)
        };
        let packed = |low, high| halves(low, high)[0] | halves(low, high)[1] << 16;
        let values = ColumnValues {
            low: [0.0; 4],
            high: [COVERED; 4],
            middle: [0.5; 4],
            across: [packed(0.25, -0.5); 4],
            along: [packed(15.0, 2.0); 4],
        };
        let slope = values.slope(2, BrickWidth::Two).expect("the brick is covered");
        assert_eq!((slope.middle, slope.rise, slope.off), (0.5, [0.25, -0.5, 15.0], 2.0));
        // What a device may take for 0 is far below what rounding adds.
        assert!(f32::from(f16::MIN_POSITIVE) / SLOPE_UNIT < 4e-6 / 100.0);
    }

    #[test]
    fn entries_lie_as_the_shader_expects() {
        let (samples, bricks) = (Fields::One.wgsl(), Fields::One.bounds_wgsl());
        let source =
            [FRAME_WGSL, KERNEL_WGSL, samples, BUNDLE_WGSL, TRANSFER_WGSL, HULL_WGSL, bricks, OFFERS_WGSL]
                .concat();
        check_layout!(&source, "CellEntry", CellEntry, values, slot, class_index, sampled, coarse);
        check_layout!(&source, "BundleEntry", BundleEntry, end_layer, charged);
        check_layout!(&source, "ColumnValues", ColumnValues, low, high, middle, across, along);
        check_layout!(&source, "Offers", Offers, first, second);
    }
}
