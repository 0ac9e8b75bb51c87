// Samples some bricks of a cell: a workgroup a cell. A lane stands not for a ray but for a ray's four
// samples in a brick, so that few bricks keep all lanes busy.

struct Work {
    wholes: u32,
    parts: u32,
    sampled: u32,
}

// Colour and opacity of each ray in a sampled cell, 64 a cell.
@group(0) @binding(12) var<storage, read_write> segments: array<vec4<f32>>;
@group(0) @binding(13) var<storage, read> work: Work;
// Cell, its place among the sampled ones, and bits of the bricks to be sampled.
@group(0) @binding(14) var<storage, read> parts: array<vec4<u32>>;
// As in adapt/levels.wgsl.
@group(0) @binding(15) var<storage, read> cell_values: array<vec2<u32>>;
@group(0) @binding(16) var<storage, read> bricks: array<vec4<u32>>;
@group(0) @binding(17) var<storage, read> charges: array<vec4<f32>>;

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
    let reference = clamp(quantities[pairs[first]], 0.0, 1.0);
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

// Shows the lane's brick by its middle, on all of its rays.
fn show_brick(cell: u32, column: u32, brick_layer: u32, axis: vec2<f32>) {
    let place = (cell_values[cell].x - 2u) * COLUMNS + column;
    let depth = layer_depth[tile.first_layer + cell % tile.layers].x;
    let paths = paths_of(brick_layer, axis + column_from_axis(column)) * depth;
    let hull = hull_of(bricks[place][brick_layer], paths);
    let seen = charges[place][brick_layer] >= 0.0;
    let middle = select(vec4(0.0), hull.middle, seen);
    for (var ray = 0u; ray < 4u; ray += 1u) {
        strands[4u * (4u * column + ray) + brick_layer] = middle;
    }
}

@compute @workgroup_size(LANES)
fn sample_parts(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = flat(workgroup);
    if number >= work.parts {
        return;
    }
    let task = parts[number];
    let cell = task.x;
    let axis = ray_slope(frame, corner_of(cell / tile.layers) + 3.5);
    // The lane's brick.
    let column = lane % COLUMNS;
    let brick_layer = lane / COLUMNS;
    let word = task[2u + brick_layer / 2u];
    let bit = column + 16u * (brick_layer % 2u);
    if (word >> bit & 1u) == 1u {
        let before = word & ((1u << bit) - 1u);
        let rank = countOneBits(before) + select(0u, countOneBits(task.z), brick_layer >= 2u);
        todo[rank] = lane;
    } else {
        show_brick(cell, column, brick_layer, axis);
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
