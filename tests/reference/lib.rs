//! The f64 twin of the renderer: what a picture is by the contract's section 1, and nothing else.
//!
//! Written for reading, from the formulas alone: it shares no arithmetic with the `renderer` crate,
//! only the plain numbers of a [`renderer::View`]. Where the two disagree, one of them is wrong.
//!
//! | module | contract |
//! | --- | --- |
//! | [`kernels`] | W(r, h) |
//! | [`camera`] | the ray of a pixel |
//! | [`slices`] | N, s(i), layers of 16 slabs |
//! | [`quantity`] | Q(x) and its range; [`neighbours`] finds the particles that reach x |
//! | [`transfer`] | colour and opacity of u |
//! | [`composite`] | front to back, with corrected path lengths |
//! | [`depth`] | how deep lies what is seen |
//! | [`setup`] | all settings of one picture |
//! | [`picture`] | all of it together, pixel by pixel |
//! | [`bricks`] | u, and what light passes, in bricks of 2 × 2 rays × 4 slabs |
//! | [`grid`] | which cells of the view-aligned grid a particle reaches |
//! | [`floor`] | the one documented deviation: the sub-pixel floor of the support radius |
//!
//! Besides the twin: [`compare`] tells two pictures apart, [`margins`] says how near a ray comes to a
//! jump of the picture, [`scenes`] makes random scenes from a seed ([`random`]) and [`extremes`] those at
//! the end of what makes sense, [`device`] renders them on the machine's adapter, and [`guarantee`]
//! tries whether adaptive sampling keeps its tolerance.

pub mod bricks;
pub mod camera;
pub mod compare;
pub mod composite;
pub mod depth;
pub mod device;
pub mod extremes;
pub mod floor;
pub mod grid;
pub mod guarantee;
pub mod kernels;
pub mod margins;
pub mod neighbours;
pub mod particle;
pub mod picture;
pub mod quantity;
pub mod random;
pub mod scenes;
pub mod setup;
pub mod slices;
pub mod transfer;

pub use particle::Particle;
