//! What one picture cost (contract, section 4).

use serde::{Deserialize, Serialize};

use crate::particles::Rejected;

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

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellClasses {
    pub full: u64,
    /// Sampling levels 1 to 4.
    pub z_adaptive: [u64; 4],
    pub super_pixel: u64,
    pub transparent: u64,
    pub occluded: u64,
}

/// Kernel weights computed for one particle at one place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Evaluations {
    /// What full sampling of the same view computes.
    pub full: u64,
    /// What this picture computed.
    pub done: u64,
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
