//! Whether an analysis pays. What it costs is much the same for all scenes, what it saves is not; so a few
//! bundles from all over a tile are analysed first, and their cells tell.
//!
//! Counts decide, and no clock, so that the same scene always gives the same picture.

use crate::error::RenderError;
use crate::picture::Picture;
use crate::plan::Tile;
use crate::renderer::{Progress, Renderer};
use crate::sampling::BrickWidth;
use crate::stages::shared::{Counters, spread};
use crate::tiles::Job;

/// Bundles of a pilot: one in so many, and no more than so many. What is smaller than the least pilot is
/// analysed in any case.
const ONE_IN: u64 = 64;
const MOST: u64 = 1024;
const LEAST: u64 = 8;

/// The share of cells that may be left to be sampled. A GPU passes by what a lane does not do, so there an analysis
/// costs less than on a software adapter; how much less has not been measured.
const MOST_LEFT: f64 = 0.8;

/// The same on a software adapter, for bundles of so many cells. There an analysis costs 0.5 to 1.4 of full sampling's
/// ray cast with bricks of 2 × 2 rays, measured on lattices, a mixer, a dam break and a checker board. With those of
/// 4 × 4 rays it is a third of it where a bundle has ten cells or more, and 0.7 where it has five: it takes as long for
/// a few of them as for sixteen.
fn most_left_on_software(width: BrickWidth, cells: f64) -> f64 {
    match width {
        BrickWidth::Two => 0.16,
        BrickWidth::Four => 0.55 - 3.0 / cells.max(1.0),
    }
}

/// How many bundles of a tile are looked at first; `None` where that is not worth it.
fn pilot_of(bundles: u64) -> Option<u64> {
    let count = (bundles / ONE_IN).min(MOST);
    (count >= LEAST).then_some(count)
}

/// The share of the cells looked at that are left to be sampled; coarser levels take fewer samples.
fn share_left(counters: &Counters) -> f64 {
    let levels = (1..).zip(counters.z_adaptive).map(|(level, count)| count as f64 * 0.5_f64.powi(level));
    let left = (counters.full + counters.mixed) as f64 + levels.sum::<f64>();
    left / counters.cells().max(1) as f64
}

impl Renderer {
    /// Analyses some bundles of `tile`, for whose analysis all is prepared. Bounds that it finds stay, where there
    /// is room for those of the whole tile.
    pub(crate) fn analysis_pays(
        &mut self,
        job: &Job,
        tile: &Tile,
        progress: &mut Progress,
        picture: &mut Picture,
    ) -> Result<bool, RenderError> {
        let bundles = tile.bundles();
        let Some(count) = pilot_of(bundles).filter(|_| !job.scene.sampling.always_adaptive) else {
            return Ok(true);
        };
        self.clear_counters();
        let mut first = 0;
        while first < count {
            if progress(0.0).is_break() {
                return Err(RenderError::Cancelled);
            }
            let end = count.min(first + self.adaptive_chunk(job, tile));
            self.bundles.write_chunk(&self.gpu, first..end, spread(bundles), &job.scene.sampling)?;
            self.analyse(job.scene, end - first, &mut picture.stats.milliseconds)?;
            first = end;
        }
        if self.recycles_bounds {
            self.forget_bounds();
        }
        let counters = self.bundles.read_counters(&self.gpu)?;
        picture.stats.count_bounds(&counters);
        let cells = counters.cells() as f64 / count as f64;
        let most = match self.gpu.is_software() {
            true => most_left_on_software(job.scene.sampling.column_width(), cells),
            false => MOST_LEFT,
        };
        Ok(share_left(&counters) <= most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_have_no_pilot_and_large_ones_a_short_one() {
        let counts = [511, 512, 4096, 32_768, 4_000_000].map(pilot_of);
        assert_eq!(counts, [None, Some(8), Some(64), Some(512), Some(1024)]);
    }

    #[test]
    fn what_is_left_is_a_share_of_all_cells_looked_at() {
        let counters =
            Counters { full: 10, mixed: 20, super_pixel: 60, transparent: 10, ..Counters::default() };
        assert_eq!(share_left(&counters), 0.3);
        let levels = Counters { z_adaptive: [4, 0, 0, 16], super_pixel: 80, ..Counters::default() };
        assert_eq!(share_left(&levels), 0.03);
        assert_eq!(share_left(&Counters::default()), 0.0);
    }

    #[test]
    fn bundles_of_few_cells_have_to_save_more() {
        let four = [2.0, 6.0, 12.0, 24.0].map(|cells| most_left_on_software(BrickWidth::Four, cells));
        assert!(four.is_sorted() && four[0] < 0.0 && four[3] < 0.5, "{four:?}");
    }
}
