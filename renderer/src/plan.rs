//! How a picture is cut into tiles that fit the device. Pure: no device is touched here.

use crate::camera::CELL_SLICES;
use crate::sampling::{Bound, BrickWidth};
use crate::scene::Scene;
use crate::stages::adapt::{COLUMN_STRIDE, CellBounds, LISTS};
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

/// What decides how much memory a tile takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Contents {
    pub particles: u64,
    pub fields: Fields,
    pub bound: Bound,
    pub column_width: BrickWidth,
}

/// The memory is shared out in these many parts, and what the particles leave of it again.
const SHARES: u64 = 16;
/// The most shares that particles have.
const PARTICLE_SHARES: u64 = 8;

/// Bytes of the pixels of a bundle.
const BUNDLE_PIXELS: u64 = 64 * 16;

/// Bytes of one element in the widest of the arrays that hold any, and in all of them together.
struct Bytes {
    widest: u64,
    all: u64,
}

impl Bytes {
    /// Elements for which `memory` suffices, when none of the arrays may be larger than `binding`.
    fn fit(&self, binding: u64, memory: u64) -> u64 {
        (binding / self.widest).min(memory / self.all).max(1)
    }
}

impl Contents {
    pub(crate) fn of(scene: &Scene) -> Contents {
        Contents {
            particles: scene.particles.len() as u64,
            fields: scene.quantity.fields(),
            bound: scene.sampling.bound,
            column_width: scene.sampling.column_width(),
        }
    }

    /// Positions in two parts, in view space, and weights; the quantities.
    fn of_particle(self) -> Bytes {
        Bytes { widest: 16, all: 52 + 4 * self.fields.count() }
    }

    /// The reference itself; one in twelve, for a cell that is left to be ordered.
    fn of_pair(self) -> Bytes {
        Bytes { widest: 4, all: 5 }
    }

    /// Its counter, with the sums over counters and a copy for the host; what is known of its values; and
    /// whether it is sampled.
    fn of_cell(self) -> Bytes {
        Bytes { widest: 32, all: 32 + 3 * 4 + 1 }
    }

    /// Bounds of its bricks and what stands for its columns; an entry in each list of work; 64 samples.
    fn of_filled_cell(self) -> Bytes {
        const SAMPLES: u64 = 64 * 16;
        let count = self.column_width.columns() as u64;
        let columns = count * COLUMN_STRIDE * self.fields.count();
        let bounds = match self.bound {
            Bound::Difference => columns + count * 32,
            Bound::Paper => size_of::<CellBounds>() as u64,
        };
        Bytes { widest: columns.max(SAMPLES), all: bounds + count * 16 + LISTS * 8 + SAMPLES }
    }

    /// Its place, and sums for the samples of a cell.
    fn of_portion(self) -> Bytes {
        let sums = 64 * 16 * 4 * (1 + self.fields.count());
        Bytes { widest: sums, all: sums + 8 }
    }

    /// 64 pixels, a copy of them for the host, half as much for depths; and what an analysis leaves.
    fn of_bundle(self) -> Bytes {
        Bytes { widest: BUNDLE_PIXELS, all: BUNDLE_PIXELS * 5 / 2 + 4 * 17 }
    }
}

impl TileLimits {
    /// Limits of a device whose bindings hold `binding` bytes, when all arrays together may take `memory`
    /// bytes. Particles have as many shares as they need; what is left is for the others, and one part in
    /// sixteen of it for what all tiles have in common.
    pub(crate) fn new(binding: u64, memory: u64, contents: Contents) -> TileLimits {
        let share = memory / SHARES;
        let needed = (contents.particles * contents.of_particle().all).div_ceil(share.max(1));
        let of_particles = share * needed.clamp(1, PARTICLE_SHARES);
        let of_rest = |parts: u64| (memory - of_particles) / SHARES * parts;
        // Rounded down as buffers are rounded up; and places in the shaders are 32 bits wide.
        let binding = binding / 16 * 16;
        let words = binding.min(u64::from(u32::MAX) / 2 * 4);
        TileLimits {
            particles: contents.of_particle().fit(binding, of_particles),
            filled_cells: contents.of_filled_cell().fit(binding, of_rest(6)),
            pairs: contents.of_pair().fit(words, of_rest(3)),
            cells: contents.of_cell().fit(words, of_rest(3)),
            bundles: contents.of_bundle().fit(binding, of_rest(2)),
            portions: contents.of_portion().fit(binding, of_rest(1)),
        }
    }

    /// The same where pixels share their room with as much again for depths.
    pub(crate) fn with_depths(self) -> TileLimits {
        TileLimits { bundles: self.bundles_with_depths(), ..self }
    }

    /// Bytes of all pixels of a tile, with a copy for the host.
    pub(crate) fn pixel_bytes(&self) -> u64 {
        2 * BUNDLE_PIXELS * self.bundles
    }

    /// Bundles of a tile whose depths are asked for too.
    pub(crate) fn bundles_with_depths(&self) -> u64 {
        (self.bundles / 2).max(1)
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
