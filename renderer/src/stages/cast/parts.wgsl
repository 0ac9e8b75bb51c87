// Samples some bricks of a cell: a workgroup a cell. A lane stands not for a ray but for four samples of
// a ray, so that few bricks keep all lanes busy: those in a brick, or the four of level 2, one in each
// brick.

// Bricks to be sampled at every slice, then columns to be sampled at level 2: brick b of column c is
// COLUMNS·b + c, and column c stands behind all of them. At most two units of work a lane, one after the other.
var<workgroup> todo: array<u32, LANES>;
// Colour and opacity of ray r in the brick layer b of the cell: 4r + b.
var<workgroup> strands: array<vec4<f32>, 256>;

// The brick layer of samples of level 2.
const LEVEL_2: u32 = 4u;

// Four samples of a ray.
struct Unit {
    // 1 where there is such a unit, else 0.
    count: u32,
    ray: u32,
    brick_layer: u32,
    from_axis: vec2<f32>,
    depths: vec4<f32>,
    weights: vec4<f32>,
    charges: Charges,
}

fn unit_of(number: u32, units: u32) -> Unit {
    let brick = todo[min(number, units - 1u) / COLUMN_RAYS];
    let ray = COLUMN_RAYS * (brick % COLUMNS) + number % COLUMN_RAYS;
    let count = select(0u, 1u, number < units);
    let layer = brick / COLUMNS;
    let depths = select(frame.sample_offset[min(layer, 3u)], level_2_offsets(), layer == LEVEL_2);
    return Unit(count, ray, layer, ray_from_axis(ray), depths, vec4(0.0), Charges());
}

// Adds a particle to a unit; returns the evaluations that it took.
fn add_to_unit(unit: ptr<function, Unit>, axis: vec2<f32>, ball: vec4<f32>, load: Load) -> u32 {
    let direction = vec3(axis + (*unit).from_axis, 1.0);
    let arc = arc_through(ball, (*unit).from_axis, direction, dot(direction, direction));
    if arc.top <= 0.0 || !meets((*unit).depths, arc) {
        return 0u;
    }
    let k = kernel_on((*unit).depths, arc);
    (*unit).weights += load.x * k;
    (*unit).charges += charges_of(load, k);
    return 4u;
}

// Composites a unit's samples: into the brick that they are in, or each into its own, of those that are
// sampled so.
fn finish_unit(unit: Unit, axis: vec2<f32>, reference: Quantity, depth: f32, coarse: vec2<u32>) {
    let scale = path_scale_of(depth, axis + unit.from_axis);
    if unit.count == 0u {
        return;
    }
    if !HAS_LEVEL_2 || unit.brick_layer < LEVEL_2 {
        let paths = frame.slab_depth[unit.brick_layer] * scale;
        let strand = composite_four(vec4(0.0), unit.weights, unit.charges, reference, paths, unit.depths);
        strands[4u * unit.ray + unit.brick_layer] = strand;
        return;
    }
    let shades = shades_of_four(unit.weights, unit.charges, reference);
    for (var i = 0u; i < BRICK_DEPTH; i += 1u) {
        if is_chosen(coarse, unit.ray / COLUMN_RAYS, i) {
            let path = dot(frame.slab_depth[i], vec4(1.0)) * scale;
            strands[4u * unit.ray + i] = composite(vec4(0.0), shades[i], path, unit.depths[i]);
        }
    }
}

// Sums over the particles of a cell, from `first` to `end`, for a unit of each lane; returns the evaluations that its
// own took. `place`: of the middle of the cell, and its depth.
fn sum_unit(
    unit: ptr<function, Unit>, first: u32, end: u32, place: vec4<f32>, reference: Quantity, axis: vec2<f32>, lane: u32,
) -> u32 {
    var done = 0u;
    var base = first;
    loop {
        if base + lane < end {
            load_particle(base + lane, lane, place.xyz, place.w, reference);
        }
        workgroupBarrier();
        let loaded = select(0u, min(LANES, end - base), (*unit).count > 0u);
        var i = 0u;
        loop {
            if i < loaded {
                done += add_to_unit(unit, axis, balls[i], loads[i]);
            }
            i += 1u;
            if i >= loaded {
                break;
            }
        }
        workgroupBarrier();
        base += LANES;
        if base >= end {
            break;
        }
    }
    return done;
}

// Samples the `count` bricks and columns of `todo` into `strands`.
fn sample_bricks(
    layer: u32, first: u32, end: u32, count: u32, coarse: vec2<u32>, axis: vec2<f32>, lane: u32,
) {
    let depths = layer_depth[tile.first_layer + layer];
    let place = vec4(depths.x * axis, depths.y, depths.x);
    let reference = reference_of(first);
    let units = COLUMN_RAYS * count;
    var number = 0u;
    loop {
        var unit = unit_of(number + lane, units);
        add_to_tally(0u, sum_unit(&unit, first, end, place, reference, axis, lane));
        finish_unit(unit, axis, reference, depths.x, coarse);
        number += LANES;
        if number >= units {
            break;
        }
    }
}

// Puts into `strands` what stands for four rays, from one on, of a brick that is not sampled at every slice; what is
// sampled at level 2 is to follow.
fn show_brick(cell: u32, column: u32, brick_layer: u32, first_ray: u32, axis: vec2<f32>, is_between: bool) {
    let middle = middle_of(cell, column, brick_layer, axis);
    for (var ray = first_ray; ray < first_ray + 4u; ray += 1u) {
        strands[4u * ray + brick_layer] = middle;
    }
    if HAS_LEVEL_2 || !is_between {
        return;
    }
    let depth = layer_depth[tile.first_layer + cell % tile.layers].x;
    let values = bricks[place_of_column(cell, column)];
    var i = 0u;
    loop {
        let ray = first_ray + i;
        let scale = path_scale_of(depth, axis + ray_from_axis(ray));
        strands[4u * ray + brick_layer] = pass_slope(vec4(0.0), values, brick_layer, ray % COLUMN_RAYS, scale);
        i += 1u;
        if i >= 4u {
            break;
        }
    }
}

// How many chosen bricks have lower bits.
fn rank_of(mask: vec2<u32>, column: u32, brick_layer: u32) -> u32 {
    let bit = column + 16u * (brick_layer % 2u);
    let before = mask[brick_layer / 2u] & ((1u << bit) - 1u);
    return countOneBits(before) + select(0u, countOneBits(mask.x), brick_layer >= 2u);
}

@compute @workgroup_size(LANES)
fn sample_parts(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = flat(workgroup);
    if number >= work[PARTS] {
        return;
    }
    let task = task_at(PARTS, number);
    let cell = task.x;
    let entry = cell_values[cell];
    let axis = ray_slope(frame, corner_of(cell / tile.layers) + 3.5);
    // The lane's brick.
    let column = lane % COLUMNS;
    let brick_layer = lane / COLUMNS % BRICK_DEPTH;
    // Of that, four rays.
    let part = lane / BRICKS;
    let bricks_to_do = countOneBits(entry.sampled.x) + countOneBits(entry.sampled.y);
    let columns = select(0u, columns_in(entry.coarse), HAS_LEVEL_2);
    if is_chosen(entry.sampled, column, brick_layer) {
        if part == 0u {
            todo[rank_of(entry.sampled, column, brick_layer)] = lane;
        }
    } else {
        let is_between = is_chosen(entry.coarse, column, brick_layer);
        show_brick(cell, column, brick_layer, COLUMN_RAYS * column + 4u * part, axis, is_between);
    }
    if brick_layer == 0u && part == 0u && (columns >> column & 1u) == 1u {
        let before = countOneBits(columns & ((1u << column) - 1u));
        todo[bricks_to_do + before] = LEVEL_2 * COLUMNS + column;
    }
    workgroupBarrier();
    let count = bricks_to_do + countOneBits(columns);
    let first = first_of_cell(cell);
    sample_bricks(cell % tile.layers, first, cells[cell], count, entry.coarse, axis, lane);
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
