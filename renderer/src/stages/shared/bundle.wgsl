// What the shaders share that take a workgroup of 64 lanes for each bundle of 8 × 8 rays.

struct Chunk {
    // Turns of the tile to cast: the first, and the one after the last.
    first_turn: u32,
    end_turn: u32,
    // Turn t is that of bundle t·stride mod the number of bundles.
    stride: u32,
    // What may be charged to a ray of an adaptive picture.
    budget: f32,
    // E_relax.
    relaxation: f32,
    // 1 where bricks, or by the paper's bound cells, may be shown unsampled.
    super_pixels: u32,
    // What they may be between that and sampled at every slice.
    between: u32,
    padding: u32,
}

const NOTHING_BETWEEN: u32 = 0u;
// Bricks that follow their slopes. (At 1 they are sampled more coarsely along rays.)
const SLOPES: u32 = 2u;

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<uniform> tile: Tile;
@group(0) @binding(2) var<uniform> chunk: Chunk;
@group(0) @binding(3) var<storage, read> projected: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> weights: array<f32>;
@group(0) @binding(5) var<storage, read> quantities: array<Quantity>;
// Where the references of each cell end; those of the first begin at 0.
@group(0) @binding(6) var<storage, read> cells: array<u32>;
@group(0) @binding(7) var<storage, read> pairs: array<u32>;
// Depth of the middle of each layer of cells, from the eye and from the pivot.
@group(0) @binding(8) var<storage, read> layer_depth: array<vec2<f32>>;
@group(0) @binding(9) var<storage, read> buckets: array<u32>;
@group(0) @binding(10) var nodes: texture_2d<f32>;
// `Counters` of bundle.rs; the constants below are places in it.
@group(0) @binding(11) var<storage, read_write> counters: array<atomic<u32>, 16>;

// Places of counters of two words, low and high, and of single ones.
const EVALUATIONS: u32 = 0u;
const EVALUATIONS_INSIDE: u32 = 2u;
const EVALUATIONS_OF_BOUNDS: u32 = 4u;
// Largest charge to any ray, as the bits of an f32.
const LARGEST_CHARGE: u32 = 6u;
// Cells in which all, some or none of what is seen was sampled, and cells with nothing to be seen.
const CELLS_FULL: u32 = 8u;
const CELLS_MIXED: u32 = 9u;
const CELLS_SUPER_PIXEL: u32 = 10u;
const CELLS_TRANSPARENT: u32 = 11u;
// Cells sampled at level 1; those at levels 2 to 4 follow.
const CELLS_Z_ADAPTIVE: u32 = 12u;

const LANES: u32 = 64u;

// A bundle has columns of 2 × 2 or 4 × 4 rays. They follow the same Morton curve as rays, so that those of column c are
// of the lanes from COLUMN_RAYS·c on.
override COLUMN_SIDE: u32 = 2u;
override COLUMN_RAYS: u32 = COLUMN_SIDE * COLUMN_SIDE;
override COLUMNS: u32 = LANES / COLUMN_RAYS;
const MOST_COLUMNS: u32 = 16u;
// From the axis of a column to its outermost rays, in pixels.
override HALF_COLUMN: f32 = 0.5 * (f32(COLUMN_SIDE) - 1.0);

// Quantity of a particle that is left out (Quantity::REJECTED).
const REJECTED: f32 = 1e38;

// Sums of a cell over the lanes, low and high halves apart: those of 64 lanes stay below 2³².
var<workgroup> tally: array<atomic<u32>, 4>;

// The bundle whose turn it is: its number in the tile.
fn bundle_of(turn: u32) -> u32 {
    return (turn * chunk.stride) % (tile.count.x * tile.count.y);
}

// First pixel of a bundle of the tile.
fn corner_of(index: u32) -> vec2<f32> {
    let bundle = tile.first + vec2(index % tile.count.x, index / tile.count.x);
    return vec2<f32>(bundle * BUNDLE_SIDE);
}

// Where the references of a cell begin.
fn first_of_cell(cell: u32) -> u32 {
    return select(cells[max(cell, 1u) - 1u], 0u, cell == 0u);
}

// Whether a cell with these references holds any, all of them in the buffer.
fn is_filled(first: u32, end: u32) -> bool {
    return end > first && end <= tile.pair_capacity;
}

// The next layer, from one on, in which the bundle has a filled cell; the number of layers where there is
// none. A loop of its own: software adapters go through the body of a condition that does not hold.
fn next_filled(index: u32, from_layer: u32) -> u32 {
    var layer = from_layer;
    var first = first_of_cell(index * tile.layers + layer);
    while layer < tile.layers {
        let end = cells[index * tile.layers + layer];
        if is_filled(first, end) {
            break;
        }
        first = end;
        layer += 1u;
    }
    return layer;
}

// The first of a list of numbers below 64, as bits, that has any; and the list without it.
fn next_of(list: vec2<u32>) -> u32 {
    return select(firstTrailingBit(list.x), 32u + firstTrailingBit(list.y), list.x == 0u);
}

fn without_next(list: vec2<u32>) -> vec2<u32> {
    return select(vec2(list.x & (list.x - 1u), list.y), vec2(0u, list.y & (list.y - 1u)), list.x == 0u);
}

// A particle as a cell sees it.
struct Particle {
    // Place relative to the middle of the cell, in units of that middle's depth, and 1/h².
    ball: vec4<f32>,
    weight: f32,
    // Relative to the cell's reference: where that is what all particles have, sums are exact.
    quantity: Quantity,
}

// The particle of a reference; one that is left out weighs nothing and is out of reach. `middle`: of the
// cell, relative to the pivot.
fn particle_in_cell(reference: u32, middle: vec3<f32>, depth: f32, quantity_reference: Quantity) -> Particle {
    let particle = pairs[reference];
    let quantity = quantities[particle];
    if is_rejected(quantity) {
        return Particle(vec4(vec3(1e6), 1.0), 0.0, Quantity());
    }
    let ball = projected[particle];
    let inverse_radius = depth / ball.w;
    let place = vec4((ball.xyz - middle) / depth, inverse_radius * inverse_radius);
    return Particle(place, weights[particle], quantity - quantity_reference);
}

// Depth of the front of a slab, or of the end of the last one, relative to the cell's middle.
fn edge_of_slab(edge: u32) -> f32 {
    return frame.slab_edge[edge / 4u][edge % 4u];
}

// Depths of a cell's samples of level 2: each in the middle of four slabs.
fn level_2_offsets() -> vec4<f32> {
    let edges = frame.slab_edge;
    return vec4(edges[0].z, edges[1].z, edges[2].z, edges[3].z);
}

// Lanes follow a Morton curve, so that those that run in step, be it 8, 16, 32 or 64, make a compact
// block of pixels and mostly meet the same particles. (Picture::place undoes this.)
fn place_in_bundle(lane: u32) -> vec2<u32> {
    let x = (lane & 1u) | (lane >> 1u & 2u) | (lane >> 2u & 4u);
    let y = (lane >> 1u & 1u) | (lane >> 2u & 2u) | (lane >> 3u & 4u);
    return vec2(x, y);
}

// A ray that transmits less than this has ended.
const OPAQUE: f32 = 1e-5;

struct Ray {
    colour: vec3<f32>,
    transparency: f32,
}

// Distance of a lane's ray from the bundle's axis, in slope. Exact: half pixels times the pitch.
fn ray_from_axis(lane: u32) -> vec2<f32> {
    let place = vec2<f32>(place_in_bundle(lane));
    return vec2(place.x - 3.5, 3.5 - place.y) * frame.pitch;
}

fn add_to_tally(entry: u32, sum: u32) {
    atomicAdd(&tally[entry], sum & 0xffffu);
    atomicAdd(&tally[entry + 1u], sum >> 16u);
}

// Adds a cell's tally to a counter of two words, and clears it.
fn settle_tally(entry: u32, counter: u32) {
    let low_half = atomicExchange(&tally[entry], 0u);
    let high_half = atomicExchange(&tally[entry + 1u], 0u);
    let shifted = high_half << 16u;
    let low = low_half + shifted;
    let carry = select(0u, 1u, low < shifted);
    let before = atomicAdd(&counters[counter], low);
    let overflow = select(0u, 1u, before + low < before);
    let high = (high_half >> 16u) + carry + overflow;
    if high > 0u {
        atomicAdd(&counters[counter + 1u], high);
    }
}
