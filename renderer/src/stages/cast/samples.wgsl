// Samples of rays through cells (HPG 2016, Alg. 2): particles are read once a cell and shared by the
// rays of its bundle; each is evaluated only at samples inside its support.
//
// Inside a cell, lengths are relative to the middle of the cell on the bundle's axis, in units of
// that middle's depth z_c: a squared distance then never cancels against the distance to the eye.

override COUNT_INSIDE: bool = false;
// Whether some bricks of a cell are shown unsampled.
override SOME_SHOWN: bool = false;

// Position relative to the cell, and 1/h².
var<workgroup> balls: array<vec4<f32>, LANES>;
// Weight, and weight times quantity.
var<workgroup> loads: array<vec2<f32>, LANES>;
// Colour and opacity of bricks that are shown unsampled, where some are: brick b of column c is 16b + c.
var<workgroup> middles: array<vec4<f32>, LANES>;

// What the quantities of a cell are relative to: some particle's, but never an outlier's, against which
// the others would vanish.
fn reference_of(first: u32) -> f32 {
    return clamp(quantities[pairs[first]], 0.0, 1.0);
}

// Brings up to 64 particles of the cell, one a lane, into shared memory.
fn load_particle(place: u32, lane: u32, middle: vec3<f32>, depth: f32, reference: f32) {
    let particle = particle_in_cell(place, middle, depth, reference);
    balls[lane] = particle.ball;
    loads[lane] = vec2(particle.weight, particle.weight * particle.quantity);
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

// One more sample behind the others: I += T·(1 − t)·c, T *= t (contract, section 1). `opacity` is
// 1 − T of the cell's samples so far: kept instead of T, it loses nothing where it is tiny.
fn composite(cell: vec4<f32>, weight: f32, quantity: f32, reference: f32, path: f32) -> vec4<f32> {
    if weight <= 0.0 {
        return cell;
    }
    let sample = transfer_at(clamp(reference + quantity / weight, 0.0, 1.0));
    let share = (1.0 - cell.w) * path_opacity(sample.w, path);
    return cell + share * vec4(sample.rgb, 1.0);
}

fn composite_four(
    cell: vec4<f32>,
    weights: vec4<f32>,
    quantities: vec4<f32>,
    reference: f32,
    paths: vec4<f32>,
) -> vec4<f32> {
    var result = composite(cell, weights.x, quantities.x, reference, paths.x);
    result = composite(result, weights.y, quantities.y, reference, paths.y);
    result = composite(result, weights.z, quantities.z, reference, paths.z);
    return composite(result, weights.w, quantities.w, reference, paths.w);
}

// Colour and opacity of a ray's stretch through one cell.
//
// `slope` is the ray's, `from_axis` its distance in slope from the bundle's axis; `sampled` are bits of
// its four bricks that are sampled at every slice, and from bit 4 on of those sampled at level 2.
fn cast_cell(
    layer: u32,
    first: u32,
    end: u32,
    axis: vec2<f32>,
    slope: vec2<f32>,
    from_axis: vec2<f32>,
    sampled: u32,
    lane: u32,
) -> vec4<f32> {
    let depths = layer_depth[tile.first_layer + layer];
    let depth = depths.x;
    let middle = vec3(depth * axis, depths.y);
    let direction = vec3(slope, 1.0);
    let direction_squared = dot(direction, direction);
    let reference = reference_of(first);
    // Sums over particles at the ray's 16 samples. Four vectors rather than an array: an indexed
    // array would live in memory.
    var w0 = vec4(0.0); var w1 = vec4(0.0); var w2 = vec4(0.0); var w3 = vec4(0.0);
    var q0 = vec4(0.0); var q1 = vec4(0.0); var q2 = vec4(0.0); var q3 = vec4(0.0);
    // At its four samples of level 2.
    var w_coarse = vec4(0.0); var q_coarse = vec4(0.0);
    let at = frame.sample_offset;
    // Evaluations done, and those with a weight above zero.
    var count = vec2(0u);

    let crowd = portions_of(first, end);
    let walk_end = select(end, first, crowd.x < crowd.y);
    for (var base = first; base < walk_end; base += LANES) {
        if base + lane < end {
            load_particle(base + lane, lane, middle, depth, reference);
        }
        workgroupBarrier();
        let loaded = min(LANES, end - base);
        for (var i = 0u; i < loaded; i += 1u) {
            let arc = arc_through(balls[i], from_axis, direction, direction_squared);
            if arc.top <= 0.0 {
                continue;
            }
            let charge = loads[i];
            if is_sampled(sampled, 0u) { count += add_samples(at[0], arc, charge, &w0, &q0); }
            if is_sampled(sampled, 1u) { count += add_samples(at[1], arc, charge, &w1, &q1); }
            if is_sampled(sampled, 2u) { count += add_samples(at[2], arc, charge, &w2, &q2); }
            if is_sampled(sampled, 3u) { count += add_samples(at[3], arc, charge, &w3, &q3); }
            if SOME_SHOWN && sampled > 15u {
                count += add_samples(level_2_offsets(), arc, charge, &w_coarse, &q_coarse);
            }
        }
        workgroupBarrier();
    }
    add_to_tally(0u, count.x);
    if COUNT_INSIDE { add_to_tally(2u, count.y); }
    for (var portion = crowd.x; portion < crowd.y; portion += 1u) {
        let sums = portion_sums[portion * LANES + lane];
        w0 += sums[0]; w1 += sums[1]; w2 += sums[2]; w3 += sums[3];
        q0 += sums[4]; q1 += sums[5]; q2 += sums[6]; q3 += sums[7];
    }

    let path = frame.slab_depth;
    let scale = depth * sqrt(direction_squared) * frame.path_scale;
    let coarse = Coarse(w_coarse, q_coarse, sampled >> 4u);
    var cell = vec4(0.0);
    cell = pass_brick(cell, 0u, w0, q0, reference, path[0] * scale, sampled, coarse, lane);
    cell = pass_brick(cell, 1u, w1, q1, reference, path[1] * scale, sampled, coarse, lane);
    cell = pass_brick(cell, 2u, w2, q2, reference, path[2] * scale, sampled, coarse, lane);
    return pass_brick(cell, 3u, w3, q3, reference, path[3] * scale, sampled, coarse, lane);
}

// Adds a particle to the sums at four samples; returns how many evaluations that took, and how many of
// them had a weight above zero.
fn add_samples(
    depths: vec4<f32>,
    arc: Arc,
    charge: vec2<f32>,
    weights: ptr<function, vec4<f32>>,
    quantities: ptr<function, vec4<f32>>,
) -> vec2<u32> {
    if !meets(depths, arc) {
        return vec2(0u);
    }
    let k = kernel_on(depths, arc);
    *weights += charge.x * k;
    *quantities += charge.y * k;
    return vec2(4u, select(0u, positive(k), COUNT_INSIDE));
}

// Sums at the samples of level 2, and bits of the bricks for which they stand.
struct Coarse {
    weights: vec4<f32>,
    quantities: vec4<f32>,
    bricks: u32,
}

fn is_sampled(sampled: u32, brick_layer: u32) -> bool {
    return !SOME_SHOWN || (sampled >> brick_layer & 1u) == 1u;
}

// One more brick behind the others: its samples, its only sample, or its middle.
fn pass_brick(
    cell: vec4<f32>,
    brick_layer: u32,
    weights: vec4<f32>,
    quantities: vec4<f32>,
    reference: f32,
    paths: vec4<f32>,
    sampled: u32,
    coarse: Coarse,
    lane: u32,
) -> vec4<f32> {
    if is_sampled(sampled, brick_layer) {
        return composite_four(cell, weights, quantities, reference, paths);
    }
    if (coarse.bricks >> brick_layer & 1u) == 1u {
        let weight = coarse.weights[brick_layer];
        return composite(cell, weight, coarse.quantities[brick_layer], reference, dot(paths, vec4(1.0)));
    }
    return cell + (1.0 - cell.a) * middles[16u * brick_layer + lane / 4u];
}

fn positive(k: vec4<f32>) -> u32 {
    return u32(dot(select(vec4(0.0), vec4(1.0), k > vec4(0.0)), vec4(1.0)));
}
