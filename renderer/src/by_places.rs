//! A picture sampled in full by a hash grid in world space, for measurements.

use std::time::Instant;

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::CELL_SLICES;
use crate::error::RenderError;
use crate::pace::Pace;
use crate::picture::Picture;
use crate::plan::{self, Contents, Tile, TileLimits};
use crate::renderer::{GridSize, Progress, Renderer};
use crate::stages::object_space::{HashGrid, ObjectSpace};
use crate::stages::shared::{TileUniform, pivot_depth, radius_floor, spread};
use crate::tiles::Job;

/// Rounds of loops that a ray may take in one submission: software adapters end them after 65,535.
const ROUNDS: u32 = 60_000;
/// Rounds that a sample takes beside those for its particles, with plenty to spare for the search of its cell.
const ROUNDS_OF_SAMPLE: u32 = 16;

const TOO_LITTLE_MEMORY: &str =
    "its memory does not hold all particles at once, as sampling in object space needs them";

impl Renderer {
    /// Renders without a grid of cells; the time for the hash grid counts in place of theirs.
    pub(crate) fn render_by_places(
        &mut self,
        job: &Job,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let begin = Instant::now();
        let grid = HashGrid::new(&balls(job)?);
        let layers = layers_at_once(&grid)?;
        let camera = &job.scene.camera;
        let pivot = job.scene.particles.to_device(camera.eye + pivot_depth(camera) * camera.forward);
        self.make_room(job, &grid)?;
        let object_space = ObjectSpace::new(&self.gpu, job.scene, &grid, pivot)?;
        let built = begin.elapsed().as_secs_f64() * 1e3;
        // What is known of cells is written over.
        self.forget();
        self.adapted = false;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.timing.pass(&mut encoder, "grid", |pass| {
            self.project.record(&self.gpu, pass, &self.frame, &self.store);
        });
        self.submit(encoder, &mut picture.stats.milliseconds)?;
        picture.stats.milliseconds.grid += built;
        // Of a single layer, so that tiles are as large as their pixels allow.
        let tiles = plan::tiles(Renderer::bundles(job.scene), CELL_SLICES.into(), job.limits);
        for (number, tile) in tiles.iter().enumerate() {
            let whole = Tile { layers: job.slices.layers() as u32, ..*tile };
            let mut progress = |part: f32| progress((number as f32 + part) / tiles.len() as f32);
            self.cast_by_places(job, &whole, &object_space, layers, &mut progress, picture)?;
        }
        Ok(())
    }

    /// Gives back what cells along the rays need and a hash grid does not.
    fn make_room(&mut self, job: &Job, grid: &HashGrid) -> Result<(), RenderError> {
        let limits = TileLimits { pairs: 0, cells: 0, filled_cells: 0, portions: 0, ..job.limits };
        self.give_back_above(&limits, Contents::of(job.scene));
        let room = self.gpu.memory.saturating_sub(self.gpu.ledger.held() + limits.pixel_bytes());
        if grid.bytes() <= room {
            return Ok(());
        }
        Err(RenderError::Device(TOO_LITTLE_MEMORY.to_owned()))
    }

    /// Casts the rays of `tile`, through so many layers a submission.
    fn cast_by_places(
        &mut self,
        job: &Job,
        tile: &Tile,
        object_space: &ObjectSpace,
        layers: u32,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        self.cast.reserve(&self.gpu, tile)?;
        self.clear_counters();
        let bundles = tile.bundles();
        let mut pace = Pace::new(self.gpu.is_software());
        let mut first = 0;
        while first < bundles {
            let begin = Instant::now();
            let end = bundles.min(first + pace.bundles());
            self.bundles.write_chunk(&self.gpu, first..end, spread(bundles), &job.scene.sampling)?;
            for layer in (0..tile.layers).step_by(layers as usize) {
                if progress(first as f32 / bundles as f32).is_break() {
                    return Err(RenderError::Cancelled);
                }
                let part = Tile { first_layer: layer, layers: layers.min(tile.layers - layer), ..*tile };
                self.tile.write(&self.gpu, &[TileUniform::new(&part, 0)])?;
                let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
                let shared = self.shared_bindings();
                self.timing.pass(&mut encoder, "ray cast", |pass| {
                    object_space.record(&self.gpu, pass, &shared, &self.cast.pixels, end - first);
                });
                drop(shared);
                self.submit(encoder, &mut picture.stats.milliseconds)?;
            }
            pace.learn(end - first, begin.elapsed());
            first = end;
        }
        self.fetch_tile(job, tile, GridSize { pairs: 0, cells: 0 }, picture)
    }
}

/// Places and support radii as the device has them.
fn balls(job: &Job) -> Result<Vec<(DVec3, f64)>, RenderError> {
    let particles = &job.scene.particles;
    if !job.resident {
        return Err(RenderError::Device(TOO_LITTLE_MEMORY.to_owned()));
    }
    let (camera, unit) = (&job.scene.camera, particles.unit());
    let (eye, [near, far]) = (particles.to_device(camera.eye), [camera.near / unit, camera.far / unit]);
    let floor = radius_floor(job.scene, &job.slices);
    let depth = |place: DVec3| (place - eye).dot(camera.forward).clamp(near, far);
    Ok(particles.balls().map(|(place, radius)| (place, radius.max(floor * depth(place)))).collect())
}

/// Layers of slices whose samples a ray may take in one submission.
fn layers_at_once(grid: &HashGrid) -> Result<u32, RenderError> {
    match ROUNDS / CELL_SLICES / (grid.largest + ROUNDS_OF_SAMPLE) {
        0 => Err(RenderError::Device(format!(
            "{} particles in one cell of a hash grid are too many for sampling in object space",
            grid.largest
        ))),
        layers => Ok(layers),
    }
}
