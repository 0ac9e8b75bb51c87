//! A tile whose particles crowd: cells that are summed ahead, and bundles that are too much for an
//! adapter.

use std::time::Instant;

use crate::error::{RenderError, TooLarge};
use crate::plan::Tile;
use crate::renderer::{Progress, Renderer};
use crate::stages::cast::{CROWD, portions};
use crate::stages::grid::Totals;
use crate::stages::shared::TileUniform;
use crate::stats::Milliseconds;
use crate::tiles::Job;

/// References that a bundle may have on a software adapter. llvmpipe ends the loops of an invocation,
/// without a word, after 65,535 rounds in all; a stage takes up to two rounds a reference, and a few more.
const SOFTWARE_ROUNDS: u64 = 30_000;

impl Renderer {
    /// Finds the crowded cells of `tile`, whose grid is on the device, and makes room for their sums.
    pub(crate) fn find_crowds(
        &mut self,
        job: &Job,
        tile: &Tile,
        totals: Totals,
    ) -> Result<Option<TooLarge>, RenderError> {
        let fields = job.scene.quantity.fields();
        let busiest = u64::from(totals.busiest_bundle);
        if self.gpu.is_software() && busiest > SOFTWARE_ROUNDS {
            let what = "references along a bundle, on a software adapter";
            return Ok(Some(TooLarge { what, needed: busiest, limit: SOFTWARE_ROUNDS }));
        }
        if totals.largest_cell <= CROWD {
            self.cast.crowds.write(&self.gpu, &[], fields)?;
            return Ok(None);
        }
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let ends = self.grid.cells.read_back(&self.gpu, &mut encoder, tile.cells());
        self.gpu.queue.submit([encoder.finish()]);
        let portions = portions(&ends.take::<u32>(&self.gpu)?[..tile.cells() as usize]);
        let (needed, limit) = (portions.len() as u64, job.limits.portions);
        if needed > limit {
            return Ok(Some(TooLarge { what: "portions of crowded cells", needed, limit }));
        }
        let capacity = self.grid.pairs.capacity().min(job.limits.pairs);
        let uniform = TileUniform { portions: needed as u32, ..TileUniform::new(tile, capacity) };
        self.tile.write(&self.gpu, &[uniform])?;
        self.cast.crowds.write(&self.gpu, &portions, fields)?;
        Ok(None)
    }

    /// Sums over the crowded cells of a tile.
    pub(crate) fn sum_crowds(
        &mut self,
        job: &Job,
        progress: &mut Progress,
        times: &mut Milliseconds,
    ) -> Result<(), RenderError> {
        let portions = self.cast.crowds.count();
        let mut first = 0;
        while first < portions {
            if progress(0.0).is_break() {
                return Err(RenderError::Cancelled);
            }
            let begin = Instant::now();
            let end = portions.min(first + self.crowd_pace.bundles());
            self.bundles.write_chunk(&self.gpu, first..end, 1, &job.scene.sampling)?;
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            let shared = self.shared_bindings();
            self.timing.pass(&mut encoder, "ray cast", |pass| {
                self.cast.record_portions(&self.gpu, pass, job.scene, &shared, end - first);
            });
            drop(shared);
            self.submit(encoder, times)?;
            self.crowd_pace.learn(end - first, begin.elapsed());
            first = end;
        }
        Ok(())
    }
}
