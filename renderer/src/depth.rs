//! How deep lies what is seen in each pixel.

use std::time::Instant;

use crate::error::RenderError;
use crate::picture::{Picture, place};
use crate::plan::{self, Tile};
use crate::renderer::{Progress, Renderer};
use crate::scene::Scene;
use crate::stages::shared::pivot_depth;
use crate::stats::Milliseconds;
use crate::tiles::Job;

/// Opacity below which nothing is seen: far above the least numbers of single precision, at which depths
/// would lose their digits.
const LEAST_OPACITY: f32 = 1e-30;

impl Renderer {
    /// The mean view depth at which the opacity of each pixel arises, Σ T·(1 − t)·z / Σ T·(1 − t) over the
    /// samples of its ray at full sampling: width·height depths in the run's unit of length, between near and
    /// far, row after row from the top; +∞ where nothing is seen. z is measured along the camera's axis.
    ///
    /// Rounding moves them as it moves colours. Measured where the opacity is above 10⁻³: by up to
    /// 10⁻⁶ of themselves in smooth scenes, and by more than 10⁻⁵ in fewer than one pixel in a thousand, where
    /// a sample lies on the very edge of a support or at a step of the transfer function. What is seen far behind
    /// something opaque that is close to the eye may move them by 3·10⁻⁷ of far.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn render_depths(&mut self, scene: &Scene, progress: &mut Progress) -> Result<Vec<f32>, RenderError> {
        let result = self.cast_all_depths(scene, progress);
        if result.is_err() {
            self.forget();
        }
        result
    }

    fn cast_all_depths(&mut self, scene: &Scene, progress: &mut Progress) -> Result<Vec<f32>, RenderError> {
        let mut job = self.begin(scene)?;
        let mut depths = vec![f32::INFINITY; scene.width as usize * scene.height as usize];
        let tiles = plan::tiles(Renderer::bundles(scene), job.slices.count, job.limits);
        // It has no colours.
        let stats = self.stats_before(scene, &job.slices);
        let mut picture = Picture { width: scene.width, height: scene.height, pixels: Vec::new(), stats };
        self.each_tile(
            &mut job,
            tiles,
            progress,
            &mut picture,
            &mut |renderer, job, tile, _, part, picture| {
                let times = &mut picture.stats.milliseconds;
                renderer.cast.prepare(&renderer.gpu, renderer.cast.variant(scene));
                renderer.sum_crowds(job, part, times)?;
                renderer.cast_depths(job, tile, part, times, &mut depths)
            },
        )?;
        Ok(depths)
    }

    /// Casts the depths of `tile`, whose grid and sums over crowds are on the device, and puts them into their
    /// places in a band of the picture.
    pub(crate) fn cast_depths(
        &mut self,
        job: &Job,
        tile: &Tile,
        progress: &mut Progress,
        times: &mut Milliseconds,
        depths: &mut [f32],
    ) -> Result<(), RenderError> {
        self.cast.prepare_depth(&self.gpu, self.cast.variant(job.scene));
        self.cast.reserve_depths(&self.gpu, tile)?;
        let bundles = tile.bundles();
        let stride = self.stride(bundles);
        let mut first = 0;
        while first < bundles {
            if progress(first as f32 / bundles as f32).is_break() {
                return Err(RenderError::Cancelled);
            }
            let begin = Instant::now();
            let end = bundles.min(first + self.pace[0].bundles());
            self.bundles.write_chunk(&self.gpu, first..end, stride, &job.scene.sampling)?;
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            let shared = self.shared_bindings();
            self.timing.pass(&mut encoder, "ray cast", |pass| {
                self.cast.record_depths(&self.gpu, pass, job.scene, &shared, end - first);
            });
            drop(shared);
            self.submit(encoder, times)?;
            self.pace[0].learn(end - first, begin.elapsed());
            first = end;
        }
        self.fetch_depths(job, tile, depths)
    }

    fn fetch_depths(&self, job: &Job, tile: &Tile, depths: &mut [f32]) -> Result<(), RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let sums = self.cast.depths.read_back(&self.gpu, &mut encoder, tile.bundles() * 64);
        self.gpu.queue.submit([encoder.finish()]);
        let sums: Vec<[f32; 4]> = sums.take(&self.gpu)?;
        let (pivot, unit) = (pivot_depth(&job.scene.camera), job.scene.particles.unit());
        place(&tile.higher(job.first_row), job.scene.width, depths, &sums, |[from_pivot, opacity, ..]| {
            match opacity >= LEAST_OPACITY {
                true => (pivot + f64::from(from_pivot) / f64::from(opacity) * unit) as f32,
                false => f32::INFINITY,
            }
        });
        Ok(())
    }
}
