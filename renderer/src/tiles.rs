//! One tile of a picture: its particles, its grid, its rays, its pixels.

use std::time::Instant;

use crate::camera::Slices;
use crate::error::{RenderError, TooLarge};
use crate::kernel::Kernel;
use crate::picture::Picture;
use crate::plan::{Tile, TileLimits};
use crate::renderer::{Geometry, GridSize, Progress, Renderer};
use crate::sampling::{Bound, BrickWidth, Without};
use crate::scene::Scene;
use crate::selection;
use crate::stages::cast::Work;
use crate::stages::grid::Totals;
use crate::stages::shared::{Fields, FrameUniform, TileUniform, pitch, spread};
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
    /// Row of bundles that is the first of the pixels: above 0 in a band of a picture.
    pub first_row: u32,
}

/// What may be charged to the rays of `tile`; `None` where it is sampled in full: also behind layers
/// that have been cast before, since the books of its rays are gone.
fn budget_of(job: &Job, tile: &Tile) -> Option<f32> {
    let sampling = &job.scene.sampling;
    let worthwhile = sampling.always_adaptive || analysis_may_pay(job.scene);
    // The paper's bound knows one field.
    let bounded = sampling.bound == Bound::Difference || job.scene.quantity.fields() == Fields::One;
    sampling.budget().filter(|_| tile.first_layer == 0 && worthwhile && bounded)
}

/// Whether any particle is large enough, amid the run, for the analysis to pay. A support that hardly
/// covers a brick of 2 × 2 rays × 4 slices gives it no narrow bounds. Measured on lattices, a mixer and a
/// dam break, adaptive pictures were slower than full ones below 4 pixels, and above mostly faster.
fn analysis_may_pay(scene: &Scene) -> bool {
    const LEAST_PIXELS: f64 = 4.0;
    let camera = &scene.camera;
    let middle = scene.particles.bounds().map_or(camera.near, |bounds| camera.depth(bounds.centre()));
    let pixel = pitch(scene) * middle.clamp(camera.near, camera.far);
    scene.particles.support_radii()[1] > LEAST_PIXELS * pixel
}

/// The grid whose bounds the device knows, with what they hold for, and whose bounds they are.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Analysed {
    geometry: Geometry,
    quantity: u64,
    kernel: Kernel,
    bound: Bound,
    width: BrickWidth,
    without: Without,
}

impl Analysed {
    fn of(job: &Job) -> Analysed {
        let (scene, geometry) = (job.scene, job.geometry.clone());
        let (kernel, sampling) = (scene.kernel, &scene.sampling);
        let (bound, width, without) = (sampling.bound, sampling.column_width(), sampling.without);
        Analysed { geometry, quantity: scene.quantity.id(), kernel, bound, width, without }
    }
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
        let (limit, in_a_bundle) = (job.limits.filled_cells, size.cells.min(tile.layers.into()));
        if budget_of(job, tile).is_some() && in_a_bundle > limit {
            return Ok(Err(TooLarge { what: "cells to analyse", needed: in_a_bundle, limit }));
        }
        Ok(Ok(size))
    }

    /// Whether the device still has all of the only tile of the last picture, which is that of `job`.
    pub(crate) fn is_held(&self, job: &Job) -> bool {
        let sorted = self.sorted.as_ref().is_some_and(|(geometry, _)| *geometry == job.geometry);
        let known = !self.adapted || self.analysed == Some(Analysed::of(job));
        job.only_tile && sorted && known
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
            self.order.reserve(&self.gpu, capacity)?;
            self.tile.write(&self.gpu, &[TileUniform::new(tile, capacity)])?;
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            if self.projected.as_ref() != Some(&job.geometry) {
                self.timing.pass(&mut encoder, "grid", |pass| {
                    self.project.record(&self.gpu, pass, &self.frame, &self.store);
                });
            }
            let uniforms = [&self.frame, &self.tile];
            self.grid.record(&self.gpu, &mut encoder, &self.timing, uniforms, &self.store, tile)?;
            self.timing.pass(&mut encoder, "grid", |pass| {
                let bundles = tile.bundles();
                self.order.record_batches(&self.gpu, pass, &self.tile, &self.store, &self.grid, bundles);
            });
            let totals = self.grid.totals.read_back(&self.gpu, &mut encoder, 1);
            self.submit(encoder, times)?;
            let totals = totals.take::<Totals>(&self.gpu)?[0];
            self.projected = Some(job.geometry.clone());

            let needed = u64::from(totals.pairs);
            if needed <= capacity {
                self.order_left_cells(totals, times)?;
                if let Some(too_large) = self.find_crowds(job, tile, totals)? {
                    return Ok(Err(too_large));
                }
                return Ok(Ok(GridSize { pairs: needed, cells: totals.cells.into() }));
            }
            if needed > limit {
                return Ok(Err(TooLarge { what: "references to particles", needed, limit }));
            }
            // Some room to spare: the next camera may need a little more.
            self.grid.pairs.reserve(&self.gpu, (needed + needed / 8).min(limit))?;
        }
    }

    /// Orders the references of those cells that the batches left.
    fn order_left_cells(&mut self, totals: Totals, times: &mut Milliseconds) -> Result<(), RenderError> {
        if totals.left_cells == 0 {
            return Ok(());
        }
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.timing.pass(&mut encoder, "grid", |pass| {
            let cells = totals.left_cells.into();
            self.order.record_left(&self.gpu, pass, &self.tile, &self.store, &self.grid, cells);
        });
        self.submit(encoder, times)
    }

    /// Casts the rays of `tile`, sampled as its budget allows, and puts its pixels into the picture. `pays`:
    /// whether an analysis does, where that is known.
    pub(crate) fn cast_tile(
        &mut self,
        job: &Job,
        tile: &Tile,
        size: GridSize,
        pays: Option<bool>,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        self.cast.prepare(&self.gpu, self.cast.variant(job.scene));
        self.cast.reserve(&self.gpu, tile)?;
        let has_budget = budget_of(job, tile).is_some() && pays != Some(false);
        if has_budget {
            self.prepare_analysis(job, tile, size)?;
        }
        self.adapted = has_budget && (pays.is_some() || self.analysis_pays(job, tile, progress, picture)?);
        self.column_width = job.scene.sampling.column_width();
        self.clear_counters();
        self.sum_crowds(job, progress, &mut picture.stats.milliseconds)?;
        let bundles = tile.bundles();
        let stride = self.stride(bundles);
        let mut first = 0;
        while first < bundles {
            if progress(first as f32 / bundles as f32).is_break() {
                return Err(RenderError::Cancelled);
            }
            let begin = Instant::now();
            let chunk = if self.adapted { self.adaptive_chunk(job, tile) } else { self.pace[0].bundles() };
            let end = bundles.min(first + chunk);
            self.bundles.write_chunk(&self.gpu, first..end, stride, &job.scene.sampling)?;
            let times = &mut picture.stats.milliseconds;
            match self.adapted {
                false => self.cast_fully(job.scene, end - first, times)?,
                true => self.cast_adaptively(job.scene, end - first, times)?,
            }
            self.pace[usize::from(self.adapted)].learn(end - first, begin.elapsed());
            first = end;
        }
        let kept = has_budget && job.only_tile && !self.recycles_bounds;
        self.analysed = kept.then(|| Analysed::of(job));
        self.fetch_tile(job, tile, size, picture)
    }

    /// The stride of turns over so many bundles. A GPU takes its workgroups as it gets done with others, and
    /// neighbours share particles in its caches. A software adapter gives each thread a stretch of them
    /// beforehand.
    pub(crate) fn stride(&self, bundles: u64) -> u32 {
        if self.gpu.is_software() { spread(bundles) } else { 1 }
    }

    /// Forgets what was counted in the tile before.
    pub(crate) fn clear_counters(&self) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.bundles.clear_counters(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Bundles of `tile` that one submission may analyse.
    pub(crate) fn adaptive_chunk(&self, job: &Job, tile: &Tile) -> u64 {
        let most = (job.limits.filled_cells / u64::from(tile.layers)).max(1);
        self.pace[1].bundles().min(most)
    }

    /// Makes room for the bounds of `tile`, and forgets them where they hold for something else.
    fn prepare_analysis(&mut self, job: &Job, tile: &Tile, size: GridSize) -> Result<(), RenderError> {
        let capacity = size.cells.min(job.limits.filled_cells);
        self.recycles_bounds = size.cells > capacity;
        self.adapt.reserve(&self.gpu, tile, capacity, job.scene)?;
        let Scene { kernel, sampling, quantity, .. } = job.scene;
        self.adapt.prepare(&self.gpu, *kernel, sampling.without, quantity.fields(), sampling.brick_width);
        let known = self.analysed.take().filter(|known| job.only_tile && *known == Analysed::of(job));
        if known.is_none() {
            self.forget_bounds();
        }
        Ok(())
    }

    pub(crate) fn forget_bounds(&self) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.adapt.clear(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
    }

    fn cast_fully(
        &mut self,
        scene: &Scene,
        bundles: u64,
        times: &mut Milliseconds,
    ) -> Result<(), RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let shared = self.shared_bindings();
        self.timing.pass(&mut encoder, "ray cast", |pass| {
            self.cast.record_full(&self.gpu, pass, scene, &shared, bundles);
        });
        self.submit(encoder, times)
    }

    /// Chooses what to sample in `bundles` bundles.
    pub(crate) fn analyse(
        &mut self,
        scene: &Scene,
        bundles: u64,
        times: &mut Milliseconds,
    ) -> Result<Work, RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.adapt.clear_work(&mut encoder);
        if self.recycles_bounds {
            self.adapt.clear_slots(&mut encoder);
        }
        let shared = self.shared_bindings();
        self.timing.pass(&mut encoder, "analysis", |pass| {
            self.adapt.record(&self.gpu, pass, scene, &shared, bundles);
        });
        let work = self.adapt.read_work(&self.gpu, &mut encoder);
        drop(shared);
        self.submit(encoder, times)?;
        let work: Vec<u32> = work.take(&self.gpu)?;
        Ok(Work { wholes: work[0].into(), parts: work[1].into(), sloped: work[2].into() })
    }

    /// Chooses what to sample in `bundles` bundles, and samples it.
    fn cast_adaptively(
        &mut self,
        scene: &Scene,
        bundles: u64,
        times: &mut Milliseconds,
    ) -> Result<(), RenderError> {
        let work = self.analyse(scene, bundles, times)?;
        self.cast.reserve_segments(&self.gpu, work)?;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let shared = self.shared_bindings();
        self.timing.pass(&mut encoder, "ray cast", |pass| {
            self.cast.record_adaptive(&self.gpu, pass, scene, &shared, &self.adapt, work, bundles);
        });
        drop(shared);
        self.submit(encoder, times)
    }

    /// Resources that all stages with a workgroup a bundle or a cell share.
    pub(crate) fn shared_bindings(&self) -> Vec<wgpu::BindingResource<'_>> {
        self.bundles.bindings([&self.frame, &self.tile], &self.store, &self.grid, &self.transfer)
    }

    /// Submits, waits, and adds the time of each stage.
    pub(crate) fn submit(
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

    pub(crate) fn fetch_tile(
        &self,
        job: &Job,
        tile: &Tile,
        size: GridSize,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let pixels = self.cast.pixels.read_back(&self.gpu, &mut encoder, tile.bundles() * 64);
        self.gpu.queue.submit([encoder.finish()]);
        let pixels: Vec<[f32; 4]> = pixels.take(&self.gpu)?;
        picture.place(&tile.higher(job.first_row), &pixels);
        let counters = self.bundles.read_counters(&self.gpu)?;
        picture.stats.count(&counters, size.cells, self.adapted);
        Ok(())
    }
}
