//! The picture that a rendering leaves.

use rayon::prelude::*;

use crate::camera::BUNDLE_SIDE;
use crate::plan::Tile;
use crate::stats::Stats;

/// Premultiplied linear RGBA, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// width·height pixels, row after row.
    pub pixels: Vec<[f32; 4]>,
    /// What the picture cost.
    pub stats: Stats,
}

impl Picture {
    /// Puts the pixels of a tile, 64 a bundle as the device has them, into their places.
    pub(crate) fn place(&mut self, tile: &Tile, pixels: &[[f32; 4]]) {
        place(tile, self.width, &mut self.pixels, pixels, |[r, g, b, transparency]| {
            [r, g, b, 1.0 - transparency]
        });
    }
}

/// Makes of the `pixels` of a tile, 64 a bundle as the device has them, what `value_of` says, in their places
/// among `values` of rows of `width` pixels.
pub(crate) fn place<T: Send>(
    tile: &Tile,
    width: u32,
    values: &mut [T],
    pixels: &[[f32; 4]],
    value_of: impl Fn([f32; 4]) -> T + Sync,
) {
    let [first_x, first_y] = tile.first.map(|bundle| (bundle * BUNDLE_SIDE) as usize);
    let columns = (tile.count[0] * BUNDLE_SIDE) as usize;
    let rows = (tile.count[1] * BUNDLE_SIDE) as usize;
    let side = BUNDLE_SIDE as usize;
    values.par_chunks_mut(width as usize).skip(first_y).take(rows).enumerate().for_each(|(y, row)| {
        for (x, value) in row.iter_mut().skip(first_x).take(columns).enumerate() {
            let bundle = (y / side) * tile.count[0] as usize + x / side;
            *value = value_of(pixels[bundle * 64 + lane_of(x % side, y % side)]);
        }
    });
}

/// Lane of a pixel inside its bundle: a Morton curve, as `place_in_bundle` of `bundle.wgsl`.
pub(crate) fn lane_of(x: usize, y: usize) -> usize {
    let spread = |i: usize| (i & 1) | (i & 2) << 1 | (i & 4) << 2;
    spread(x) | spread(y) << 1
}
