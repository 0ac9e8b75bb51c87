// Bounds of each cell of a bundle at every level, and of all cells in front of it (HPG 2016, Sec. 4.2 and
// 4.3), from front to back, twelve filled cells at a time.

const LEVELS: u32 = 5u;
const GROUP_CELLS: u32 = 12u;

// What is known of a cell that holds particles.
struct CellBounds {
    // Of each slab, and 1 where any of them is not EMPTY and not COVERED: these stay as long as the quantity.
    values: array<vec2<f32>, SLABS>,
    is_surface: u32,
    // Of the cell at each level, and of all cells before it at level 0, relaxed: of one choice.
    levels: array<Interval, LEVELS>,
    front: Interval,
}

// A ray has ended where this share of the budget may still come through.
const OCCLUDED: f32 = 0.0625;
// A cell that is no more opaque than this share of the budget is left out: values of its slabs are rounded
// outward, so that what is transparent may not be so to the last bit.
const NEGLIGIBLE: f32 = 0.00025;

// The group's cells, their places in `bounds`, and bits of those whose slabs are not known yet, and of those
// at a surface.
var<workgroup> group: array<u32, GROUP_CELLS>;
var<workgroup> places: array<u32, GROUP_CELLS>;
var<workgroup> unknown: atomic<u32>;
var<workgroup> surfaces: atomic<u32>;
var<workgroup> extremes: array<Extremes, 192>;
// The front after the group.
var<workgroup> passed: Front;

// What stands in front of the rest of a bundle.
struct Front {
    interval: Interval,
    // The layer after the last one that is seen, once the rays have ended.
    end_layer: u32,
    // By how much all that is left out may change a ray: cells with nothing to be seen, and the light from
    // behind the end.
    hidden: f32,
}

// Lists the next filled cells of a bundle from a layer on; returns how many, and the layer to go on with.
fn next_group(index: u32, first_layer: u32, lane: u32) -> vec2<u32> {
    var count = 0u;
    var layer = first_layer;
    var first = first_of_cell(index * tile.layers + layer);
    for (; layer < tile.layers && count < GROUP_CELLS; layer += 1u) {
        let cell = index * tile.layers + layer;
        let end = cells[cell];
        if is_filled(first, end) {
            if lane == count {
                group[count] = cell;
            }
            count += 1u;
        }
        first = end;
    }
    return vec2(count, layer);
}

// Finds the place of a cell of the group, or gives it one.
fn find_place(number: u32) {
    let slot = cell_values[group[number]].slot;
    places[number] = slot - FIRST_SLOT;
    if slot == UNKNOWN {
        places[number] = atomicAdd(&slots_taken, 1u);
        cell_values[group[number]].slot = places[number] + FIRST_SLOT;
        atomicOr(&unknown, 1u << number);
    }
}

// Values of a slab of which nothing is known: it may let all light through.
const ANYTHING: vec2<f32> = vec2(0.0, 1.0);

// Finds the values of the slabs of a cell of the group. Nothing is known of a crowded cell.
fn find_slabs(number: u32, slope: vec2<f32>, lane: u32) {
    let cell = group[number];
    let first = first_of_cell(cell);
    let crowded = cells[cell] - first > CROWD;
    look_into_cell(cell % tile.layers, first, select(cells[cell], first, crowded), slope, lane);
    workgroupBarrier();
    if lane < SLABS {
        let values = select(values_of_slab(lane), ANYTHING, crowded);
        bounds[places[number]].values[lane] = values;
        if values.x >= 0.0 && values.y < COVERED {
            atomicOr(&surfaces, 1u << number);
        }
    }
    workgroupBarrier();
}

// Has the values of the slabs of all cells of the group in `bounds`.
fn know_slabs(count: u32, slope: vec2<f32>, lane: u32) {
    if lane == 0u {
        atomicStore(&unknown, 0u);
        atomicStore(&surfaces, 0u);
    }
    workgroupBarrier();
    if lane < count {
        find_place(lane);
    }
    let missing = workgroupUniformLoad(&unknown);
    for (var i = 0u; i < count; i += 1u) {
        if (missing >> i & 1u) == 1u {
            find_slabs(i, slope, lane);
        }
    }
    if lane < count && (missing >> lane & 1u) == 1u {
        bounds[places[lane]].is_surface = atomicLoad(&surfaces) >> lane & 1u;
    }
    storageBarrier();
    workgroupBarrier();
}

// Bounds of a cell of the group at one level: each sample is as uncertain as all those that it stands for.
fn interval_at(number: u32, level: u32, lengths: vec2<f32>) -> Interval {
    let slabs = 1u << level;
    let own = number * SLABS;
    var cell = nothing();
    for (var first = 0u; first < SLABS; first += slabs) {
        var hull = extremes[own + first];
        for (var i = 1u; i < slabs; i += 1u) {
            let other = extremes[own + first + i];
            hull = Extremes(min(hull.low, other.low), max(hull.high, other.high));
        }
        for (var i = first; i < first + slabs; i += 1u) {
            cell = behind(cell, sample_interval(hull, frame.slab_depth[i / 4u][i % 4u] * lengths));
        }
    }
    return cell;
}

// Bounds the cells of the group at every level: a lane each.
fn bound_group(count: u32, slope: vec2<f32>, lane: u32) {
    for (var i = lane; i < count * SLABS; i += LANES) {
        extremes[i] = extremes_of_slab(bounds[places[i / SLABS]].values[i % SLABS]);
    }
    workgroupBarrier();
    if lane < count * LEVELS {
        let number = lane / LEVELS;
        let depth = layer_depth[tile.first_layer + group[number] % tile.layers].x;
        bounds[places[number]].levels[lane % LEVELS] =
            interval_at(number, lane % LEVELS, lengths_in_bundle(slope) * depth);
    }
    storageBarrier();
    workgroupBarrier();
}

// By how much the lower bounds of a cell are raised.
fn slack_of(level_0: Interval) -> vec4<f32> {
    return chunk.relaxation * widths(level_0);
}

fn is_left_out(level_0: Interval) -> bool {
    return level_0.high.a <= NEGLIGIBLE * chunk.budget;
}

// Goes through the cells of the group, until the rays have ended. By one lane.
fn pass_group(count: u32, before: Front) -> Front {
    var front = before;
    for (var i = 0u; i < count; i += 1u) {
        let level_0 = bounds[places[i]].levels[0];
        if is_left_out(level_0) {
            front.hidden += level_0.high.a;
            continue;
        }
        bounds[places[i]].front = front.interval;
        front.interval = behind(front.interval, relaxed(level_0, slack_of(level_0)));
        let open = 1.0 - front.interval.low.a;
        if open <= OCCLUDED * chunk.budget {
            front.end_layer = group[i] % tile.layers + 1u;
            front.hidden += open;
            break;
        }
    }
    return front;
}

// Bounds the cells of a bundle until nothing more is seen. All lanes together.
fn bound_cells(index: u32, slope: vec2<f32>, lane: u32) -> Front {
    var front = Front(nothing(), 0u, 0.0);
    var layer = 0u;
    while layer < tile.layers && front.end_layer == 0u {
        let listed = next_group(index, layer, lane);
        layer = listed.y;
        know_slabs(listed.x, slope, lane);
        bound_group(listed.x, slope, lane);
        if lane == 0u {
            passed = pass_group(listed.x, front);
        }
        front = workgroupUniformLoad(&passed);
    }
    if front.end_layer == 0u {
        front.end_layer = tile.layers;
    }
    return front;
}
