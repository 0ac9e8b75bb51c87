//! Ray casting (HPG 2016, Alg. 2): at full sampling, or as `adapt` chose.
//!
//! At full sampling a workgroup takes a bundle through its cells. Adaptively, the cells that are to be
//! sampled are work of their own, independent of each other, so that a workgroup does one thing: it
//! samples a cell as a whole, or some of its bricks, or more coarsely along the rays, or it lets bricks
//! follow their slopes. Then the cells of a bundle are put together.

mod crowds;
mod samplers;

use std::collections::BTreeMap;

pub(crate) use crowds::{CROWD, Crowds, portions};

use super::adapt::Adapt;
use super::shared::Fields;
use crate::error::RenderError;
use crate::gpu::{Buffer, Gpu, Pipeline, Room};
use crate::kernel::Kernel;
use crate::plan::{Tile, TileLimits};
use crate::sampling::{Bound, BrickWidth};
use crate::scene::Scene;
pub(crate) use samplers::Variant;
use samplers::{Samplers, Shaders};

pub(crate) struct Cast {
    shaders: Shaders,
    /// Plain ones for each kernel and one field; others once a scene needed them.
    samplers: BTreeMap<Variant, Samplers>,
    /// What casts depths in place of colours, once that was asked for.
    depth: BTreeMap<Variant, Pipeline>,
    /// One a kernel. The paper's bound, whose cells it samples, knows one field.
    coarse: Vec<Pipeline>,
    /// One for each width of bricks.
    composite: [Pipeline; 2],
    pub crowds: Crowds,
    /// Premultiplied linear RGB and transparency, 64 pixels a bundle.
    pub pixels: Buffer,
    /// What `depth.wgsl` has of each pixel in the same places.
    pub depths: Buffer,
    /// Colour and opacity of each ray in a sampled cell, 64 a cell.
    segments: Buffer,
}

/// How many cells of a submission `adapt` left to be cast.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    /// Cells to be sampled as a whole, and in parts or at a coarser level.
    pub wholes: u64,
    pub parts: u64,
    /// Those of which nothing is to be sampled, though some bricks follow slopes.
    pub sloped: u64,
}

impl Work {
    fn cells(self) -> u64 {
        self.wholes + self.parts + self.sloped
    }
}

impl Cast {
    /// `count_inside`: count evaluations with a weight above zero too, which costs time.
    pub(crate) fn new(gpu: &Gpu, count_inside: bool) -> Cast {
        let shaders = Shaders { count_inside };
        let one_field = |kernel: Kernel| {
            let variant = Variant::plain(kernel, Fields::One);
            (variant, shaders.samplers(gpu, variant))
        };
        Cast {
            samplers: Kernel::ALL.map(one_field).into(),
            coarse: Kernel::ALL.map(|kernel| shaders.coarse(gpu, kernel)).into(),
            composite: BrickWidth::ALL.map(|width| shaders.composite(gpu, width)),
            depth: BTreeMap::new(),
            shaders,
            crowds: Crowds::new(gpu),
            pixels: Buffer::storage(gpu, "pixels", 16),
            depths: Buffer::storage(gpu, "depths of pixels", 16),
            segments: Buffer::storage(gpu, "segments of rays", 16),
        }
    }

    /// Makes room for the pixels of `tile`.
    pub(crate) fn reserve(&mut self, gpu: &Gpu, tile: &Tile) -> Result<(), RenderError> {
        self.pixels.reserve(gpu, tile.bundles() * 64)
    }

    /// Makes room for what `work` leaves.
    pub(crate) fn reserve_segments(&mut self, gpu: &Gpu, work: Work) -> Result<(), RenderError> {
        self.segments.reserve(gpu, work.cells() * 64)
    }

    /// What `scene` needs of the shaders, with the crowds that were found in the tile.
    pub(crate) fn variant(&self, scene: &Scene) -> Variant {
        Variant::of(scene, self.crowds.count() > 0)
    }

    pub(crate) fn prepare(&mut self, gpu: &Gpu, variant: Variant) {
        let shaders = &self.shaders;
        self.samplers.entry(variant).or_insert_with(|| shaders.samplers(gpu, variant));
    }

    pub(crate) fn prepare_depth(&mut self, gpu: &Gpu, variant: Variant) {
        let shaders = &self.shaders;
        self.depth.entry(variant).or_insert_with(|| shaders.depth(gpu, variant));
    }

    /// Makes room for the depths of `tile`.
    pub(crate) fn reserve_depths(&mut self, gpu: &Gpu, tile: &Tile) -> Result<(), RenderError> {
        self.depths.reserve(gpu, tile.bundles() * 64)
    }

    /// Those for `scene`, which are prepared.
    fn samplers(&self, scene: &Scene) -> &Samplers {
        &self.samplers[&self.variant(scene)]
    }

    /// Records the sums over `portions` portions of crowded cells. `shared`: resources for
    /// [`BUNDLE_BINDINGS`](super::shared::BUNDLE_BINDINGS), whose turns are portions here.
    pub(crate) fn record_portions(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        scene: &Scene,
        shared: &[wgpu::BindingResource],
        portions: u64,
    ) {
        let resources = with(shared, &self.crowds.buffers());
        self.samplers(scene).portions.dispatch(gpu, pass, &resources, portions);
    }

    /// Records full sampling of `bundles` bundles. `shared`: resources for
    /// [`BUNDLE_BINDINGS`](super::shared::BUNDLE_BINDINGS).
    pub(crate) fn record_full(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        scene: &Scene,
        shared: &[wgpu::BindingResource],
        bundles: u64,
    ) {
        let [portions, sums] = self.crowds.buffers();
        let resources = with(shared, &[portions, sums, &self.pixels]);
        self.samplers(scene).full.dispatch(gpu, pass, &resources, bundles);
    }

    /// Records full sampling of the depths of `bundles` bundles, for which all is prepared. `shared`: resources
    /// for [`BUNDLE_BINDINGS`](super::shared::BUNDLE_BINDINGS).
    pub(crate) fn record_depths(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        scene: &Scene,
        shared: &[wgpu::BindingResource],
        bundles: u64,
    ) {
        let [portions, sums] = self.crowds.buffers();
        let resources = with(shared, &[portions, sums, &self.depths]);
        let pipeline = &self.depth[&self.variant(scene)];
        pipeline.dispatch(gpu, pass, &resources, bundles);
    }

    /// Records the sampling of what `adapt` left of `bundles` bundles, and puts their cells together.
    #[expect(clippy::too_many_arguments, reason = "one for each thing the shaders read")]
    pub(crate) fn record_adaptive(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass,
        scene: &Scene,
        shared: &[wgpu::BindingResource],
        adapt: &Adapt,
        work: Work,
        bundles: u64,
    ) {
        let samplers = self.samplers(scene);
        // What is not sampled as a whole is bricks, or all of a cell at a coarser level.
        let parts = match scene.sampling.bound {
            Bound::Difference => &samplers.parts,
            Bound::Paper => &self.coarse[scene.kernel.code() as usize],
        };
        let (segments, values) = (&self.segments, &adapt.cell_values);
        let [portions, sums] = self.crowds.buffers();
        let own = [portions, sums, segments, &adapt.work, &adapt.tasks, values, &adapt.bricks, &adapt.offers];
        let resources = with(shared, &own);
        samplers.wholes.dispatch(gpu, pass, &resources, work.wholes);
        parts.dispatch(gpu, pass, &resources, work.parts);
        samplers.slopes.dispatch(gpu, pass, &resources, work.sloped);
        let cells = with(
            shared,
            &[&self.pixels, segments, &adapt.sampled, &adapt.bundle_entries, values, &adapt.shows],
        );
        self.composite[scene.sampling.column_width() as usize].dispatch(gpu, pass, &cells, bundles);
    }

    /// The buffers, and the most elements of each under `limits`.
    pub(crate) fn rooms(&mut self, limits: &TileLimits, fields: Fields) -> Vec<Room<'_>> {
        let mut rooms = vec![
            (&mut self.pixels, limits.bundles * 64),
            (&mut self.depths, limits.bundles_with_depths() * 64),
            (&mut self.segments, limits.filled_cells * 64),
        ];
        rooms.extend(self.crowds.rooms(limits, fields));
        rooms
    }
}

/// Resources of a shader: the shared ones, then its own.
fn with<'a>(shared: &[wgpu::BindingResource<'a>], own: &[&'a Buffer]) -> Vec<wgpu::BindingResource<'a>> {
    shared.iter().cloned().chain(own.iter().map(|buffer| buffer.binding())).collect()
}
