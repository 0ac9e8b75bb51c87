//! One tile of a picture: its particles, its grid, its rays, its pixels.

use std::time::Instant;

use crate::camera::Slices;
use crate::error::{RenderError, TooLarge};
use crate::picture::Picture;
use crate::plan::{Tile, TileLimits};
use crate::renderer::{Geometry, GridSize, Progress, Renderer};
use crate::scene::Scene;
use crate::selection;
use crate::stages::shared::{FrameUniform, TileUniform};
use crate::stats::Milliseconds;

/// What every tile of a picture shares.
pub(crate) struct Job<'a> {
    pub scene: &'a Scene,
    pub slices: Slices,
    pub geometry: Geometry,
    pub limits: TileLimits,
    /// The particles are on the device as a whole.
    pub resident: bool,
    /// The picture is a single tile, whose grid serves the next picture too.
    pub only_tile: bool,
}

/// A stage that takes a workgroup for each bundle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Analysis,
    Cast,
}

impl Stage {
    fn label(self) -> &'static str {
        match self {
            Stage::Analysis => "analysis",
            Stage::Cast => "ray cast",
        }
    }
}

/// How a stage is to go about a tile.
struct Uniforms {
    budget: f32,
    stage: Stage,
    adapted: bool,
}

/// First guess of the references that one particle needs; an overflow tells the true number.
const PAIRS_PER_PARTICLE: u64 = 8;

impl Renderer {
    /// Has the grid of `tile` on the device, built anew where it is not there yet.
    pub(crate) fn prepare_tile(
        &mut self,
        job: &Job,
        tile: &Tile,
        times: &mut Milliseconds,
    ) -> Result<Result<GridSize, TooLarge>, RenderError> {
        let fresh = self.sorted.take().filter(|(sorted, _)| job.only_tile && *sorted == job.geometry);
        let size = match fresh {
            Some((_, size)) => size,
            None => match self.build_grid(job, tile, times)? {
                Ok(size) => size,
                too_large => return Ok(too_large),
            },
        };
        self.sorted = job.only_tile.then(|| (job.geometry.clone(), size));
        Ok(Ok(size))
    }

    fn build_grid(
        &mut self,
        job: &Job,
        tile: &Tile,
        times: &mut Milliseconds,
    ) -> Result<Result<GridSize, TooLarge>, RenderError> {
        if !job.resident
            && let Some(too_large) = self.upload_tile(job, tile, times)?
        {
            return Ok(Err(too_large));
        }
        let frame = FrameUniform::new(job.scene, &job.slices, self.store.count());
        self.frame.write(&self.gpu, &[frame])?;
        self.grid.reserve(&self.gpu, tile)?;
        self.analysed = None;
        self.sort_pairs(job, tile, times)
    }

    /// Brings the particles of `tile` to the device.
    fn upload_tile(
        &mut self,
        job: &Job,
        tile: &Tile,
        times: &mut Milliseconds,
    ) -> Result<Option<TooLarge>, RenderError> {
        let begin = Instant::now();
        let chosen = selection::touching(job.scene, &job.slices, tile);
        let count = chosen.len() as u64;
        if count > job.limits.particles {
            let limit = job.limits.particles;
            return Ok(Some(TooLarge { what: "particles", needed: count, limit }));
        }
        let (particles, quantity) = (&job.scene.particles, &job.scene.quantity);
        self.store.upload_some(&self.gpu, particles, quantity, &chosen)?;
        self.projected = None;
        times.upload += begin.elapsed().as_secs_f64() * 1e3;
        Ok(None)
    }

    /// Projects where that is stale, and sorts the particles into the cells of `tile`; grows the pair
    /// buffer and sorts again where it was too small.
    fn sort_pairs(
        &mut self,
        job: &Job,
        tile: &Tile,
        times: &mut Milliseconds,
    ) -> Result<Result<GridSize, TooLarge>, RenderError> {
        let particles = self.store.count();
        let limit = job.limits.pairs;
        self.grid.pairs.reserve(&self.gpu, (particles * PAIRS_PER_PARTICLE).clamp(1, limit))?;
        loop {
            let capacity = self.grid.pairs.capacity().min(limit);
            self.tile.write(&self.gpu, &[TileUniform::new(tile, capacity)])?;
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            if self.projected.as_ref() != Some(&job.geometry) {
                self.timing.pass(&mut encoder, "grid", |pass| {
                    self.project.record(&self.gpu, pass, &self.frame, &self.store);
                });
            }
            let uniforms = [&self.frame, &self.tile];
            self.grid.record(&self.gpu, &mut encoder, &self.timing, uniforms, &self.store, tile)?;
            let totals = self.grid.totals.read_back(&self.gpu, &mut encoder, 1);
            self.submit(encoder, times)?;
            let totals: Vec<u32> = totals.take(&self.gpu)?;
            self.projected = Some(job.geometry.clone());

            let needed = u64::from(totals[0]);
            if needed <= capacity {
                return Ok(Ok(GridSize { pairs: needed, cells: u64::from(totals[1]) }));
            }
            if needed > limit {
                return Ok(Err(TooLarge { what: "references to particles", needed, limit }));
            }
            // Some room to spare: the next camera may need a little more.
            self.grid.pairs.reserve(&self.gpu, (needed + needed / 8).min(limit))?;
        }
    }

    /// Casts the rays of `tile`, sampled as its budget allows, and puts its pixels into the picture.
    pub(crate) fn cast_tile(
        &mut self,
        job: &Job,
        tile: &Tile,
        size: GridSize,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        self.cast.reserve(&self.gpu, tile)?;
        // Behind a layer that has been cast before, the books of its rays are gone.
        let budget = job.scene.sampling.budget().filter(|_| tile.first_layer == 0);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.bundles.clear_counters(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
        if let Some(budget) = budget {
            self.analyse(job, tile, size, budget, &mut |part| progress(0.25 * part), picture)?;
        }
        let begun = if budget.is_some() { 0.25 } else { 0.0 };
        let uniforms =
            Uniforms { budget: budget.unwrap_or(0.0), stage: Stage::Cast, adapted: budget.is_some() };
        self.for_bundles(job, tile, uniforms, &mut |part| progress(begun + (1.0 - begun) * part), picture)?;
        self.fetch_tile(tile, size, budget.is_some(), picture)
    }

    /// Chooses which bricks of `tile` to sample; finds out about those not known yet.
    fn analyse(
        &mut self,
        job: &Job,
        tile: &Tile,
        size: GridSize,
        budget: f32,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        self.adapt.reserve(&self.gpu, tile, size.cells)?;
        let wanted = (job.geometry.clone(), job.scene.quantity.id(), job.scene.kernel);
        let known = self.analysed.take().filter(|known| job.only_tile && *known == wanted);
        if known.is_none() {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            self.adapt.clear(&mut encoder);
            self.gpu.queue.submit([encoder.finish()]);
        }
        let uniforms = Uniforms { budget, stage: Stage::Analysis, adapted: true };
        self.for_bundles(job, tile, uniforms, progress, picture)?;
        self.analysed = job.only_tile.then_some(wanted);
        Ok(())
    }

    /// Runs a stage over the bundles of `tile`, in submissions of bounded length.
    fn for_bundles(
        &mut self,
        job: &Job,
        tile: &Tile,
        Uniforms { budget, stage, adapted }: Uniforms,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let bundles = tile.bundles();
        let mut first = 0;
        while first < bundles {
            if progress(first as f32 / bundles as f32).is_break() {
                return Err(RenderError::Cancelled);
            }
            let end = bundles.min(first + self.pace[stage as usize].bundles());
            self.bundles.write_chunk(&self.gpu, first..end, bundles, budget)?;
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            self.timing.pass(&mut encoder, stage.label(), |pass| {
                let uniforms = [&self.frame, &self.tile];
                let (bundles, store, grid) = (&self.bundles, &self.store, &self.grid);
                let (gpu, kernel, transfer, count) =
                    (&self.gpu, job.scene.kernel, &self.transfer, end - first);
                match stage {
                    Stage::Analysis => {
                        self.adapt.record(gpu, pass, kernel, bundles, uniforms, store, grid, transfer, count)
                    }
                    Stage::Cast => {
                        let plan = adapted.then_some(&self.adapt);
                        self.cast
                            .record(gpu, pass, kernel, bundles, uniforms, store, grid, transfer, plan, count);
                    }
                }
            });
            let begin = Instant::now();
            self.submit(encoder, &mut picture.stats.milliseconds)?;
            self.pace[stage as usize].learn(end - first, begin.elapsed());
            first = end;
        }
        Ok(())
    }

    /// Submits, waits, and adds the time of each stage.
    fn submit(
        &mut self,
        mut encoder: wgpu::CommandEncoder,
        times: &mut Milliseconds,
    ) -> Result<(), RenderError> {
        self.timing.resolve(&mut encoder);
        let begin = Instant::now();
        self.gpu.queue.submit([encoder.finish()]);
        let mut stages = self.timing.take(&self.gpu)?;
        if !self.gpu.timestamps {
            // The host's clock is all there is: a submission holds one stage.
            stages.truncate(1);
            stages.iter_mut().for_each(|(_, time)| *time = begin.elapsed().as_secs_f64() * 1e3);
        }
        for (label, time) in stages {
            match label.as_str() {
                "grid" => times.grid += time,
                "analysis" => times.analysis += time,
                _ => times.ray_cast += time,
            }
        }
        Ok(())
    }

    fn fetch_tile(
        &self,
        tile: &Tile,
        size: GridSize,
        adapted: bool,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let pixels = self.cast.pixels.read_back(&self.gpu, &mut encoder, tile.bundles() * 64);
        self.gpu.queue.submit([encoder.finish()]);
        let pixels: Vec<[f32; 4]> = pixels.take(&self.gpu)?;
        picture.place(tile, &pixels);
        let counters = self.bundles.read_counters(&self.gpu)?;
        picture.stats.count(&counters, size.cells, adapted);
        Ok(())
    }
}
