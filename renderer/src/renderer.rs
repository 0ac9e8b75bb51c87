//! The stages in order, and which of them a change makes stale.

use std::ops::ControlFlow;
use std::time::Instant;

use rayon::prelude::*;

use crate::camera::{BUNDLE_SIDE, Camera, Slices};
use crate::error::RenderError;
use crate::gpu::{Buffer, Gpu, Timing};
use crate::kernel::Kernel;
use crate::pace::Pace;
use crate::picture::Picture;
use crate::plan::{self, Tile, TileLimits};
use crate::scene::Scene;
use crate::stages::cast::Cast;
use crate::stages::grid::Grid;
use crate::stages::project::Project;
use crate::stages::shared::{FrameUniform, ParticleStore, TileUniform, TransferTables};
use crate::stats::{Milliseconds, Stats};
use crate::transfer::TransferFunction;

/// Asks between submissions whether to go on; gets the share done, 0 to 1.
pub type Progress<'a> = dyn FnMut(f32) -> ControlFlow<()> + 'a;

/// Turns scenes into pictures; keeps what the next picture can use again.
///
/// - An unchanged scene costs nothing.
/// - A new transfer function, reference length or kernel casts again on the same grid.
/// - A new quantity is uploaded, and cast on the same grid.
/// - A new camera projects and sorts again, without an upload.
///
/// A picture of several tiles builds the grid of each tile anew whatever has changed.
pub struct Renderer {
    gpu: Gpu,
    timing: Timing,
    frame: Buffer,
    tile: Buffer,
    store: ParticleStore,
    transfer: TransferTables,
    project: Project,
    grid: Grid,
    cast: Cast,
    pace: Pace,
    /// What the device holds: projected particles, and the grid of the only tile.
    projected: Option<Geometry>,
    sorted: Option<(Geometry, GridSize)>,
    last: Option<(Geometry, Shading, Picture)>,
}

/// How large the grid of a tile is.
#[derive(Clone, Copy, Debug)]
struct GridSize {
    pairs: u64,
    cells: u64,
}

/// What the grid depends on.
#[derive(Clone, Debug, PartialEq)]
struct Geometry {
    particles: u64,
    camera: Camera,
    size: [u32; 2],
    rate: f64,
}

/// What, beside the grid, a picture depends on.
#[derive(Clone, Debug, PartialEq)]
struct Shading {
    quantity: u64,
    kernel: Kernel,
    transfer: TransferFunction,
    reference_length: f64,
}

/// First guess of the references that one particle needs; an overflow tells the true number.
const PAIRS_PER_PARTICLE: u64 = 8;

impl Renderer {
    /// Builds every pipeline.
    pub fn new(gpu: Gpu) -> Result<Renderer, RenderError> {
        Renderer::with_options(gpu, false)
    }

    /// Like [`Renderer::new`], and counts the evaluations whose weight is above zero, which slows
    /// the casting: for measurements.
    pub fn counting(gpu: Gpu) -> Result<Renderer, RenderError> {
        Renderer::with_options(gpu, true)
    }

    fn with_options(gpu: Gpu, count_inside: bool) -> Result<Renderer, RenderError> {
        let renderer = Renderer {
            timing: Timing::new(&gpu)?,
            frame: Buffer::uniform::<FrameUniform>(&gpu, "frame"),
            tile: Buffer::uniform::<TileUniform>(&gpu, "tile"),
            store: ParticleStore::new(&gpu),
            transfer: TransferTables::new(&gpu),
            project: Project::new(&gpu),
            grid: Grid::new(&gpu),
            cast: Cast::new(&gpu, count_inside),
            pace: Pace::new(gpu.is_software()),
            projected: None,
            sorted: None,
            last: None,
            gpu,
        };
        renderer.gpu.check()?;
        Ok(renderer)
    }

    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Renders `scene` at full sampling. Blocks until the picture is there, and asks `progress`
    /// between submissions, some tens of milliseconds apart, whether to go on.
    pub fn render(&mut self, scene: &Scene, progress: &mut Progress) -> Result<Picture, RenderError> {
        let geometry = Geometry::of(scene);
        let shading = Shading::of(scene);
        if let Some((last_geometry, last_shading, picture)) = &self.last
            && (last_geometry, last_shading) == (&geometry, &shading)
        {
            let mut picture = picture.clone();
            picture.stats.milliseconds = Milliseconds::default();
            return Ok(picture);
        }
        let result = self.render_stale(scene, &geometry, progress);
        if result.is_err() {
            // What an interrupted picture left on the device is not known.
            (self.projected, self.sorted) = (None, None);
        }
        let picture = result?;
        self.last = Some((geometry, shading, picture.clone()));
        Ok(picture)
    }

    fn render_stale(
        &mut self,
        scene: &Scene,
        geometry: &Geometry,
        progress: &mut Progress,
    ) -> Result<Picture, RenderError> {
        let slices = Slices::new(&scene.camera, scene.height, scene.rate);
        let mut picture = self.blank(scene, &slices);
        let begin = Instant::now();
        self.upload(scene, &slices)?;
        picture.stats.milliseconds.upload = begin.elapsed().as_secs_f64() * 1e3;

        let limits = TileLimits::new(self.gpu.binding_limit(), self.gpu.memory);
        let bundles = [scene.width.div_ceil(BUNDLE_SIDE), scene.height.div_ceil(BUNDLE_SIDE)];
        let mut todo = plan::tiles(bundles, slices.count, limits);
        let only_tile = todo.len() == 1;
        todo.reverse();
        let cells: u64 = todo.iter().map(Tile::cells).sum();
        let mut cells_done = 0;
        while let Some(tile) = todo.pop() {
            let share = |part: f32| (cells_done as f32 + part * tile.cells() as f32) / cells as f32;
            let mut tile_progress = |part: f32| progress(share(part));
            match self.render_tile(scene, geometry, &tile, only_tile, &mut tile_progress, &mut picture)? {
                TileOutcome::Done => cells_done += tile.cells(),
                TileOutcome::TooManyPairs { needed } => {
                    let Some([a, b]) = tile.split() else {
                        let limit = self.pair_limit() * 4;
                        return Err(RenderError::BufferLimit { what: "one cell's particles", needed, limit });
                    };
                    todo.extend([b, a]);
                }
            }
        }
        let milliseconds = &mut picture.stats.milliseconds;
        milliseconds.total = milliseconds.upload + milliseconds.grid + milliseconds.ray_cast;
        picture.stats.gpu_bytes = self.store.bytes() + self.grid.bytes() + self.cast.bytes();
        Ok(picture)
    }

    /// A transparent picture, and what is known of it before it is rendered.
    fn blank(&self, scene: &Scene, slices: &Slices) -> Picture {
        let [width, height] = [scene.width, scene.height];
        let mut rejected = scene.particles.rejected();
        rejected.non_finite += scene.quantity.rejected();
        let bundles = u64::from(width.div_ceil(BUNDLE_SIDE)) * u64::from(height.div_ceil(BUNDLE_SIDE));
        let stats = Stats {
            adapter: self.gpu.adapter_name().to_owned(),
            backend: self.gpu.backend(),
            particles: scene.particles.len() as u64 - scene.quantity.rejected(),
            rejected,
            near: scene.camera.near,
            far: scene.camera.far,
            slices: slices.count,
            bundles,
            ..Stats::default()
        };
        Picture { width, height, pixels: vec![[0.0; 4]; width as usize * height as usize], stats }
    }

    fn upload(&mut self, scene: &Scene, slices: &Slices) -> Result<(), RenderError> {
        if self.store.upload(&self.gpu, &scene.particles, &scene.quantity)? {
            // The copy may have moved the arrays that the projection filled.
            self.projected = self.projected.take().filter(|held| held.particles == scene.particles.id());
        }
        self.transfer.write(&self.gpu, &scene.transfer)?;
        self.frame.write(&self.gpu, &[FrameUniform::new(scene, slices)])?;
        self.cast.write_slices(&self.gpu, slices, scene.particles.unit())
    }

    /// References that one tile may have.
    fn pair_limit(&self) -> u64 {
        (self.gpu.binding_limit().min(self.gpu.memory / 2) / 4).min(u64::from(u32::MAX - 1))
    }

    fn render_tile(
        &mut self,
        scene: &Scene,
        geometry: &Geometry,
        tile: &Tile,
        only_tile: bool,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<TileOutcome, RenderError> {
        self.cast.reserve(&self.gpu, tile)?;
        let fresh = self.sorted.take().filter(|(sorted, _)| only_tile && sorted == geometry);
        let size = match fresh {
            Some((_, size)) => size,
            None => match self.build_grid(scene, geometry, tile, picture)? {
                GridOutcome::Built(size) => size,
                GridOutcome::TooManyPairs { needed } => return Ok(TileOutcome::TooManyPairs { needed }),
            },
        };
        self.sorted = only_tile.then(|| (geometry.clone(), size));
        picture.stats.pairs += size.pairs;
        picture.stats.cells += size.cells;
        self.cast_tile(scene, tile, progress, picture)?;
        Ok(TileOutcome::Done)
    }

    /// Projects where that is stale, and sorts the particles into the cells of `tile`; grows the pair
    /// buffer and sorts again where it was too small.
    fn build_grid(
        &mut self,
        scene: &Scene,
        geometry: &Geometry,
        tile: &Tile,
        picture: &mut Picture,
    ) -> Result<GridOutcome, RenderError> {
        let particles = scene.particles.len() as u64;
        self.grid.reserve(&self.gpu, tile)?;
        let limit = self.pair_limit();
        self.grid.pairs.reserve(&self.gpu, (particles * PAIRS_PER_PARTICLE).clamp(1, limit))?;
        loop {
            let capacity = self.grid.pairs.capacity().min(limit);
            self.tile.write(&self.gpu, &[TileUniform::new(tile, capacity)])?;
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            if self.projected.as_ref() != Some(geometry) {
                self.timing.pass(&mut encoder, "grid", |pass| {
                    self.project.record(&self.gpu, pass, &self.frame, &self.store, particles);
                });
            }
            let uniforms = [&self.frame, &self.tile];
            self.grid.record(
                &self.gpu,
                &mut encoder,
                &self.timing,
                uniforms,
                &self.store,
                tile,
                particles,
            )?;
            let totals = self.grid.totals.read_back(&self.gpu, &mut encoder, 1);
            self.submit(encoder, &mut picture.stats.milliseconds)?;
            let totals: Vec<u32> = totals.take(&self.gpu)?;
            self.projected = Some(geometry.clone());

            let needed = u64::from(totals[0]);
            if needed <= capacity {
                let size = GridSize { pairs: needed, cells: u64::from(totals[1]) };
                return Ok(GridOutcome::Built(size));
            }
            if needed > limit {
                return Ok(GridOutcome::TooManyPairs { needed: needed * 4 });
            }
            // Some room to spare: the next camera may need a little more.
            self.grid.pairs.reserve(&self.gpu, (needed + needed / 8).min(limit))?;
        }
    }

    /// Casts the rays of `tile` in submissions of bounded length, and puts its pixels into the picture.
    fn cast_tile(
        &mut self,
        scene: &Scene,
        tile: &Tile,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let bundles = tile.bundles();
        let mut first = 0;
        while first < bundles {
            if progress(first as f32 / bundles as f32).is_break() {
                return Err(RenderError::Cancelled);
            }
            let end = bundles.min(first + self.pace.bundles());
            self.cast.write_chunk(&self.gpu, first..end)?;
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            if first == 0 {
                encoder.clear_buffer(self.cast.counters.raw(), 0, None);
            }
            self.timing.pass(&mut encoder, "ray cast", |pass| {
                let uniforms = [&self.frame, &self.tile];
                let (store, grid, transfer) = (&self.store, &self.grid, &self.transfer);
                self.cast.record(&self.gpu, pass, scene.kernel, uniforms, store, grid, transfer, end - first);
            });
            let begin = Instant::now();
            self.submit(encoder, &mut picture.stats.milliseconds)?;
            self.pace.learn(end - first, begin.elapsed());
            first = end;
        }
        self.fetch_tile(tile, picture)
    }

    /// Submits, waits, and adds the time of each stage.
    fn submit(
        &mut self,
        mut encoder: wgpu::CommandEncoder,
        milliseconds: &mut Milliseconds,
    ) -> Result<(), RenderError> {
        self.timing.resolve(&mut encoder);
        let begin = Instant::now();
        self.gpu.queue.submit([encoder.finish()]);
        let times = self.timing.take(&self.gpu)?;
        let elapsed = begin.elapsed().as_secs_f64() * 1e3;
        let measured: f64 = times.iter().map(|(_, time)| time).sum();
        for (label, time) in times {
            // Without timestamps the host's clock is all there is: one stage a submission.
            let time = if self.timing.has_timestamps { time } else { elapsed };
            match label.as_str() {
                "grid" => milliseconds.grid += time,
                _ => milliseconds.ray_cast += time,
            }
            if measured == 0.0 {
                break;
            }
        }
        Ok(())
    }

    fn fetch_tile(&self, tile: &Tile, picture: &mut Picture) -> Result<(), RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let pixels = self.cast.pixels.read_back(&self.gpu, &mut encoder, tile.bundles() * 64);
        let counters = self.cast.counters.read_back(&self.gpu, &mut encoder, 1);
        self.gpu.queue.submit([encoder.finish()]);
        let pixels: Vec<[f32; 4]> = pixels.take(&self.gpu)?;
        let counters: Vec<u32> = counters.take(&self.gpu)?;
        let word = |low: usize| u64::from(counters[low]) | u64::from(counters[low + 1]) << 32;
        picture.stats.evaluations.full += word(0);
        picture.stats.evaluations.done += word(0);
        picture.stats.evaluations.inside += word(2);
        picture.place(tile, &pixels);
        Ok(())
    }
}

enum TileOutcome {
    Done,
    /// More references than the device can hold: bytes that they need.
    TooManyPairs {
        needed: u64,
    },
}

enum GridOutcome {
    Built(GridSize),
    TooManyPairs { needed: u64 },
}

impl Geometry {
    fn of(scene: &Scene) -> Geometry {
        Geometry {
            particles: scene.particles.id(),
            camera: scene.camera,
            size: [scene.width, scene.height],
            rate: scene.rate,
        }
    }
}

impl Shading {
    fn of(scene: &Scene) -> Shading {
        Shading {
            quantity: scene.quantity.id(),
            kernel: scene.kernel,
            transfer: scene.transfer.clone(),
            reference_length: scene.reference_length,
        }
    }
}

impl Picture {
    /// Puts the pixels of a tile, 64 a bundle as the device has them, into their places.
    fn place(&mut self, tile: &Tile, pixels: &[[f32; 4]]) {
        let width = self.width as usize;
        let [first_x, first_y] = tile.first.map(|bundle| (bundle * BUNDLE_SIDE) as usize);
        let columns = (tile.count[0] * BUNDLE_SIDE) as usize;
        let rows = (tile.count[1] * BUNDLE_SIDE) as usize;
        let side = BUNDLE_SIDE as usize;
        self.pixels.par_chunks_mut(width).skip(first_y).take(rows).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().skip(first_x).take(columns).enumerate() {
                let bundle = (y / side) * tile.count[0] as usize + x / side;
                let [r, g, b, transparency] = pixels[bundle * 64 + (y % side) * side + x % side];
                *pixel = [r, g, b, 1.0 - transparency];
            }
        });
    }
}
