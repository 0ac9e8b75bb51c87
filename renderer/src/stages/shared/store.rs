//! The particles on the device.

use rayon::prelude::*;

use crate::error::RenderError;
use crate::gpu::{Buffer, Gpu, Room};
use crate::particles::{ParticleSet, Quantity};
use crate::plan::TileLimits;
use crate::stages::shared::Fields;

/// Arrays over the particles. Vectors of four floats where a shader reads all four.
pub struct ParticleStore {
    /// High part of the position, and support radius.
    pub high: Buffer,
    /// Low part of the position, and cube root of the weight V/h³.
    pub low: Buffer,
    /// One number a particle, or two (`fields/`).
    pub quantities: Buffer,
    /// Position in view space, and support radius: written by the projection.
    pub projected: Buffer,
    /// Weight for the projected radius.
    pub weights: Buffer,
    /// Which sets are here as a whole, by their ids; 0 for none.
    particles: u64,
    quantity: u64,
    count: u64,
}

impl ParticleStore {
    pub(crate) fn new(gpu: &Gpu) -> ParticleStore {
        ParticleStore {
            high: Buffer::storage(gpu, "particle positions", 16),
            low: Buffer::storage(gpu, "particle positions, low part", 16),
            quantities: Buffer::storage(gpu, "particle quantities", 4),
            projected: Buffer::storage(gpu, "projected particles", 16),
            weights: Buffer::storage(gpu, "particle weights", 4),
            particles: 0,
            quantity: 0,
            count: 0,
        }
    }

    /// Brings the sets to the device where they are not there yet; true if that moved particles.
    pub(crate) fn upload(
        &mut self,
        gpu: &Gpu,
        particles: &ParticleSet,
        quantity: &Quantity,
    ) -> Result<bool, RenderError> {
        let count = particles.len() as u64;
        let moved = self.particles != particles.id();
        if moved {
            self.particles = 0;
            self.projected.reserve(gpu, count)?;
            self.weights.reserve(gpu, count)?;
            self.high.write(gpu, &particles.high)?;
            self.low.write(gpu, &particles.low)?;
            (self.particles, self.count) = (particles.id(), count);
        }
        if self.quantity != quantity.id() {
            self.quantity = 0;
            self.quantities.write(gpu, &quantity.values)?;
            self.quantity = quantity.id();
        }
        Ok(moved)
    }

    /// Brings only the particles with the indices `chosen` to the device, in that order.
    pub(crate) fn upload_some(
        &mut self,
        gpu: &Gpu,
        particles: &ParticleSet,
        quantity: &Quantity,
        chosen: &[u32],
    ) -> Result<(), RenderError> {
        self.forget();
        self.count = chosen.len() as u64;
        self.projected.reserve(gpu, self.count)?;
        self.weights.reserve(gpu, self.count)?;
        self.high.write(gpu, &gather(&particles.high, chosen))?;
        self.low.write(gpu, &gather(&particles.low, chosen))?;
        self.quantities.write(gpu, &quantity.gather(chosen))
    }

    /// Number of particles on the device.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The buffers, and the most elements of each under `limits`.
    pub(crate) fn rooms(&mut self, limits: &TileLimits, fields: Fields) -> [Room<'_>; 5] {
        let most = limits.particles;
        [
            (&mut self.high, most),
            (&mut self.low, most),
            (&mut self.projected, most),
            (&mut self.weights, most),
            (&mut self.quantities, most * fields.count()),
        ]
    }

    /// Takes nothing on the device for known any more.
    pub(crate) fn forget(&mut self) {
        (self.particles, self.quantity) = (0, 0);
    }
}

fn gather<T: Copy + Send + Sync>(values: &[T], chosen: &[u32]) -> Vec<T> {
    chosen.par_iter().map(|&index| values[index as usize]).collect()
}
