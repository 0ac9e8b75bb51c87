// Samples of rays through cells (HPG 2016, Alg. 2): particles are read once a cell and shared by the
// rays of its bundle; each is evaluated only at samples inside its support.
//
// Inside a cell, lengths are relative to the middle of the cell on the bundle's axis, in units of
// that middle's depth z_c: a squared distance then never cancels against the distance to the eye.

override COUNT_INSIDE: bool = false;
// Whether some bricks of a cell are shown unsampled.
override SOME_SHOWN: bool = false;
// Whether some cells are crowded, and some bricks sampled at level 2.
override HAS_CROWDS: bool = false;
override HAS_LEVEL_2: bool = false;

// Position relative to the cell, and 1/h².
var<workgroup> balls: array<vec4<f32>, LANES>;
// Weight, and weight times quantity.
var<workgroup> loads: array<Load, LANES>;
// Colour and opacity of bricks that are shown unsampled, where some are: brick b of column c is 16b + c.
var<workgroup> middles: array<vec4<f32>, LANES>;

// The quantity at the lane's samples in bricks that follow their slope, where some do.
var<private> on_slope: array<Charges, 4>;

// What the quantities of a cell are relative to: some particle's, but never an outlier's, against which
// the others would vanish. On a logarithmic scale the large ones are outliers to the small ones, so there
// it is 0.
fn reference_of(first: u32) -> Quantity {
    return zero_on_log_scale(in_range(quantities[pairs[first]]));
}

// Brings up to 64 particles of the cell, one a lane, into shared memory; returns the lane's ball.
fn load_particle(place: u32, lane: u32, middle: vec3<f32>, depth: f32, reference: Quantity) -> vec4<f32> {
    let particle = particle_in_cell(place, middle, depth, reference);
    balls[lane] = particle.ball;
    loads[lane] = Load(particle.weight, particle.weight * particle.quantity);
    return particle.ball;
}

// A ray's way through a ball: along it, 1 − ρ² is a parabola.
struct Arc {
    // Depth of the point closest to the ball's centre, and 1 − ρ² there: not positive for a miss.
    closest: f32,
    top: f32,
    // By how much 1 − ρ² falls with the squared depth from there.
    bend: f32,
    // Depth from there to the surface of the ball.
    reach: f32,
}

fn arc_through(ball: vec4<f32>, from_axis: vec2<f32>, direction: vec3<f32>, direction_squared: f32) -> Arc {
    let offset = ball.xyz - vec3(from_axis, 0.0);
    let closest = dot(offset, direction) / direction_squared;
    let across = offset - closest * direction;
    let top = 1.0 - dot(across, across) * ball.w;
    let bend = direction_squared * ball.w;
    return Arc(closest, top, bend, sqrt(max(top, 0.0) / bend));
}

// Whether any of four samples, in ascending depths, may be inside the ball.
fn meets(depths: vec4<f32>, arc: Arc) -> bool {
    return depths.x <= arc.closest + arc.reach && depths.w >= arc.closest - arc.reach;
}

fn kernel_on(depths: vec4<f32>, arc: Arc) -> vec4<f32> {
    let t = depths - arc.closest;
    return kernel(max(arc.top - arc.bend * t * t, vec4(0.0)));
}

// One more sample behind the others: I += T·(1 − t)·c, T *= t (contract, section 1). The last channel is
// 1 − T of the cell's samples so far: kept instead of T, it loses nothing where it is tiny. What c is,
// colour.wgsl and depth.wgsl say.
fn composite(cell: vec4<f32>, sample: vec4<f32>, path: f32, depth: f32) -> vec4<f32> {
    let share = (1.0 - cell.w) * path_opacity(sample.w, path);
    return cell + share * vec4(seen_of(sample, depth), 1.0);
}

fn composite_four(
    cell: vec4<f32>,
    weights: vec4<f32>,
    charges: Charges,
    reference: Quantity,
    paths: vec4<f32>,
    depths: vec4<f32>,
) -> vec4<f32> {
    let shades = shades_of_four(weights, charges, reference);
    var result = composite(cell, shades[0], paths.x, depths.x);
    result = composite(result, shades[1], paths.y, depths.y);
    result = composite(result, shades[2], paths.z, depths.z);
    return composite(result, shades[3], paths.w, depths.w);
}

// Reference lengths for each unit of depth in a cell (that of its middle) along a ray of this slope.
fn path_scale_of(depth: f32, slope: vec2<f32>) -> f32 {
    return depth * length(vec3(slope, 1.0)) * frame.path_scale;
}

// All four bricks of a ray, sampled at every slice.
const ALL_BRICKS: u32 = 15u;

// Sums over particles at a ray's samples in a cell: of weights, and of weights times quantity. Vectors
// rather than arrays: an indexed array would live in memory.
struct Sums {
    w0: vec4<f32>, w1: vec4<f32>, w2: vec4<f32>, w3: vec4<f32>,
    q0: Charges, q1: Charges, q2: Charges, q3: Charges,
    // At the four samples of level 2.
    w_coarse: vec4<f32>,
    q_coarse: Charges,
}

// Sums over the references from `first` to `end` of a cell of `layer`. `axis`: slope of the bundle's;
// `from_axis`: distance in slope of the ray from it. `sampled`: bits of the ray's four bricks that are
// sampled at every slice, and from bit 4 on of those between that and shown (Chunk).
fn sum_particles(
    layer: u32, first: u32, end: u32, reference: Quantity, axis: vec2<f32>, from_axis: vec2<f32>, sampled: u32, lane: u32,
) -> Sums {
    let depths = layer_depth[tile.first_layer + layer];
    let middle = vec3(depths.x * axis, depths.y);
    let direction = vec3(axis + from_axis, 1.0);
    let direction_squared = dot(direction, direction);
    let at = frame.sample_offset;
    var w0 = vec4(0.0); var w1 = vec4(0.0); var w2 = vec4(0.0); var w3 = vec4(0.0);
    var q0 = Charges(); var q1 = Charges(); var q2 = Charges(); var q3 = Charges();
    var w_coarse = vec4(0.0); var q_coarse = Charges();
    // Evaluations done, and those with a weight above zero.
    var count = vec2(0u);
    let level_2 = HAS_LEVEL_2 && sampled > ALL_BRICKS;
    want_layers(select(sampled & ALL_BRICKS, ALL_BRICKS, level_2), lane);
    var base = first;
    loop {
        clear_met(lane);
        workgroupBarrier();
        if base + lane < end {
            note_met(load_particle(base + lane, lane, middle, depths.x, reference), axis, lane);
        }
        workgroupBarrier();
        turn_met(lane);
        workgroupBarrier();
        var left = met_by(lane);
        loop {
            let i = next_of(left);
            let arc = arc_through(balls[i], from_axis, direction, direction_squared);
            let load = loads[i];
            if any(left != vec2(0u)) && arc.top > 0.0 {
                if is_sampled(sampled, 0u) { count += add_samples(at[0], arc, load, &w0, &q0); }
                if is_sampled(sampled, 1u) { count += add_samples(at[1], arc, load, &w1, &q1); }
                if is_sampled(sampled, 2u) { count += add_samples(at[2], arc, load, &w2, &q2); }
                if is_sampled(sampled, 3u) { count += add_samples(at[3], arc, load, &w3, &q3); }
                if level_2 { count += add_samples(level_2_offsets(), arc, load, &w_coarse, &q_coarse); }
            }
            left = without_next(left);
            if all(left == vec2(0u)) {
                break;
            }
        }
        workgroupBarrier();
        base += LANES;
        if base >= end {
            break;
        }
    }
    add_to_tally(0u, count.x);
    if COUNT_INSIDE { add_to_tally(2u, count.y); }
    return Sums(w0, w1, w2, w3, q0, q1, q2, q3, w_coarse, q_coarse);
}

// Adds the sums over the portions of a cell, where it is crowded.
fn add_portions(sums: ptr<function, Sums>, first: u32, end: u32, lane: u32) {
    let crowd = portions_of(first, end);
    for (var portion = crowd.x; portion < crowd.y; portion += 1u) {
        let more = portion_sums[portion * LANES + lane];
        (*sums).w0 += more.w0; (*sums).w1 += more.w1; (*sums).w2 += more.w2; (*sums).w3 += more.w3;
        (*sums).q0 += more.q0; (*sums).q1 += more.q1; (*sums).q2 += more.q2; (*sums).q3 += more.q3;
    }
}

// What is seen of a ray's stretch through one cell, and its opacity, from its particles or, where it is crowded, from
// the sums of its portions. The arguments are those of `sum_particles`.
fn cast_cell(
    layer: u32, first: u32, end: u32, axis: vec2<f32>, from_axis: vec2<f32>, sampled: u32, lane: u32,
) -> vec4<f32> {
    let reference = reference_of(first);
    let walk_end = select(end, first, HAS_CROWDS && end - first > CROWD);
    var sums = sum_particles(layer, first, walk_end, reference, axis, from_axis, sampled, lane);
    if HAS_CROWDS {
        add_portions(&sums, first, end, lane);
    }

    let path = frame.slab_depth;
    let depth = layer_depth[tile.first_layer + layer].x;
    let scale = path_scale_of(depth, axis + from_axis);
    var coarse = Coarse(mat4x4<f32>(), sampled >> 4u);
    if HAS_LEVEL_2 {
        coarse.shades = shades_of_four(sums.w_coarse, sums.q_coarse, reference);
    }
    var cell = vec4(0.0);
    cell = pass_brick(cell, 0u, sums.w0, sums.q0, reference, path[0] * scale, sampled, coarse, lane);
    cell = pass_brick(cell, 1u, sums.w1, sums.q1, reference, path[1] * scale, sampled, coarse, lane);
    cell = pass_brick(cell, 2u, sums.w2, sums.q2, reference, path[2] * scale, sampled, coarse, lane);
    return pass_brick(cell, 3u, sums.w3, sums.q3, reference, path[3] * scale, sampled, coarse, lane);
}

// Adds a particle to the sums at four samples; returns how many evaluations that took, and how many of
// them had a weight above zero.
fn add_samples(
    depths: vec4<f32>,
    arc: Arc,
    load: Load,
    weights: ptr<function, vec4<f32>>,
    charges: ptr<function, Charges>,
) -> vec2<u32> {
    if !meets(depths, arc) {
        return vec2(0u);
    }
    let k = kernel_on(depths, arc);
    *weights += load.x * k;
    *charges += charges_of(load, k);
    return vec2(4u, select(0u, positive(k), COUNT_INSIDE));
}

// Samples of level 2, and bits of the bricks for which they or their slopes stand.
struct Coarse {
    shades: mat4x4<f32>,
    bricks: u32,
}

fn is_sampled(sampled: u32, brick_layer: u32) -> bool {
    return !SOME_SHOWN || (sampled >> brick_layer & 1u) == 1u;
}

// One more brick behind the others: its samples, those on its slope, its only sample, or its middle.
fn pass_brick(
    cell: vec4<f32>,
    brick_layer: u32,
    weights: vec4<f32>,
    charges: Charges,
    reference: Quantity,
    paths: vec4<f32>,
    sampled: u32,
    coarse: Coarse,
    lane: u32,
) -> vec4<f32> {
    let is_between = (coarse.bricks >> brick_layer & 1u) == 1u;
    let by_slope = SOME_SHOWN && is_between && !HAS_LEVEL_2;
    if by_slope || is_sampled(sampled, brick_layer) {
        let w = select(weights, vec4(1.0), by_slope);
        let q = select_charges(charges, relative_to(on_slope[brick_layer], reference), by_slope);
        return composite_four(cell, w, q, reference, paths, frame.sample_offset[brick_layer]);
    }
    if HAS_LEVEL_2 && is_between {
        return composite(cell, coarse.shades[brick_layer], dot(paths, vec4(1.0)), level_2_offsets()[brick_layer]);
    }
    return cell + (1.0 - cell.a) * middles[COLUMNS * brick_layer + lane / COLUMN_RAYS];
}

fn positive(k: vec4<f32>) -> u32 {
    return u32(dot(select(vec4(0.0), vec4(1.0), k > vec4(0.0)), vec4(1.0)));
}
