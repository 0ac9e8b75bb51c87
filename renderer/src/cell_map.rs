//! What became of each cell of a picture: the data of the overlay and of the inspection of a bundle.

use crate::camera::{BUNDLE_SIDE, CELL_SLICES};
use crate::picture::lane_of;
use crate::sampling::{Bound, BrickWidth};
use crate::stats::CellClasses;

/// Columns of 2 × 2 rays of a bundle.
pub const COLUMNS: usize = 16;
/// Bricks of a column in a cell, from front to back.
pub const COLUMN_BRICKS: usize = 4;

/// What became of a cell that holds particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CellClass {
    /// Sampled as a whole: wherever anything is seen.
    Full,
    /// Sampled in some bricks, and shown by one colour each in the others.
    Mixed,
    /// Sampled at a level of 1 to 4: once for 2, 4, 8, 16 slices.
    ZAdaptive(u8),
    /// Shown without a sample.
    SuperPixel,
    /// With nothing to be seen in it.
    Transparent,
    /// Behind what lets no light through that the tolerance would notice.
    Occluded,
}

impl CellClass {
    pub const ALL: [CellClass; 9] = [
        CellClass::Full,
        CellClass::Mixed,
        CellClass::ZAdaptive(1),
        CellClass::ZAdaptive(2),
        CellClass::ZAdaptive(3),
        CellClass::ZAdaptive(4),
        CellClass::SuperPixel,
        CellClass::Transparent,
        CellClass::Occluded,
    ];

    /// Place in [`CellClass::ALL`].
    pub fn index(self) -> usize {
        match self {
            CellClass::Full => 0,
            CellClass::Mixed => 1,
            CellClass::ZAdaptive(level) => 1 + usize::from(level.clamp(1, 4)),
            CellClass::SuperPixel => 6,
            CellClass::Transparent => 7,
            CellClass::Occluded => 8,
        }
    }

    /// The class that is counted at `place` (`bundle.wgsl`).
    pub(crate) fn of_counter(place: u32) -> CellClass {
        match place {
            8 => CellClass::Full,
            9 => CellClass::Mixed,
            10 => CellClass::SuperPixel,
            12..=15 => CellClass::ZAdaptive((place - 11) as u8),
            _ => CellClass::Transparent,
        }
    }
}

/// Bricks of a cell, 4 in each of 16 columns of 2 × 2 rays, as bits; one of 4 × 4 rays is in four columns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BrickMask {
    /// Brick b of column c is bit 16·(b mod 2) + c of word b/2, as on the device.
    pub(crate) words: [u32; 2],
}

impl BrickMask {
    pub const ALL: BrickMask = BrickMask { words: [!0; 2] };

    /// From a mask over wider columns: each stands for those in it.
    pub(crate) fn from_device(words: [u32; 2], width: BrickWidth) -> BrickMask {
        let parts = COLUMNS / width.columns();
        let bit = |word: u32, place: usize| (word >> (16 * (place / 16) + place % 16 / parts) & 1) << place;
        BrickMask { words: words.map(|word| (0..32).map(|place| bit(word, place)).sum()) }
    }

    /// Whether brick `brick` from the front of column `column` is among them.
    pub fn contains(self, column: usize, brick: usize) -> bool {
        self.words[brick / 2] >> (16 * (brick % 2) + column) & 1 == 1
    }

    /// Number of bricks, 0 to 64.
    pub fn count(self) -> u32 {
        self.words.iter().map(|word| word.count_ones()).sum()
    }
}

/// A cell that holds particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapCell {
    /// Number along the ray, 16 slices each.
    pub layer: u32,
    pub particles: u32,
    pub class: CellClass,
    /// Bricks sampled at every slice, and those that are once for four slices or follow their slope.
    pub sampled: BrickMask,
    pub coarse: BrickMask,
}

/// The cells along the rays of 8 × 8 pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BundleCells {
    /// The layer after the last one that may be seen.
    pub end_layer: u32,
    /// What is charged to the rays of each column: none of their pixels is farther from full sampling,
    /// but for rounding. See [`column_of`].
    pub charged: [f32; COLUMNS],
    /// From front to back.
    pub cells: Vec<MapCell>,
}

/// The cells of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct CellMap {
    /// Pixels.
    pub size: [u32; 2],
    /// Bundles in x and y.
    pub count: [u32; 2],
    /// Layers of cells along each ray.
    pub layers: u32,
    /// Row after row.
    pub bundles: Vec<BundleCells>,
}

impl CellMap {
    pub(crate) fn new(size: [u32; 2], layers: u32) -> CellMap {
        let count = size.map(|side| side.div_ceil(BUNDLE_SIDE));
        let bundles = vec![BundleCells::default(); count[0] as usize * count[1] as usize];
        CellMap { size, count, layers, bundles }
    }

    /// The bundle of that column and row.
    pub fn bundle(&self, [x, y]: [u32; 2]) -> &BundleCells {
        &self.bundles[(y * self.count[0] + x) as usize]
    }

    pub(crate) fn bundle_mut(&mut self, [x, y]: [u32; 2]) -> &mut BundleCells {
        &mut self.bundles[(y * self.count[0] + x) as usize]
    }

    /// What is charged to the ray of a pixel: its error is not larger, but for rounding.
    pub fn charged(&self, pixel: [u32; 2]) -> f32 {
        self.bundle(bundle_of(pixel)).charged[column_of(pixel)]
    }

    /// All filled cells by class.
    pub fn classes(&self) -> CellClasses {
        let mut classes = CellClasses::default();
        self.bundles.iter().flat_map(|bundle| &bundle.cells).for_each(|cell| classes.add(cell.class));
        classes
    }
}

/// Column and row of the bundle that a pixel belongs to.
pub fn bundle_of(pixel: [u32; 2]) -> [u32; 2] {
    pixel.map(|place| place / BUNDLE_SIDE)
}

/// The column of its bundle that a pixel belongs to: a Morton curve over 4 × 4 columns.
pub fn column_of([x, y]: [u32; 2]) -> usize {
    let inside = |place: u32| (place % BUNDLE_SIDE) as usize;
    lane_of(inside(x), inside(y)) / 4
}

/// What is known of u, a field in its range, at the samples of a cell or brick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KnownValues {
    /// It was not looked at.
    Unknown,
    /// No sample meets a particle.
    Empty,
    /// Every sample that meets a particle has a value between these; every one does where `covered`.
    Between { low: f32, high: f32, covered: bool },
}

/// 2 × 2 or 4 × 4 rays × 4 slices of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brick {
    /// The field that decides the opacity.
    pub opacity: FieldInBrick,
    /// The one that decides the colour, where that is another one.
    pub colour: Option<FieldInBrick>,
    /// What it would add to the error of its rays without a sample; `None` where they have ended.
    pub charge: Option<f32>,
    /// What it would add at level 2 or by its slope, where that is considered.
    pub coarse_charge: Option<f32>,
}

/// What is known of a field in a brick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldInBrick {
    pub values: KnownValues,
    /// Where every sample meets a particle.
    pub slope: Option<Slope>,
}

/// How u runs through a brick, as far as it is linear. A brick of 4 × 4 rays is in four columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// u in the middle of the brick, as far as a plane fits its samples.
    pub middle: f32,
    /// By how much it is more at the right, upper and far ends of the brick than there.
    pub rise: [f32; 3],
    /// How far u at any sample may be from that.
    pub off: f32,
    /// Of the brick.
    pub width: BrickWidth,
}

/// Bricks of a cell, by column, from front to back.
pub type CellBricks = [[Brick; COLUMN_BRICKS]; COLUMNS];

/// A cell of an inspected bundle.
#[derive(Clone, Debug, PartialEq)]
pub struct CellDetail {
    pub cell: MapCell,
    /// View depths where it begins and ends, in the unit of the run.
    pub depths: [f64; 2],
    /// Of the particles of the cell: bounds of all its samples, of the field that decides the opacity.
    pub values: KnownValues,
    /// Where they are known: by our bound.
    pub bricks: Option<Box<CellBricks>>,
    /// By the paper's bound.
    pub slabs: Option<Box<[KnownValues; CELL_SLICES as usize]>>,
    /// With the bricks: colour and opacity that stand for each column where none of it is sampled.
    pub shown: Option<Box<[[f32; 4]; COLUMNS]>>,
}

impl CellDetail {
    /// What the cell adds to the error of the rays of `column`.
    pub fn charged(&self, column: usize) -> f32 {
        let Some(bricks) = &self.bricks else { return 0.0 };
        if self.cell.class == CellClass::Occluded {
            return 0.0;
        }
        let open = |brick: &usize| !self.cell.sampled.contains(column, *brick);
        let charge = |brick: usize| {
            let Brick { charge, coarse_charge, .. } = bricks[column][brick];
            let coarse = self.cell.coarse.contains(column, brick);
            (if coarse { coarse_charge } else { charge }).unwrap_or(0.0)
        };
        (0..COLUMN_BRICKS).filter(open).map(charge).sum()
    }
}

/// A bundle with all that is known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct BundleDetail {
    /// Column and row.
    pub bundle: [u32; 2],
    /// Layers of cells along each ray.
    pub layers: u32,
    pub end_layer: u32,
    /// Whose bound it is. By the paper's, a ray is charged as a whole, and not cell by cell.
    pub bound: Bound,
    /// What may be charged to a ray; `None` where it is sampled in full.
    pub budget: Option<f32>,
    /// What is charged to the rays of each column: that of its cells, and of what is left out behind.
    pub charged: [f32; COLUMNS],
    /// From front to back.
    pub cells: Vec<CellDetail>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_know_their_place() {
        for (place, class) in CellClass::ALL.into_iter().enumerate() {
            assert_eq!(class.index(), place);
        }
        let counted: Vec<usize> = (8..16).map(|place| CellClass::of_counter(place).index()).collect();
        assert_eq!(counted, [0, 1, 6, 7, 2, 3, 4, 5]);
    }

    #[test]
    fn columns_are_blocks_of_four_pixels_on_a_morton_curve() {
        let columns: Vec<usize> = [[0, 0], [1, 1], [2, 0], [0, 2], [2, 3], [4, 0], [9, 8], [15, 15]]
            .into_iter()
            .map(column_of)
            .collect();
        assert_eq!(columns, [0, 0, 1, 2, 3, 4, 0, 15]);
    }

    #[test]
    fn a_mask_has_the_bits_of_the_device() {
        // Brick 3 of column 5, and brick 0 of column 2.
        let mask = BrickMask { words: [1 << 2, 1 << (16 + 5)] };
        let chosen = |column, brick| mask.contains(column, brick);
        assert!(chosen(5, 3) && chosen(2, 0) && !chosen(5, 2) && !chosen(2, 1));
        assert_eq!((mask.count(), BrickMask::ALL.count()), (2, 64));
        assert_eq!(BrickMask::from_device(mask.words, BrickWidth::Two), mask);
    }

    #[test]
    fn a_mask_of_wide_columns_is_one_of_those_in_them() {
        // Brick 3 of wide column 1, and brick 0 of wide column 2.
        let mask = BrickMask::from_device([1 << 2, 1 << (16 + 1)], BrickWidth::Four);
        let bricks: Vec<(usize, usize)> = (0..COLUMNS)
            .flat_map(|column| (0..COLUMN_BRICKS).map(move |brick| (column, brick)))
            .filter(|(column, brick)| mask.contains(*column, *brick))
            .collect();
        assert_eq!(bricks, [(4, 3), (5, 3), (6, 3), (7, 3), (8, 0), (9, 0), (10, 0), (11, 0)]);
    }
}
