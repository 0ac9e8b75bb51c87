// What a whole picture shares (stages/shared/frame.rs holds the same layout). Lengths in device units.
//
// Busy loops of all shaders are left at their end, not at their head: software adapters, which mask lanes where others
// branch, go through a body once more than its head lets them.

struct Frame {
    right: vec3<f32>,
    // Slope between neighbouring pixel centres: 2·tan(σ/2)/H.
    pitch: f32,
    up: vec3<f32>,
    near: f32,
    forward: vec3<f32>,
    far: f32,
    // The pivot, a point on the camera's axis, is the sum of the two. Positions in view space are
    // relative to it: for a long lens it lies among the particles, far from the eye.
    pivot_high: vec3<f32>,
    // ln(far/near)/N.
    log_step: f32,
    pivot_low: vec3<f32>,
    // Smallest support radius, in units of view depth, that cannot fall between samples.
    radius_floor: f32,
    // Pixels.
    size: vec2<u32>,
    particle_count: u32,
    // Device length over reference length.
    path_scale: f32,
    // Depth of the pivot; near and far relative to it.
    pivot_depth: f32,
    near_offset: f32,
    far_offset: f32,
    // Fields on a logarithmic scale: bit 0 for that of the colour, bit 1 for that of the opacity.
    logarithmic: u32,
    // Depth of the cell's 16 samples relative to its middle, in units of the middle's depth.
    sample_offset: array<vec4<f32>, 4>,
    // Depth of the cell's 16 slabs, in units of the depth of the cell's middle.
    slab_depth: array<vec4<f32>, 4>,
    // Depth of the 17 edges of these slabs, and of three more behind, relative to the middle like the
    // samples: samples of coarser levels lie on edges.
    slab_edge: array<vec4<f32>, 5>,
}

// A box of cells that is built and cast at once.
struct Tile {
    // First bundle, and number of bundles, in x and y.
    first: vec2<u32>,
    count: vec2<u32>,
    // First layer of cells along the rays, and number of layers.
    first_layer: u32,
    layers: u32,
    // How many references the pair buffer holds.
    pair_capacity: u32,
    // How many portions its crowded cells make.
    portions: u32,
}

const BUNDLE_SIDE: u32 = 8u;
const CELL_SLICES: f32 = 16.0;
// A cell with more references is crowded: it is summed ahead, in portions of this many (cast/crowds.wgsl).
const CROWD: u32 = 2048u;
// Dispatches run over at most this many workgroups in x, and go on in y.
const ROW_OF_WORKGROUPS: u32 = 32768u;

fn flat(workgroup: vec3<u32>) -> u32 {
    return workgroup.y * ROW_OF_WORKGROUPS + workgroup.x;
}

// Slopes (x/z, y/z) of the ray through a pixel's centre.
fn ray_slope(frame: Frame, pixel: vec2<f32>) -> vec2<f32> {
    let from_middle = pixel + 0.5 - 0.5 * vec2<f32>(frame.size);
    return vec2(from_middle.x, -from_middle.y) * frame.pitch;
}
