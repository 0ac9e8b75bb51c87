// What the particles of a cell say of each of its 16 slabs (HPG 2016, Sec. 4.1): extremes of the quantity,
// and whether every ray surely meets a particle. No kernel weight is computed for it.
//
// Lane l has slab l mod 16 for the extremes and column l mod 16 for the coverage, and every fourth
// particle. They are not brought to shared memory first: few lanes would share them. Lengths and places
// are as in the cell.

const SLABS: u32 = 16u;
const ALL_SLABS: u32 = 0xffffu;
// A ray of a column is no farther from the column's axis than this, in pixels: more than √½.
const COLUMN_REACH: f32 = 0.7072;
// Wider, or narrower where a ray is to be covered, than all rounding of particles' places.
const RADIUS_SLACK: f32 = 1e-4;
// The same for the number of the slab at a depth.
const SLAB_SLACK: f32 = 0.01;

// What a lane found: extremes in its slab, and bits of the slabs in which a single particle holds all rays
// of its column.
struct Found {
    low: f32,
    high: f32,
    held: u32,
}

var<workgroup> found: array<Found, LANES>;

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

// Real numbers of slabs at two depths in the cell, 8 in its middle.
fn slabs_at(depths: vec2<f32>) -> vec2<f32> {
    let x = clamp(depths, vec2(edge_of_slab(0u)), vec2(edge_of_slab(SLABS)));
    // ln(1 + x), with full relative precision for small x.
    let series = x * (1.0 - x * (1.0 / 2.0 - x * (1.0 / 3.0 - x * (1.0 / 4.0 - x * (1.0 / 5.0)))));
    return 8.0 + select(log(1.0 + x), series, abs(x) < vec2(0.05)) / frame.log_step;
}

// Bits of the slabs that lie between two depths as a whole.
fn slabs_between(depths: vec2<f32>) -> u32 {
    let at = slabs_at(depths);
    let first = select(u32(ceil(at.x + SLAB_SLACK)), 0u, depths.x <= edge_of_slab(0u));
    let end = select(u32(floor(at.y - SLAB_SLACK)), SLABS, depths.y >= edge_of_slab(SLABS));
    return select(0u, (1u << end) - (1u << first), end > first && depths.x < depths.y);
}

// Whether a particle's depth range meets the closed slab between two edges, wherever it lies across.
fn meets_slab(ball: vec4<f32>, edges: vec2<f32>) -> bool {
    let radius = ball.w * (1.0 + RADIUS_SLACK);
    return ball.z - radius <= edges.y && ball.z + radius >= edges.x;
}

// Looks through the particles `first` to `end` of a cell.
fn look_into_cell(layer: u32, first: u32, end: u32, slope: vec2<f32>, lane: u32) {
    let depths = layer_depth[tile.first_layer + layer];
    let middle = vec3(depths.x * slope, depths.y);
    let number = lane % SLABS;
    let edges = vec2(edge_of_slab(number), edge_of_slab(number + 1u));
    let from_axis = column_from_axis(number);
    let axis = Axis(from_axis, vec3(slope + from_axis, 1.0));
    let reach = COLUMN_REACH * frame.pitch * (1.0 + edge_of_slab(SLABS));
    var mine = Found(FAR, 0.0, 0u);
    for (var i = first + lane / SLABS; i < end; i += LANES / SLABS) {
        let particle = particle_in_cell(i, middle, depths.x, 0.0);
        let ball = vec4(particle.ball.xyz, inverseSqrt(particle.ball.w));
        let quantity = clamp(particle.quantity, 0.0, 1.0);
        let met = meets_slab(ball, edges);
        mine.low = select(mine.low, min(mine.low, quantity), met);
        mine.high = select(mine.high, max(mine.high, quantity), met);
        mine.held |= slabs_between(chord(axis, ball.xyz, ball.w * (1.0 - RADIUS_SLACK) - reach));
    }
    found[lane] = mine;
}

// Values of a slab, as hull.wgsl has them, from what all lanes found.
fn values_of_slab(slab: u32) -> vec2<f32> {
    var covered = ALL_SLABS;
    for (var i = 0u; i < COLUMNS; i += 1u) {
        covered &= found[i].held | found[i + 16u].held | found[i + 32u].held | found[i + 48u].held;
    }
    let a = found[slab];
    let b = found[slab + 16u];
    let c = found[slab + 32u];
    let d = found[slab + 48u];
    let low = min(min(a.low, b.low), min(c.low, d.low));
    let high = max(max(a.high, b.high), max(c.high, d.high));
    let cover = select(0.0, COVERED, (covered >> slab & 1u) == 1u);
    // Rounded outward by as much as a sample's quantity may be off.
    let values = vec2(max(low - 2e-6, 0.0), min(high + 2e-6, 1.0) + cover);
    return select(values, EMPTY, low > high);
}
