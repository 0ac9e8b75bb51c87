//! A look into the grid: which particles each cell holds.

use crate::error::RenderError;
use crate::plan::{self, Tile};
use crate::renderer::Renderer;
use crate::scene::Scene;
use crate::stats::Milliseconds;

/// A cell that holds particles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GridCell {
    /// Column and row of its bundle of 8 × 8 pixels.
    pub bundle: [u32; 2],
    /// Number of the cell along the ray, 16 slices each.
    pub layer: u32,
    /// Indices of its particles in the set, in an order that their places decide.
    pub particles: Vec<u32>,
}

impl Renderer {
    /// All cells of the grid of `scene` that hold particles, as they are on the device. For scenes
    /// whose particles fit the device as a whole; the picture's size is not limited.
    pub fn inspect_grid(&mut self, scene: &Scene) -> Result<Vec<GridCell>, RenderError> {
        let job = self.begin(scene)?;
        let mut cells = Vec::new();
        let mut todo = plan::tiles(Renderer::bundles(scene), job.slices.count, job.limits);
        while let Some(tile) = todo.pop() {
            match self.prepare_tile(&job, &tile, &mut Milliseconds::default())? {
                Ok(size) => cells.extend(self.read_cells(&tile, size.pairs)?),
                Err(too_large) => todo.extend(self.halves(&tile, too_large)?),
            }
        }
        Ok(cells)
    }

    fn read_cells(&self, tile: &Tile, pairs: u64) -> Result<Vec<GridCell>, RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let ends = self.grid.cells.read_back(&self.gpu, &mut encoder, tile.cells());
        let pairs = self.grid.pairs.read_back(&self.gpu, &mut encoder, pairs.max(1));
        self.gpu.queue.submit([encoder.finish()]);
        let ends: Vec<u32> = ends.take(&self.gpu)?;
        let pairs: Vec<u32> = pairs.take(&self.gpu)?;
        let begins = std::iter::once(0).chain(ends.iter().copied());
        let filled = begins.zip(&ends).enumerate().filter(|(_, (begin, end))| begin < end);
        Ok(filled
            .map(|(cell, (begin, &end))| {
                let (bundle, layer) = (cell as u32 / tile.layers, cell as u32 % tile.layers);
                GridCell {
                    bundle: tile.place_of(bundle.into()),
                    layer: tile.first_layer + layer,
                    particles: pairs[begin as usize..end as usize].to_vec(),
                }
            })
            .collect())
    }
}
