//! Asking the picture: what is seen at a place, which particle is there, how a bundle was sampled, and how
//! far the picture is from full sampling.

pub mod measurement;
pub mod pointer;
pub mod pointing;
pub mod probe;
pub mod tracked;
