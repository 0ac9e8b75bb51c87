//! What one picture cost (contract, section 4).

use serde::{Deserialize, Serialize};

use crate::cell_map::CellClass;
use crate::particles::Rejected;
use crate::stages::shared::Counters;

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stats {
    /// Name of the adapter, as its driver gives it.
    pub adapter: String,
    /// Graphics interface: vulkan, metal, dx12 or gl.
    pub backend: String,
    /// Particles kept.
    pub particles: u64,
    pub rejected: Rejected,
    /// View depths where the slices begin and end, in the unit of the run.
    pub near: f64,
    pub far: f64,
    /// N of the contract's section 1.
    pub slices: u64,
    pub bundles: u64,
    /// Cells that hold a particle.
    pub cells: u64,
    /// References of cells to particles.
    pub pairs: u64,
    pub cells_by_class: CellClasses,
    pub evaluations: Evaluations,
    /// Largest budget charged to any bundle; 0 for full sampling.
    pub predicted_error: f64,
    pub milliseconds: Milliseconds,
    /// Peak of the device memory that the renderer holds.
    pub gpu_bytes: u64,
}

impl Stats {
    /// Whether every sample was taken: nothing was allowed to be left out, or finding out would not have paid.
    pub fn is_in_full(&self) -> bool {
        let Evaluations { full, done, bounds, .. } = self.evaluations;
        full + bounds == done
    }

    /// Adds the evaluations of an analysis.
    pub(crate) fn count_bounds(&mut self, counters: &Counters) {
        self.evaluations.done += counters.bounds;
        self.evaluations.bounds += counters.bounds;
    }

    /// Adds what was counted in a tile with `cells` filled cells.
    pub(crate) fn count(&mut self, counters: &Counters, cells: u64, adapted: bool) {
        self.evaluations.done += counters.evaluations;
        self.evaluations.inside += counters.inside;
        self.count_bounds(counters);
        self.predicted_error = self.predicted_error.max(f64::from(counters.largest_charge));
        let classes = &mut self.cells_by_class;
        if !adapted {
            self.evaluations.full += counters.evaluations;
            classes.full += cells;
            return;
        }
        let Counters { full, mixed, super_pixel, transparent, z_adaptive, .. } = *counters;
        classes.full += full;
        classes.mixed += mixed;
        classes.super_pixel += super_pixel;
        classes.transparent += transparent;
        classes.z_adaptive.iter_mut().zip(z_adaptive).for_each(|(sum, count)| *sum += count);
        classes.occluded += cells.saturating_sub(counters.cells());
    }
}

/// Numbers of cells that hold particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct CellClasses {
    /// Sampled wherever anything is to be seen that is not exactly alike.
    pub full: u64,
    /// Sampled in some bricks, and shown by one colour each in the others.
    pub mixed: u64,
    /// Sampling levels 1 to 4.
    pub z_adaptive: [u64; 4],
    /// Shown without a sample.
    pub super_pixel: u64,
    /// With nothing to be seen in them.
    pub transparent: u64,
    /// Behind what lets no light through that the tolerance would notice.
    pub occluded: u64,
}

impl CellClasses {
    /// Cells of one class.
    pub fn count(mut self, class: CellClass) -> u64 {
        *self.of(class)
    }

    pub(crate) fn add(&mut self, class: CellClass) {
        *self.of(class) += 1;
    }

    fn of(&mut self, class: CellClass) -> &mut u64 {
        match class {
            CellClass::Full => &mut self.full,
            CellClass::Mixed => &mut self.mixed,
            CellClass::ZAdaptive(level) => &mut self.z_adaptive[usize::from(level.clamp(1, 4)) - 1],
            CellClass::SuperPixel => &mut self.super_pixel,
            CellClass::Transparent => &mut self.transparent,
            CellClass::Occluded => &mut self.occluded,
        }
    }
}

/// Kernel weights computed for one particle at one place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Evaluations {
    /// What full sampling of the same view computes; 0 for an adaptive picture, which does not know.
    pub full: u64,
    /// What this picture computed, the analysis counted in.
    pub done: u64,
    /// The part of the analysis, which computes a weight of a particle for each brick of the columns that it
    /// meets.
    #[serde(skip_serializing_if = "is_zero")]
    pub bounds: u64,
    /// Those of `done` with a weight above zero; 0 unless the renderer counts them.
    #[serde(skip_serializing_if = "is_zero")]
    pub inside: u64,
}

/// Device time where the adapter has timestamps, else host time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Milliseconds {
    /// From the file; filled in by whoever read it.
    pub read: f64,
    pub upload: f64,
    pub grid: f64,
    pub analysis: f64,
    pub merge: f64,
    pub ray_cast: f64,
    pub total: f64,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}
