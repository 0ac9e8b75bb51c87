//! Which particles a tile may need: for sets that do not fit the device as a whole.

use rayon::prelude::*;

use crate::camera::{BUNDLE_SIDE, CELL_SLICES, Slices};
use crate::plan::Tile;
use crate::scene::Scene;
use crate::stages::shared::{pitch, radius_floor};

/// Indices of all particles whose support may meet a ray of `tile` between its first and last slice.
pub(crate) fn touching(scene: &Scene, slices: &Slices, tile: &Tile) -> Vec<u32> {
    let camera = &scene.camera;
    let unit = scene.particles.unit();
    let eye = scene.particles.to_device(camera.eye);
    let near = camera.near / unit;
    let first_slice = f64::from(tile.first_layer * CELL_SLICES);
    let last_slice = f64::from((tile.first_layer + tile.layers) * CELL_SLICES);
    let depths = [slices.depth(first_slice) / unit, slices.depth(last_slice) / unit];
    let far = camera.far / unit;
    let floor = radius_floor(scene, slices);
    let slopes = [0, 1].map(|axis| slope_range(scene, tile, axis));

    scene
        .particles
        .balls()
        .enumerate()
        .filter_map(|(index, (position, radius))| {
            let offset = position - eye;
            let z = offset.dot(camera.forward);
            // f32 may round a particle into the tile that stands just outside of it.
            let radius = 1.001 * radius.max(floor * z.clamp(near, far));
            let [front, back] = [(z - radius).max(depths[0]), (z + radius).min(depths[1])];
            let meets = |c: f64, [low, high]: [f64; 2]| {
                // Slope c/z of the ball's box, with the depth that widens it.
                let least = (c - radius) / if c > radius { back } else { front };
                let most = (c + radius) / if c > -radius { front } else { back };
                least <= high && most >= low
            };
            let inside = front <= back
                && meets(offset.dot(camera.right), slopes[0])
                && meets(-offset.dot(camera.up), slopes[1]);
            inside.then_some(index as u32)
        })
        .collect()
}

/// Slopes of the tile's first and last rays, a pixel of slack added, to the right or downwards.
fn slope_range(scene: &Scene, tile: &Tile, axis: usize) -> [f64; 2] {
    let size = [scene.width, scene.height][axis];
    let middle = f64::from(size) / 2.0;
    let first = f64::from(tile.first[axis] * BUNDLE_SIDE) - 1.0;
    let last = f64::from((tile.first[axis] + tile.count[axis]) * BUNDLE_SIDE) + 1.0;
    [(first - middle) * pitch(scene), (last - middle) * pitch(scene)]
}
