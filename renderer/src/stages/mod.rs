//! The stages between particles and picture. Each is a struct that builds its pipelines once and
//! then records its work; its shader stands beside it.

pub(crate) mod adapt;
pub(crate) mod cast;
#[cfg(test)]
mod found;
pub(crate) mod grid;
#[cfg(test)]
mod layout;
pub(crate) mod object_space;
pub(crate) mod order;
pub(crate) mod project;
pub(crate) mod scan;
pub(crate) mod shared;
