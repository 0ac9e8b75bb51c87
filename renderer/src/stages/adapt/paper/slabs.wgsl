// What the particles of a cell say of each of its 16 slabs (HPG 2016, Sec. 4.1): extremes of the quantity,
// and whether every ray surely meets a particle. No kernel weight is computed for it.
//
// Lane l has slab l mod 16 for the extremes and column l mod 16 for the coverage, and every fourth
// particle. Lengths and places are as in the cell.

const SLABS: u32 = 16u;
const ALL_SLABS: u32 = 0xffffu;
const FAR: f32 = 1e30;
// A ray of a column is no farther from the column's axis than this, in pixels: more than √½.
const COLUMN_REACH: f32 = 0.7072;
// Wider, or narrower where a ray is to be covered, than all rounding of particles' places.
const RADIUS_SLACK: f32 = 1e-4;

// Place and radius of each particle that is loaded, and its quantity in [0, 1].
var<workgroup> balls: array<vec4<f32>, LANES>;
var<workgroup> loads: array<f32, LANES>;
// Of each slab: bits of the extremes, which for floats that are not negative are in their order.
var<workgroup> least: array<atomic<u32>, SLABS>;
var<workgroup> greatest: array<atomic<u32>, SLABS>;
// Of each column: bits of the slabs in which one particle or another holds all its rays.
var<workgroup> covered: array<atomic<u32>, COLUMNS>;

fn edge_of_slab(edge: u32) -> f32 {
    return frame.slab_edge[edge / 4u][edge % 4u];
}

fn load_particle(place: u32, lane: u32, middle: vec3<f32>, depth: f32) {
    let particle = particle_in_cell(place, middle, depth, 0.0);
    balls[lane] = vec4(particle.ball.xyz, inverseSqrt(particle.ball.w));
    loads[lane] = clamp(particle.quantity, 0.0, 1.0);
}

// A column's axis: where it crosses the middle of the cell, and its direction per unit of depth.
struct Axis {
    from_axis: vec2<f32>,
    direction: vec3<f32>,
}

// Depths between which a ball around (ball.xyz) holds the column's axis; x > y where there are none.
fn chord(axis: Axis, centre: vec3<f32>, radius: f32) -> vec2<f32> {
    let direction_squared = dot(axis.direction, axis.direction);
    let offset = centre - vec3(axis.from_axis, 0.0);
    let closest = dot(offset, axis.direction) / direction_squared;
    let across = offset - closest * axis.direction;
    let rest = radius * radius - dot(across, across);
    let reach = sqrt(max(rest, 0.0) / direction_squared);
    return select(vec2(1.0, -1.0), vec2(closest - reach, closest + reach), radius > 0.0 && rest > 0.0);
}

// Slabs that lie between two depths as a whole: both their edges do.
fn slabs_between(depths: vec2<f32>) -> u32 {
    var edges = 0u;
    for (var i = 0u; i < 5u; i += 1u) {
        let edge = frame.slab_edge[i];
        let inside = (edge >= vec4(depths.x)) & (edge <= vec4(depths.y));
        let bits = select(vec4(0u), vec4(1u, 2u, 4u, 8u), inside);
        edges |= (bits.x | bits.y | bits.z | bits.w) << (4u * i);
    }
    return edges & (edges >> 1u) & ALL_SLABS;
}

// Extremes over the particles whose depth range meets the closed slab, wherever it lies across.
fn meets_slab(ball: vec4<f32>, slab: u32) -> bool {
    let radius = ball.w * (1.0 + RADIUS_SLACK);
    return ball.z - radius <= edge_of_slab(slab + 1u) && ball.z + radius >= edge_of_slab(slab);
}

// Values of the lane's slab, as hull.wgsl has them, from the particles `first` to `end`. All lanes together.
fn values_of_slab(layer: u32, first: u32, end: u32, slope: vec2<f32>, lane: u32) -> vec2<f32> {
    let depths = layer_depth[tile.first_layer + layer];
    let middle = vec3(depths.x * slope, depths.y);
    let number = lane % SLABS;
    let from_axis = column_from_axis(number);
    let axis = Axis(from_axis, vec3(slope + from_axis, 1.0));
    let reach = COLUMN_REACH * frame.pitch * (1.0 + edge_of_slab(SLABS));
    if lane < SLABS {
        atomicStore(&least[lane], bitcast<u32>(FAR));
        atomicStore(&greatest[lane], 0u);
        atomicStore(&covered[lane], 0u);
    }
    var low = FAR;
    var high = 0.0;
    var held = 0u;
    for (var base = first; base < end; base += LANES) {
        if base + lane < end {
            load_particle(base + lane, lane, middle, depths.x);
        }
        workgroupBarrier();
        let loaded = min(LANES, end - base);
        for (var i = lane / SLABS; i < loaded; i += LANES / SLABS) {
            let ball = balls[i];
            let met = meets_slab(ball, number);
            low = select(low, min(low, loads[i]), met);
            high = select(high, max(high, loads[i]), met);
            held |= slabs_between(chord(axis, ball.xyz, ball.w * (1.0 - RADIUS_SLACK) - reach));
        }
        workgroupBarrier();
    }
    atomicMin(&least[number], bitcast<u32>(low));
    atomicMax(&greatest[number], bitcast<u32>(high));
    atomicOr(&covered[number], held);
    workgroupBarrier();
    return gathered_values(number);
}

fn gathered_values(slab: u32) -> vec2<f32> {
    var everywhere = ALL_SLABS;
    for (var column = 0u; column < COLUMNS; column += 1u) {
        everywhere &= atomicLoad(&covered[column]);
    }
    let low = bitcast<f32>(atomicLoad(&least[slab]));
    let high = bitcast<f32>(atomicLoad(&greatest[slab]));
    let cover = select(0.0, COVERED, (everywhere >> slab & 1u) == 1u);
    // Rounded outward by as much as a sample's quantity may be off.
    let values = vec2(max(low - 2e-6, 0.0), min(high + 2e-6, 1.0) + cover);
    return select(values, EMPTY, low > high);
}
