//! The particles on the device.

use crate::error::RenderError;
use crate::gpu::{Buffer, Gpu};
use crate::particles::{ParticleSet, Quantity};

/// Arrays over the particles. Vectors of four floats where a shader reads all four.
pub(crate) struct ParticleStore {
    /// High part of the position, and support radius.
    pub high: Buffer,
    /// Low part of the position, and weight V/h³.
    pub low: Buffer,
    pub quantities: Buffer,
    /// Position in view space, and support radius: written by the projection.
    pub projected: Buffer,
    /// Weight for the projected radius.
    pub weights: Buffer,
    particles: u64,
    quantity: u64,
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
        }
    }

    /// Brings the sets to the device where they are not there yet; true if any was copied.
    pub(crate) fn upload(
        &mut self,
        gpu: &Gpu,
        particles: &ParticleSet,
        quantity: &Quantity,
    ) -> Result<bool, RenderError> {
        let count = particles.len() as u64;
        let mut copied = false;
        if self.particles != particles.id() {
            self.particles = 0;
            self.projected.reserve(gpu, count)?;
            self.weights.reserve(gpu, count)?;
            self.high.write(gpu, &particles.high)?;
            self.low.write(gpu, &particles.low)?;
            self.particles = particles.id();
            copied = true;
        }
        if self.quantity != quantity.id() {
            self.quantity = 0;
            self.quantities.write(gpu, &quantity.values)?;
            self.quantity = quantity.id();
            copied = true;
        }
        Ok(copied)
    }

    pub(crate) fn bytes(&self) -> u64 {
        [&self.high, &self.low, &self.quantities, &self.projected, &self.weights]
            .map(Buffer::bytes)
            .iter()
            .sum()
    }
}
