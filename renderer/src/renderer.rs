//! The stages in order, and which of them a change makes stale.

use std::ops::ControlFlow;
use std::time::Instant;

use crate::camera::{BUNDLE_SIDE, Camera, Slices};
use crate::cell_map::CellMap;
use crate::error::RenderError;
use crate::gpu::{Buffer, Gpu, Timing};
use crate::kernel::Kernel;
use crate::pace::Pace;
use crate::picture::Picture;
use crate::plan::{self, Contents, Tile, TileLimits};
use crate::sampling::{BrickWidth, Sampling, Without};
use crate::scene::Scene;
use crate::stages::adapt::Adapt;
use crate::stages::cast::{Cast, Variant};
use crate::stages::grid::Grid;
use crate::stages::order::Order;
use crate::stages::project::Project;
use crate::stages::shared::{
    Bundles, Fields, FrameUniform, ParticleStore, TileUniform, TransferTables, pivot_depth,
};
use crate::stats::{Milliseconds, Stats};
use crate::tiles::{Analysed, Job};
use crate::transfer::TransferFunction;

/// Asks between submissions whether to go on; gets the share done, 0 to 1.
pub type Progress<'a> = dyn FnMut(f32) -> ControlFlow<()> + 'a;

/// Turns scenes into pictures; keeps what the next picture can use again.
///
/// - An unchanged scene costs nothing.
/// - A new tolerance, transfer function or reference length chooses again what to sample, from the
///   same bounds of the quantity, and casts again.
/// - A new kernel, or a new quantity, which is uploaded, is analysed and cast on the same grid. (Where two
///   fields follow one, or one two, the grid is built again.)
/// - A new camera projects and sorts again, without an upload.
///
/// A picture of several tiles builds the grid of each tile anew whatever has changed.
///
/// Particles that do not fit the device as a whole are brought there tile by tile.
pub struct Renderer {
    pub(crate) gpu: Gpu,
    pub(crate) timing: Timing,
    pub(crate) frame: Buffer,
    pub(crate) tile: Buffer,
    pub(crate) store: ParticleStore,
    pub(crate) transfer: TransferTables,
    pub(crate) project: Project,
    pub(crate) grid: Grid,
    pub(crate) order: Order,
    pub(crate) bundles: Bundles,
    pub(crate) adapt: Adapt,
    pub(crate) cast: Cast,
    /// Of full and of adaptive sampling, and of the sums over crowds.
    pub(crate) pace: [Pace; 2],
    pub(crate) crowd_pace: Pace,
    /// What the device holds: projected particles, and the grid of the only tile.
    pub(crate) projected: Option<Geometry>,
    pub(crate) sorted: Option<(Geometry, GridSize)>,
    pub(crate) analysed: Option<Analysed>,
    /// Whether the last tile was sampled as an analysis chose, and not in full.
    pub(crate) adapted: bool,
    /// Of the columns that it chose from.
    pub(crate) column_width: BrickWidth,
    /// Whether the bounds of its cells do not all fit the device, and those of a submission take the place of
    /// those of the one before.
    pub(crate) recycles_bounds: bool,
    /// The tiles of the picture that is made, in the order of casting.
    cast_tiles: Vec<CastTile>,
    last: Option<Last>,
}

/// The last picture, what it is of, and how it came about.
struct Last {
    geometry: Geometry,
    shading: Shading,
    picture: Picture,
    tiles: Vec<CastTile>,
}

/// A tile, and whether it was sampled as an analysis chose, and not in full.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CastTile {
    pub tile: Tile,
    pub adapted: bool,
}

/// How large the grid of a tile is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridSize {
    pub pairs: u64,
    pub cells: u64,
}

/// What the grid depends on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Geometry {
    particles: u64,
    camera: Camera,
    size: [u32; 2],
    rate: f64,
    /// Sums over crowded cells take their room with the grid.
    fields: Fields,
}

/// What, beside the grid, a picture depends on.
#[derive(Clone, Debug, PartialEq)]
struct Shading {
    sampling: Sampling,
    quantity: u64,
    kernel: Kernel,
    transfer: TransferFunction,
    reference_length: f64,
}

impl Renderer {
    /// Builds every pipeline.
    pub fn new(gpu: Gpu) -> Result<Renderer, RenderError> {
        Renderer::with_options(gpu, false)
    }

    /// Like [`Renderer::new`], and counts the evaluations whose weight is above zero, which slows
    /// the casting: for measurements.
    pub fn counting(gpu: Gpu) -> Result<Renderer, RenderError> {
        Renderer::with_options(gpu, true)
    }

    fn with_options(gpu: Gpu, count_inside: bool) -> Result<Renderer, RenderError> {
        let mut renderer = Renderer {
            timing: Timing::new(&gpu)?,
            frame: Buffer::uniform::<FrameUniform>(&gpu, "frame"),
            tile: Buffer::uniform::<TileUniform>(&gpu, "tile"),
            store: ParticleStore::new(&gpu),
            transfer: TransferTables::new(&gpu),
            project: Project::new(&gpu),
            grid: Grid::new(&gpu),
            order: Order::new(&gpu),
            bundles: Bundles::new(&gpu),
            adapt: Adapt::new(&gpu),
            cast: Cast::new(&gpu, count_inside),
            pace: [Pace::new(gpu.is_software()); 2],
            crowd_pace: Pace::new(gpu.is_software()),
            projected: None,
            sorted: None,
            analysed: None,
            adapted: false,
            column_width: BrickWidth::default(),
            recycles_bounds: false,
            cast_tiles: Vec::new(),
            last: None,
            gpu,
        };
        // Waits, since a device that is gone makes pipelines without a word.
        renderer.gpu.wait()?;
        if !renderer.gpu.edits.is_empty() {
            // Their texts may stand in shaders that are made when they are first used.
            let variant = Variant::plain(Kernel::default(), Fields::Two);
            renderer.cast.prepare(&renderer.gpu, variant);
            renderer.cast.prepare_depth(&renderer.gpu, variant);
            renderer.adapt.prepare(
                &renderer.gpu,
                Kernel::default(),
                Without::Nothing,
                Fields::Two,
                BrickWidth::default(),
            );
        }
        if let Some(text) = renderer.gpu.edits.unmade() {
            return Err(RenderError::Device(format!("no shader has the text to be edited: {text}")));
        }
        Ok(renderer)
    }

    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Renders `scene`, no channel of any pixel farther from full sampling than its tolerance. Blocks until the picture is there, and asks `progress`
    /// between submissions, some tens of milliseconds apart, whether to go on.
    pub fn render(&mut self, scene: &Scene, progress: &mut Progress) -> Result<Picture, RenderError> {
        match self.known_picture(scene) {
            Some(picture) => Ok(picture),
            None => self.render_anew(scene, progress, None),
        }
    }

    /// The last picture, where it is of this very scene.
    pub(crate) fn known_picture(&self, scene: &Scene) -> Option<Picture> {
        let mut picture = self.last_of(scene)?.picture.clone();
        picture.stats.milliseconds = Milliseconds::default();
        Some(picture)
    }

    /// Whether the last picture is of this very scene.
    pub(crate) fn knows(&self, scene: &Scene) -> bool {
        self.last_of(scene).is_some()
    }

    fn last_of(&self, scene: &Scene) -> Option<&Last> {
        let of = |last: &&Last| last.geometry == Geometry::of(scene) && last.shading == Shading::of(scene);
        self.last.as_ref().filter(of)
    }

    /// The tiles of the last picture, where it is of this very scene.
    pub(crate) fn tiles_of(&self, scene: &Scene) -> &[CastTile] {
        self.last_of(scene).map_or(&[], |last| &last.tiles)
    }

    /// Renders, and puts what became of the cells into the map that is given.
    pub(crate) fn render_anew(
        &mut self,
        scene: &Scene,
        progress: &mut Progress,
        cells: Option<&mut CellMap>,
    ) -> Result<Picture, RenderError> {
        self.cast_tiles.clear();
        let result = self.render_stale(scene, progress, cells);
        if result.is_err() {
            self.forget();
        }
        let picture = result?;
        let (geometry, shading) = (Geometry::of(scene), Shading::of(scene));
        let tiles = std::mem::take(&mut self.cast_tiles);
        self.last = Some(Last { geometry, shading, picture: picture.clone(), tiles });
        Ok(picture)
    }

    /// Takes nothing on the device for known any more: an interrupted picture leaves what it may.
    pub(crate) fn forget(&mut self) {
        (self.projected, self.sorted, self.analysed) = (None, None, None);
    }

    fn render_stale(
        &mut self,
        scene: &Scene,
        progress: &mut Progress,
        cells_wanted: Option<&mut CellMap>,
    ) -> Result<Picture, RenderError> {
        let begin = Instant::now();
        let mut job = self.begin(scene)?;
        let mut picture = self.blank(scene, &job.slices);
        picture.stats.milliseconds.upload = begin.elapsed().as_secs_f64() * 1e3;

        if scene.sampling.without == Without::CellsAlongRays {
            self.render_by_places(&job, progress, &mut picture)?;
        } else {
            self.render_tiles(&mut job, progress, &mut picture, cells_wanted)?;
        }
        self.sum_up(&mut picture.stats);
        Ok(picture)
    }

    /// Fills in what is known once all tiles are cast.
    pub(crate) fn sum_up(&self, stats: &mut Stats) {
        let milliseconds = &mut stats.milliseconds;
        milliseconds.total =
            milliseconds.upload + milliseconds.grid + milliseconds.analysis + milliseconds.ray_cast;
        stats.gpu_bytes = self.gpu.ledger.peak();
    }

    /// Renders tile by tile.
    fn render_tiles(
        &mut self,
        job: &mut Job,
        progress: &mut Progress,
        picture: &mut Picture,
        mut cells_wanted: Option<&mut CellMap>,
    ) -> Result<(), RenderError> {
        let tiles = plan::tiles(Renderer::bundles(job.scene), job.slices.count, job.limits);
        job.only_tile = job.resident && tiles.len() == 1;
        self.each_tile(job, tiles, progress, picture, &mut |renderer, job, tile, size, progress, picture| {
            renderer.cast_tile(job, tile, size, None, progress, picture)?;
            renderer.cast_tiles.push(CastTile { tile: *tile, adapted: renderer.adapted });
            match &mut cells_wanted {
                Some(map) => renderer.read_tile(tile, map),
                None => Ok(()),
            }
        })
    }

    /// Brings to the device what all tiles share.
    pub(crate) fn begin<'a>(&mut self, scene: &'a Scene) -> Result<Job<'a>, RenderError> {
        self.gpu.ledger.begin();
        let slices = Slices::new(&scene.camera, scene.height, scene.rate);
        let contents = Contents::of(scene);
        let limits = TileLimits::new(self.gpu.binding_limit(), self.gpu.memory, contents);
        self.give_back_above(&limits, contents);
        let geometry = Geometry::of(scene);
        let resident = scene.particles.len() as u64 <= limits.particles;
        if resident && self.store.upload(&self.gpu, &scene.particles, &scene.quantity)? {
            self.forget();
        }
        self.transfer.write(&self.gpu, &scene.transfer)?;
        self.frame.write(&self.gpu, &[FrameUniform::new(scene, &slices, self.store.count())])?;
        self.bundles.write_slices(&self.gpu, &slices, pivot_depth(&scene.camera), scene.particles.unit())?;
        Ok(Job { scene, slices, geometry, limits, resident, only_tile: false, first_row: 0 })
    }

    /// Bundles in x and y.
    pub(crate) fn bundles(scene: &Scene) -> [u32; 2] {
        [scene.width, scene.height].map(|side| side.div_ceil(BUNDLE_SIDE))
    }

    /// A transparent picture, and what is known of it before it is rendered.
    pub(crate) fn blank(&self, scene: &Scene, slices: &Slices) -> Picture {
        let [width, height] = [scene.width, scene.height];
        let pixels = vec![[0.0; 4]; width as usize * height as usize];
        Picture { width, height, pixels, stats: self.stats_before(scene, slices) }
    }

    /// What is known of a picture before it is rendered.
    pub(crate) fn stats_before(&self, scene: &Scene, slices: &Slices) -> Stats {
        let mut rejected = scene.particles.rejected();
        rejected.non_finite += scene.quantity.rejected();
        let bundles = Renderer::bundles(scene).map(u64::from).iter().product();
        Stats {
            adapter: self.gpu.adapter_name().to_owned(),
            backend: self.gpu.backend(),
            particles: scene.particles.len() as u64 - scene.quantity.rejected(),
            rejected,
            near: scene.camera.near,
            far: scene.camera.far,
            slices: slices.count,
            bundles,
            ..Stats::default()
        }
    }
}

impl Geometry {
    fn of(scene: &Scene) -> Geometry {
        Geometry {
            particles: scene.particles.id(),
            camera: scene.camera,
            size: [scene.width, scene.height],
            rate: scene.rate,
            fields: scene.quantity.fields(),
        }
    }
}

impl Shading {
    fn of(scene: &Scene) -> Shading {
        Shading {
            sampling: scene.sampling,
            quantity: scene.quantity.id(),
            kernel: scene.kernel,
            transfer: scene.transfer.clone(),
            reference_length: scene.reference_length,
        }
    }
}
