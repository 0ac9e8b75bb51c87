//! A GPU ray caster for unstructured, dynamic particle sets.
//!
//! It shows the particles of an SPH run themselves: nothing is resampled, and nothing is computed
//! ahead of time, so that every frame of a run costs the same. The method is that of Hochstetter,
//! Orthmann and Kolb, *Adaptive Sampling for On-The-Fly Ray Casting of Particle-based Fluids* (HPG
//! 2016), with bounds of our own: a picture's error against full sampling is below the tolerance.
//!
//! # From particles to a picture
//!
//! A [`ParticleSet`] and a [`Quantity`] over it, made once a frame on the host in f64, and a [`View`],
//! which is everything else that defines a picture, make a [`Scene`]. [`Renderer::render`] turns a
//! scene into a [`Picture`] in stages, each with its shader beside it in `stages/`:
//!
//! 1. **project** brings the particles into view space.
//! 2. **grid** sorts them into cells of 8 × 8 pixels × 16 slices, aligned with the rays: it counts the
//!    particles of every cell, **scan** turns counts into places, and the particles go to their places;
//!    **order** gives those of each cell an order that does not change from run to run.
//! 3. **adapt** bounds the quantity in the bricks of each cell, and chooses those that may be shown by
//!    one colour: as many as the tolerance of the view pays for.
//! 4. **cast** samples what is left. The particles of a cell are read once for all its rays; each is
//!    evaluated only at samples inside its support.
//!
//! `plan` cuts a picture that does not fit the device into tiles, which `tile_by_tile` goes through; `tiles`
//! takes one tile through the stages; `bands` hands over rows of a picture that does not fit the host;
//! `renderer` knows which stages a change makes stale, and skips the others. On demand, `depth` tells how deep
//! lies what is seen, and `read_cells` reads back what became of each cell ([`CellMap`], [`BundleDetail`]).
//!
//! # Two fields
//!
//! A [`Quantity`] may hold two fields, one for the colour of samples and one for their opacity. The shaders
//! are written for either: the files in `stages/shared/fields/` say what a quantity, its sums and its bounds
//! are, once for one field and once for two, and those for one field know nothing of a second. Both fields
//! are bounded in every brick, and the bricks' colours are those over the bounds of the one, their opacities
//! those over the bounds of the other: so the tolerance holds for two fields as for one.
//!
//! # Depth
//!
//! [`Renderer::render_depths`], and [`Renderer::render_bands`] beside the colours, tell for each pixel how deep
//! lies what is seen there: the mean view depth at which its opacity arises, Σ T·(1 − t)·z / Σ T·(1 − t) over
//! the samples of its ray, with z the view depth of a sample (along the camera's axis, not along the ray), t
//! what light passes it, and T what passes all before it. At a surface that is the depth of the surface; in a
//! cloud, of the middle of what is seen of it. It is +∞ where nothing is seen. Depths are always those of
//! full sampling, whatever the tolerance of the colours: the same shaders composite them in place of colours
//! (`cast/depth.wgsl`).
//!
//! # Numbers
//!
//! Positions reach the device as two f32 each, in a unit close to the support radius. Before anything
//! else happens to them, they are taken relative to a pivot on the camera's axis: amid the particles
//! for a long lens, close to the eye for a camera among them. Distances inside a cell are taken
//! relative to the cell. So neither the unit of the run, nor its place in the world, nor a camera far
//! away or deep inside costs precision.

mod bands;
#[doc(hidden)]
pub mod bench;
mod by_places;
mod camera;
mod cell_map;
mod colour_map;
pub mod colour_space;
mod crowds;
mod cut;
mod depth;
mod error;
mod gpu;
mod inspect;
mod kernel;
mod memory;
mod opacity;
mod pace;
mod particles;
mod picture;
mod pilot;
mod placement;
mod plan;
#[cfg(test)]
mod random;
mod ray;
mod read_cells;
mod renderer;
mod sampling;
mod scene;
mod selection;
mod stages;
mod stats;
mod tile_by_tile;
mod tiles;
mod transfer;
mod view;

pub use bands::{Band, BandLayers, BandTaker};
pub use camera::{BUNDLE_SIDE, CELL_SLICES, Camera, Slices};
pub use cell_map::{
    Brick, BrickMask, BundleCells, BundleDetail, COLUMN_BRICKS, COLUMNS, CellBricks, CellClass, CellDetail,
    CellMap, FieldInBrick, KnownValues, MapCell, Slope, bundle_of, column_of,
};
pub use colour_map::{ColourMap, MapKind};
pub use error::{GpuError, RenderError, TooLarge};
pub use gpu::{Gpu, GpuOptions};
pub use inspect::GridCell;
pub use kernel::Kernel;
pub use particles::{Bounds, Extent, ParticleSet, Quantity, RawParticle, Rejected};
pub use picture::Picture;
pub use placement::{Placement, Scale, Spread};
pub use ray::{Glance, Met, Sight};
pub use renderer::{Progress, Renderer};
pub use sampling::{Bound, BrickWidth, Sampling, Without};
pub use scene::{Scene, default_reference_length};
pub use stats::{CellClasses, Evaluations, Milliseconds, Stats};
pub use transfer::{ColourPoint, ControlPoint, TransferFunction};
pub use view::{
    AnnotationsView, Bookmark, CameraView, ClipBox, ClipPlane, Filter, ImageView, Ink, Keyframe, MapView,
    OpacityView, OutsideView, ParticleView, PathView, QuantityView, SamplingView, SelectView, TransferView,
    View, ViewError,
};
