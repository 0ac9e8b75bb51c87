//! How a picture is cut into tiles that fit the device. Pure: no device is touched here.

use crate::camera::CELL_SLICES;
use crate::stages::adapt::COLUMN_STRIDE;
use crate::stages::shared::Fields;

/// A box of cells that is built and cast at once: bundles × layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    /// First bundle in x and y, and number of bundles.
    pub first: [u32; 2],
    pub count: [u32; 2],
    /// First layer of cells along the rays, and number of layers.
    pub first_layer: u32,
    pub layers: u32,
}

/// What one tile may need of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TileLimits {
    pub particles: u64,
    /// References of cells to particles.
    pub pairs: u64,
    pub cells: u64,
    /// Cells with particles in them, of a tile that is analysed.
    pub filled_cells: u64,
    /// Portions of crowded cells.
    pub portions: u64,
    pub bundles: u64,
}

/// Bytes of a bundle's 64 pixels.
const BUNDLE_BYTES: u64 = 64 * 16;
/// Bytes of a sum over a portion, for each sample of a cell.
const PORTION_BYTES: u64 = 64 * 16 * 4;
/// Bytes of a particle in the widest of its arrays, and in all of them but its quantities.
const PARTICLE_STRIDE: u64 = 16;
const PARTICLE_BYTES: u64 = 52;
/// Bytes of a reference, and of a cell's counter.
const WORD: u64 = 4;
/// Bytes of a cell in the widest of the arrays over all cells.
const CELL_STRIDE: u64 = 32;
/// Bytes of an analysed cell for each field, in the widest of its arrays, and in all others: those of both
/// bounds.
const FILLED_STRIDE: u64 = COLUMN_STRIDE * 16;
const FILLED_BYTES: u64 = 1120;

impl TileLimits {
    /// Limits of a device whose bindings hold `binding` bytes, when a tile may take `memory` bytes:
    /// a quarter each for particles, references, cells and pixels, and another one for an analysis.
    pub(crate) fn new(binding: u64, memory: u64, fields: Fields) -> TileLimits {
        let quarter = memory / 4;
        // Rounded down as buffers are rounded up.
        let share = binding.min(quarter) / 16 * 16;
        // Places in the shaders are 32 bits wide.
        let words = (share / WORD).clamp(1, u64::from(u32::MAX) / 2);
        let fields = fields.count();
        let (particle, filled) = (PARTICLE_BYTES + WORD * fields, FILLED_STRIDE * fields);
        TileLimits {
            particles: (binding / PARTICLE_STRIDE).min(quarter / particle).max(1),
            pairs: words,
            // The upper levels of the prefix sum need a little more than one in two thousand.
            cells: (words - words / 1024).min(share / CELL_STRIDE).max(1),
            filled_cells: (binding / filled).min(quarter / (filled + FILLED_BYTES)).max(1),
            portions: share / (PORTION_BYTES * (1 + fields)),
            bundles: (share / BUNDLE_BYTES).max(1),
        }
    }

    /// The same where pixels share their room with as much again for depths.
    pub(crate) fn with_depths(self) -> TileLimits {
        TileLimits { bundles: (self.bundles / 2).max(1), ..self }
    }
}

impl Tile {
    pub(crate) fn bundles(&self) -> u64 {
        u64::from(self.count[0]) * u64::from(self.count[1])
    }

    pub(crate) fn cells(&self) -> u64 {
        self.bundles() * u64::from(self.layers)
    }

    /// Column and row in the picture of one of its bundles.
    pub(crate) fn place_of(&self, bundle: u64) -> [u32; 2] {
        let across = u64::from(self.count[0]);
        [self.first[0] + (bundle % across) as u32, self.first[1] + (bundle / across) as u32]
    }

    /// The tile in a picture that begins `rows` rows of bundles farther down.
    pub(crate) fn higher(self, rows: u32) -> Tile {
        Tile { first: [self.first[0], self.first[1] - rows], ..self }
    }

    /// The tile in a picture that begins `rows` rows of bundles farther up.
    pub(crate) fn lower(self, rows: u32) -> Tile {
        Tile { first: [self.first[0], self.first[1] + rows], ..self }
    }

    fn fits(&self, limits: TileLimits) -> bool {
        self.cells() <= limits.cells && self.bundles() <= limits.bundles
    }

    /// Two halves, in the order in which they are to be cast: rows, then columns, then layers from
    /// front to back. `None` for a single cell.
    ///
    /// Layers are split for single bundles only. The halves of such a tile follow each other without
    /// another bundle between them, so that the pixels of the front half are still there for the back.
    pub(crate) fn split(self) -> Option<[Tile; 2]> {
        for axis in [1, 0] {
            if self.count[axis] > 1 {
                let (mut a, mut b) = (self, self);
                a.count[axis] /= 2;
                b.count[axis] -= a.count[axis];
                b.first[axis] += a.count[axis];
                return Some([a, b]);
            }
        }
        if self.layers < 2 {
            return None;
        }
        let (mut front, mut back) = (self, self);
        front.layers /= 2;
        back.layers -= front.layers;
        back.first_layer += front.layers;
        Some([front, back])
    }
}

/// The whole picture, cut until every tile is within `limits`; in the order of casting.
pub(crate) fn tiles(bundles: [u32; 2], slices: u64, limits: TileLimits) -> Vec<Tile> {
    let layers = u32::try_from(slices / u64::from(CELL_SLICES)).unwrap_or(u32::MAX);
    let mut tiles = Vec::new();
    let mut todo = vec![Tile { first: [0, 0], count: bundles, first_layer: 0, layers }];
    while let Some(tile) = todo.pop() {
        match tile.split() {
            Some([a, b]) if !tile.fits(limits) => todo.extend([b, a]),
            _ => tiles.push(tile),
        }
    }
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLENTY: TileLimits = TileLimits {
        particles: 1 << 40,
        pairs: 1 << 40,
        cells: 1 << 40,
        filled_cells: 1 << 40,
        portions: 1 << 40,
        bundles: 1 << 40,
    };

    #[test]
    fn a_picture_that_fits_is_one_tile() {
        let tiles = tiles([64, 64], 160, PLENTY);
        assert_eq!(tiles, [Tile { first: [0, 0], count: [64, 64], first_layer: 0, layers: 10 }]);
    }

    #[test]
    fn tiles_cover_every_cell_once_and_fit() {
        for limits in [
            TileLimits { cells: 100, ..PLENTY },
            TileLimits { cells: 7, ..PLENTY },
            TileLimits { bundles: 5, ..PLENTY },
        ] {
            let tiles = tiles([13, 7], 16 * 11, limits);
            assert!(tiles.iter().all(|tile| tile.fits(limits)));
            let mut seen = std::collections::BTreeSet::new();
            for tile in &tiles {
                for (y, x) in (0..tile.count[1]).flat_map(|y| (0..tile.count[0]).map(move |x| (y, x))) {
                    for layer in 0..tile.layers {
                        let cell = (tile.first[0] + x, tile.first[1] + y, tile.first_layer + layer);
                        assert!(seen.insert(cell), "{cell:?} twice");
                    }
                }
            }
            assert_eq!(seen.len(), 13 * 7 * 11);
        }
    }

    #[test]
    fn layers_of_a_bundle_come_front_to_back_without_a_break() {
        let tiles = tiles([2, 1], 16 * 9, TileLimits { cells: 2, ..PLENTY });
        for pair in tiles.windows(2) {
            let same_bundle = pair[0].first == pair[1].first;
            let expected = if same_bundle { pair[0].first_layer + pair[0].layers } else { 0 };
            assert_eq!(pair[1].first_layer, expected);
        }
    }

    #[test]
    fn a_single_cell_cannot_be_split() {
        assert_eq!(Tile { first: [3, 4], count: [1, 1], first_layer: 5, layers: 1 }.split(), None);
    }
}
