//! A picture in bands of rows: for one that the host should not hold as a whole.

use std::ops::ControlFlow;
use std::time::Instant;

use crate::camera::BUNDLE_SIDE;
use crate::cell_map::COLUMNS;
use crate::error::RenderError;
use crate::picture::{Picture, lane_of};
use crate::plan::{self, Tile};
use crate::renderer::{Progress, Renderer};
use crate::scene::Scene;
use crate::stages::adapt::entries::BundleEntry;
use crate::stats::Stats;
use crate::tiles::Job;

/// Rows of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// The row of the picture that is the first of the band.
    pub first_row: u32,
    /// Premultiplied linear RGBA, row after row, each as wide as the picture.
    pub pixels: Vec<[f32; 4]>,
    /// For each pixel what is charged to its ray, where that was asked for: its error is not larger, but for
    /// rounding. 0 where it was sampled in full.
    pub charged: Option<Vec<f32>>,
    /// For each pixel the mean view depth at which its opacity arises, where that was asked for: that of
    /// [`Renderer::render_depths`].
    pub depths: Option<Vec<f32>>,
}

/// What is asked for each pixel beside its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BandLayers {
    pub charges: bool,
    /// They take a pass of full sampling more, whose time counts for the picture, and whose evaluations do
    /// not.
    pub depths: bool,
}

/// Takes the bands from top to bottom, and says whether to go on.
pub type BandTaker<'a> = dyn FnMut(Band) -> ControlFlow<()> + 'a;

impl Renderer {
    /// Like [`Renderer::render`], and hands the picture over in bands of `rows` rows, rounded up to whole
    /// bundles. Keeps nothing of it for the next picture.
    ///
    /// # Errors
    /// As for [`Renderer::render`]; cancelled where `take` does not go on.
    pub fn render_bands(
        &mut self,
        scene: &Scene,
        rows: u32,
        layers: BandLayers,
        progress: &mut Progress,
        take: &mut BandTaker,
    ) -> Result<Stats, RenderError> {
        let result = self.cast_bands(scene, rows, layers, progress, take);
        if result.is_err() {
            self.forget();
        }
        result
    }

    fn cast_bands(
        &mut self,
        scene: &Scene,
        rows: u32,
        layers: BandLayers,
        progress: &mut Progress,
        take: &mut BandTaker,
    ) -> Result<Stats, RenderError> {
        let begin = Instant::now();
        let mut job = self.begin(scene)?;
        if layers.depths {
            job.limits = job.limits.with_depths();
        }
        let [across, down] = Renderer::bundles(scene);
        let high = rows.div_ceil(BUNDLE_SIDE).clamp(1, down);
        let mut stats = self.stats_before(scene, &job.slices);
        stats.milliseconds.upload = begin.elapsed().as_secs_f64() * 1e3;
        for first in (0..down).step_by(high as usize) {
            job.first_row = first;
            let count = [across, high.min(down - first)];
            let mut part = |share: f32| progress((first as f32 + share * count[1] as f32) / down as f32);
            let (band, after) = self.cast_band(&mut job, count, stats, layers, &mut part)?;
            stats = after;
            if take(band).is_break() {
                return Err(RenderError::Cancelled);
            }
        }
        self.sum_up(&mut stats);
        Ok(stats)
    }

    /// Casts the band of `count` bundles, and adds what it cost to `stats`.
    fn cast_band(
        &mut self,
        job: &mut Job,
        count: [u32; 2],
        stats: Stats,
        layers: BandLayers,
        progress: &mut Progress,
    ) -> Result<(Band, Stats), RenderError> {
        let (width, first_row) = (job.scene.width, job.first_row * BUNDLE_SIDE);
        let height = (count[1] * BUNDLE_SIDE).min(job.scene.height - first_row);
        let size = width as usize * height as usize;
        let mut picture = Picture { width, height, pixels: vec![[0.0; 4]; size], stats };
        let mut charged = layers.charges.then(|| vec![0.0; size]);
        let mut depths = layers.depths.then(|| vec![f32::INFINITY; size]);
        // The share of colours in the work.
        let colours = if layers.depths { 0.5 } else { 1.0 };

        let tiles = plan::tiles(count, job.slices.count, job.limits);
        let tiles = tiles.into_iter().map(|tile| tile.lower(job.first_row)).collect();
        self.each_tile(
            job,
            tiles,
            progress,
            &mut picture,
            &mut |renderer, job, tile, grid, part, picture| {
                renderer.cast_tile(job, tile, grid, None, &mut |share| part(colours * share), picture)?;
                if let Some(charged) = &mut charged
                    && renderer.adapted
                {
                    renderer.read_charges(tile, job.first_row, width, charged)?;
                }
                if let Some(depths) = &mut depths {
                    let mut part = |share: f32| part(colours + (1.0 - colours) * share);
                    renderer.cast_depths(job, tile, &mut part, &mut picture.stats.milliseconds, depths)?;
                }
                Ok(())
            },
        )?;
        Ok((Band { first_row, pixels: picture.pixels, charged, depths }, picture.stats))
    }

    /// Puts what is charged to the rays of `tile`, which is on the device, into the pixels of a band.
    fn read_charges(
        &self,
        tile: &Tile,
        first_row: u32,
        width: u32,
        charged: &mut [f32],
    ) -> Result<(), RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let entries = self.adapt.bundle_entries.read_back(&self.gpu, &mut encoder, tile.bundles());
        self.gpu.queue.submit([encoder.finish()]);
        let entries: Vec<BundleEntry> = entries.take(&self.gpu)?;
        let tile = tile.higher(first_row);
        let side = BUNDLE_SIDE as usize;
        for (index, entry) in entries.iter().enumerate() {
            let [left, top] = tile.place_of(index as u64).map(|place| place as usize * side);
            let rows = charged.chunks_mut(width as usize).skip(top).take(side);
            for (y, row) in rows.enumerate() {
                for (x, pixel) in row.iter_mut().skip(left).take(side).enumerate() {
                    *pixel = entry.charged[lane_of(x, y) * COLUMNS / (side * side)];
                }
            }
        }
        Ok(())
    }
}
