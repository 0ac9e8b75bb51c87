// Samples some bricks of a cell: a workgroup a cell. A lane stands not for a ray but for a ray's four
// samples in a brick, so that few bricks keep all lanes busy.

// Bricks to be sampled: at most 32, two units of work a lane.
var<workgroup> todo: array<u32, LANES>;
// Colour and opacity of ray r in the brick layer b of the cell: 4r + b.
var<workgroup> strands: array<vec4<f32>, 256>;

// A ray's four samples in a brick.
struct Unit {
    // 1 where there is such a unit, else 0.
    count: u32,
    ray: u32,
    brick_layer: u32,
    from_axis: vec2<f32>,
    weights: vec4<f32>,
    charges: vec4<f32>,
}

fn unit_of(number: u32, units: u32) -> Unit {
    let brick = todo[min(number, units - 1u) / 4u];
    let ray = 4u * (brick % COLUMNS) + number % 4u;
    let count = select(0u, 1u, number < units);
    return Unit(count, ray, brick / COLUMNS, ray_from_axis(ray), vec4(0.0), vec4(0.0));
}

// Adds a particle to a unit; returns the evaluations that it took.
fn add_to_unit(unit: ptr<function, Unit>, axis: vec2<f32>, ball: vec4<f32>, charge: vec2<f32>) -> u32 {
    let direction = vec3(axis + (*unit).from_axis, 1.0);
    let arc = arc_through(ball, (*unit).from_axis, direction, dot(direction, direction));
    let depths = frame.sample_offset[(*unit).brick_layer];
    if arc.top <= 0.0 || !meets(depths, arc) {
        return 0u;
    }
    let k = kernel_on(depths, arc);
    (*unit).weights += charge.x * k;
    (*unit).charges += charge.y * k;
    return 4u;
}

fn finish_unit(unit: Unit, axis: vec2<f32>, reference: f32, depth: f32) {
    let scale = depth * length(vec3(axis + unit.from_axis, 1.0)) * frame.path_scale;
    let paths = frame.slab_depth[unit.brick_layer] * scale;
    let strand = composite_four(vec4(0.0), unit.weights, unit.charges, reference, paths);
    if unit.count > 0u {
        strands[4u * unit.ray + unit.brick_layer] = strand;
    }
}

// Samples the `count` bricks of `todo` into `strands`.
fn sample_bricks(layer: u32, first: u32, end: u32, count: u32, axis: vec2<f32>, lane: u32) {
    let depths = layer_depth[tile.first_layer + layer];
    let middle = vec3(depths.x * axis, depths.y);
    let reference = reference_of(first);
    let units = 4u * count;
    var a = unit_of(lane, units);
    var b = unit_of(lane + LANES, units);
    var done = 0u;
    for (var base = first; base < end; base += LANES) {
        if base + lane < end {
            load_particle(base + lane, lane, middle, depths.x, reference);
        }
        workgroupBarrier();
        let loaded = min(LANES, end - base);
        for (var i = 0u; i < loaded * a.count; i += 1u) {
            done += add_to_unit(&a, axis, balls[i], loads[i]);
        }
        for (var i = 0u; i < loaded * b.count; i += 1u) {
            done += add_to_unit(&b, axis, balls[i], loads[i]);
        }
        workgroupBarrier();
    }
    finish_unit(a, axis, reference, depths.x);
    finish_unit(b, axis, reference, depths.x);
    add_to_tally(0u, done);
}

// How many chosen bricks have lower bits.
fn rank_of(task: vec4<u32>, column: u32, brick_layer: u32) -> u32 {
    let bit = column + 16u * (brick_layer % 2u);
    let before = task[2u + brick_layer / 2u] & ((1u << bit) - 1u);
    return countOneBits(before) + select(0u, countOneBits(task.z), brick_layer >= 2u);
}

@compute @workgroup_size(LANES)
fn sample_parts(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = flat(workgroup);
    if number >= work.parts {
        return;
    }
    let task = tasks[number];
    let cell = task.x;
    let axis = ray_slope(frame, corner_of(cell / tile.layers) + 3.5);
    // The lane's brick.
    let column = lane % COLUMNS;
    let brick_layer = lane / COLUMNS;
    if is_chosen(task, column, brick_layer) {
        todo[rank_of(task, column, brick_layer)] = lane;
    } else {
        let middle = middle_of(cell, column, brick_layer, axis);
        for (var ray = 4u * column; ray < 4u * column + 4u; ray += 1u) {
            strands[4u * ray + brick_layer] = middle;
        }
    }
    workgroupBarrier();
    let count = countOneBits(task.z) + countOneBits(task.w);
    sample_bricks(cell % tile.layers, first_of_cell(cell), cells[cell], count, axis, lane);
    workgroupBarrier();
    var segment = vec4(0.0);
    for (var i = 0u; i < BRICK_DEPTH; i += 1u) {
        let strand = strands[4u * lane + i];
        segment += (1.0 - segment.a) * strand;
    }
    segments[task.y * LANES + lane] = segment;
    if lane == 0u {
        settle_tally(0u, EVALUATIONS);
    }
}
