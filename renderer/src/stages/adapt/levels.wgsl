// Chooses which bricks to show by their middle instead of sampling them: those whose charge to the
// tolerance buys most. A workgroup takes a bundle from front to back.
//
// The error of a ray is at most Σ F·charge over the bricks on it that are not sampled, where F bounds
// the transparency in front of the brick (shared/hull.wgsl; the difference of two pictures telescopes
// along the ray). So each column of bricks has a budget to spend, and spends it best on the bricks
// with the least charge for each particle saved.

// For each cell a slot of bricks + 2, 1 where only the extremes are known, 0 for neither; and the
// values of the cell as a whole.
@group(0) @binding(13) var<storage, read_write> cell_values: array<vec2<u32>>;
// Values of 64 bricks a slot.
@group(0) @binding(14) var<storage, read_write> bricks: array<u32>;
// For each column the class of scores from which on bricks are sampled, and what the classes below
// leave of the budget.
@group(0) @binding(15) var<storage, read_write> plan: array<vec2<f32>>;
// Slots taken.
@group(0) @binding(12) var<storage, read_write> slots_taken: atomic<u32>;

var<workgroup> known: vec2<u32>;
var<workgroup> slot: u32;
var<workgroup> cell_low: atomic<u32>;
var<workgroup> cell_high: atomic<u32>;
var<workgroup> opened: array<f32, LANES>;
var<workgroup> open_columns: atomic<u32>;
// Charges by column and class, in shares of the budget.
var<workgroup> spending: array<atomic<u32>, 1024>;

// A charge as large as the budget.
const WHOLE: f32 = 262144.0;
// A column has ended where this share of the budget may still come through.
const OCCLUDED: f32 = 0.0625;

// Values of the whole cell, from the quantities of its particles.
fn values_of_cell(first: u32, end: u32, lane: u32) -> u32 {
    if lane == 0u {
        atomicStore(&cell_low, 0xffffu);
        atomicStore(&cell_high, 0u);
    }
    workgroupBarrier();
    for (var place = first + lane; place < end; place += LANES) {
        let quantity = quantities[pairs[place]];
        if quantity <= REJECTED {
            let u = clamp(quantity, 0.0, 1.0);
            let values = pack_values(u, u, false);
            atomicMin(&cell_low, values & 0xffffu);
            atomicMax(&cell_high, values >> 16u & 0x7fffu);
        }
    }
    workgroupBarrier();
    return atomicLoad(&cell_low) | atomicLoad(&cell_high) << 16u;
}

// Values of the lane's brick, from the cell's particles.
fn expand(layer: u32, first: u32, end: u32, axis: vec2<f32>, brick: Brick, lane: u32) -> u32 {
    let depths = layer_depth[tile.first_layer + layer];
    let middle = vec3(depths.x * axis, depths.y);
    let reference = clamp(quantities[pairs[first]], 0.0, 1.0);
    var sums = Expansion(0u, 1e30, -1e30, vec4(0.0), vec4(0.0), vec3(0.0));
    for (var base = first; base < end; base += LANES) {
        if base + lane < end {
            load_particle(base + lane, lane, middle, depths.x, reference);
        }
        workgroupBarrier();
        let loaded = min(LANES, end - base);
        for (var i = 0u; i < loaded; i += 1u) {
            add_particle(&sums, brick, balls[i], charges[i]);
        }
        workgroupBarrier();
    }
    // A value and its derivatives.
    add_to_tally(0u, 2u * sums.touching);
    return values_of(sums, brick, reference);
}

// Values of the lane's brick: kept, or found out and kept. Those of a cell that is transparent as a
// whole are not looked for.
fn values_in_cell(
    cell: u32, layer: u32, first: u32, end: u32, axis: vec2<f32>, brick: Brick, lane: u32,
) -> u32 {
    if lane == 0u {
        known = cell_values[cell];
    }
    var entry = workgroupUniformLoad(&known);
    if entry.x == 0u {
        let values = values_of_cell(first, end, lane);
        if lane == 0u {
            known = vec2(1u, values);
            cell_values[cell] = known;
        }
        entry = workgroupUniformLoad(&known);
    }
    if entry.x > 1u {
        return bricks[(entry.x - 2u) * LANES + lane];
    }
    if is_transparent(entry.y) {
        return EMPTY;
    }
    let values = expand(layer, first, end, axis, brick, lane);
    if lane == 0u {
        slot = atomicAdd(&slots_taken, 1u);
        cell_values[cell].x = slot + 2u;
    }
    bricks[workgroupUniformLoad(&slot) * LANES + lane] = values;
    if lane == 0u {
        settle_tally(0u, EVALUATIONS_OF_BOUNDS);
    }
    return values;
}

// Turns a column's spending by class into its plan.
fn plan_column(index: u32, column: u32, occluded: bool) {
    let budget = select(WHOLE, WHOLE * (1.0 - OCCLUDED), occluded);
    var spent = 0.0;
    var class_end = 0u;
    for (; class_end < CLASSES; class_end += 1u) {
        let more = f32(atomicLoad(&spending[column * CLASSES + class_end]));
        if spent + more > budget {
            break;
        }
        spent += more;
    }
    plan[index * COLUMNS + column] = vec2(f32(class_end), (budget - spent) / WHOLE * chunk.budget);
}

@compute @workgroup_size(LANES)
fn choose_levels(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let turn = chunk.first_turn + flat(workgroup);
    if turn >= chunk.end_turn {
        return;
    }
    let index = bundle_of(turn);
    let corner = corner_of(index);
    let axis = ray_slope(frame, corner + 3.5);
    let column = lane % COLUMNS;
    let brick_layer = lane / COLUMNS;
    let brick = place_brick(lane, axis);
    let paths = paths_of(brick_layer, brick.direction.xy);
    for (var i = lane; i < COLUMNS * CLASSES; i += LANES) {
        atomicStore(&spending[i], 0u);
    }

    var front = select(0.0, 1.0, column_in_picture(corner, column));
    var first = first_reference(index);
    for (var layer = 0u; layer < tile.layers; layer += 1u) {
        let cell = index * tile.layers + layer;
        let end = cells[cell];
        if end > first && end <= tile.pair_capacity {
            let values = values_in_cell(cell, layer, first, end, axis, brick, lane);
            let depth = layer_depth[tile.first_layer + layer].x;
            let hull = hull_of(values, paths * depth);
            if lane == 0u {
                atomicStore(&open_columns, 0u);
            }
            opened[lane] = hull.open;
            workgroupBarrier();
            var before = front;
            for (var i = 0u; i < BRICK_DEPTH; i += 1u) {
                if i == brick_layer {
                    before = front;
                }
                front *= opened[i * COLUMNS + column];
            }
            let charge = before * hull.charge;
            if charge > 0.0 && before > OCCLUDED * chunk.budget {
                let class_index = class_of(charge, f32(end - first));
                let share = u32(ceil(min(charge / chunk.budget, 1.0) * WHOLE));
                atomicAdd(&spending[column * CLASSES + class_index], share);
            }
            if front > OCCLUDED * chunk.budget {
                atomicAdd(&open_columns, 1u);
            }
            if workgroupUniformLoad(&open_columns) == 0u {
                break;
            }
        }
        first = end;
    }
    workgroupBarrier();
    if lane < COLUMNS {
        plan_column(index, column, front <= OCCLUDED * chunk.budget);
    }
}
