//! Numbers about the particles of a run: how a quantity is distributed, its extremes over all frames, and
//! what the particles in view have in common.

pub mod distribution;
pub mod field_ranges;
pub mod histogram;
pub mod pool;
pub mod statistics;
pub mod survey;
