//! A tile sampled in full by a hash grid in world space, for measurements.

use std::time::Instant;

use glam::DVec3;
use rayon::prelude::*;

use crate::error::{RenderError, TooLarge};
use crate::pace::Pace;
use crate::picture::Picture;
use crate::plan::Tile;
use crate::renderer::{GridSize, Progress, Renderer};
use crate::stages::object_space::{HashGrid, ObjectSpace};
use crate::stages::shared::{TileUniform, pivot_depth, radius_floor, spread};
use crate::tiles::Job;

/// Particles that a ray may look at in one submission: software adapters end loops after 65,535 rounds.
const ROUNDS: u32 = 30_000;
/// Samples of a ray in a layer.
const SLICES: u32 = 16;

impl Renderer {
    /// Casts the rays of `tile`. The time for cells along the rays, which are not looked at, is not counted.
    pub(crate) fn cast_by_places(
        &mut self,
        job: &Job,
        tile: &Tile,
        size: GridSize,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let begin = Instant::now();
        let grid = HashGrid::new(&balls(job)?);
        picture.stats.milliseconds.grid = begin.elapsed().as_secs_f64() * 1e3;
        let layers = layers_at_once(&grid)?;
        let camera = &job.scene.camera;
        let pivot = job.scene.particles.to_device(camera.eye + pivot_depth(camera) * camera.forward);
        let object_space = ObjectSpace::new(&self.gpu, job.scene.kernel, &grid, pivot)?;
        self.clear_counters();
        let bundles = tile.bundles();
        let mut pace = Pace::new(self.gpu.is_software());
        let mut first = 0;
        while first < bundles {
            let begin = Instant::now();
            let end = bundles.min(first + pace.bundles());
            self.bundles.write_chunk(&self.gpu, first..end, spread(bundles), &job.scene.sampling)?;
            let mut layer = 0;
            while layer < tile.layers {
                if progress(first as f32 / bundles as f32).is_break() {
                    return Err(RenderError::Cancelled);
                }
                let some = layers.min(tile.layers - layer);
                let part = Tile { first_layer: tile.first_layer + layer, layers: some, ..*tile };
                self.tile.write(&self.gpu, &[TileUniform::new(&part, 0)])?;
                let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
                let shared = self.shared_bindings();
                self.timing.pass(&mut encoder, "ray cast", |pass| {
                    object_space.record(&self.gpu, pass, &shared, &self.cast.pixels, end - first);
                });
                drop(shared);
                self.submit(encoder, &mut picture.stats.milliseconds)?;
                layer += some;
            }
            pace.learn(end - first, begin.elapsed());
            first = end;
        }
        self.adapted = false;
        // What is known of the tile is written over.
        self.forget();
        self.fetch_tile(tile, size, picture)
    }
}

/// Places and support radii as the device has them.
fn balls(job: &Job) -> Result<Vec<(DVec3, f64)>, RenderError> {
    let particles = &job.scene.particles;
    if !job.resident {
        let (needed, limit) = (particles.len() as u64, job.limits.particles);
        return Err(TooLarge { what: "particles", needed, limit }.into());
    }
    let (camera, unit) = (&job.scene.camera, particles.unit());
    let (eye, [near, far]) = (particles.to_device(camera.eye), [camera.near / unit, camera.far / unit]);
    let floor = radius_floor(job.scene, &job.slices);
    let depth = |place: DVec3| (place - eye).dot(camera.forward).clamp(near, far);
    Ok(particles.balls().map(|(place, radius)| (place, radius.max(floor * depth(place)))).collect())
}

/// Layers of slices whose samples a ray may take in one submission.
fn layers_at_once(grid: &HashGrid) -> Result<u32, RenderError> {
    let needed = u64::from(SLICES) * u64::from(grid.largest);
    match ROUNDS / (SLICES * grid.largest.max(1)).max(1) {
        0 if needed > 65_000 => {
            Err(TooLarge { what: "particles near each sample of a ray", needed, limit: 65_000 }.into())
        }
        layers => Ok(layers.max(1)),
    }
}
