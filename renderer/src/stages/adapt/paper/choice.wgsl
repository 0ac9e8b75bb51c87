// The paper's choice of sampling levels and super-pixels (HPG 2016, Sec. 4.4 and 5).
//
// A workgroup takes a bundle: once it has bounded the cells at every level, it goes from back to front and
// gives each cell the choice whose interval is the widest that the tolerance bears. A cell that stays
// at level 0 adds the width of its own interval all the same, unless that is relaxed away.

@group(0) @binding(12) var<storage, read_write> cell_values: array<CellEntry>;
@group(0) @binding(13) var<storage, read_write> slots_taken: atomic<u32>;
@group(0) @binding(14) var<storage, read_write> bounds: array<CellBounds>;
// Colour and opacity that the columns of a slot show.
@group(0) @binding(15) var<storage, read_write> shows: array<vec4<f32>>;
@group(0) @binding(16) var<storage, read_write> bundle_entries: array<BundleEntry>;
// For each cell its place among those on lists of work + 2, 1 where it is shown, 0 where nothing is.
@group(0) @binding(17) var<storage, read_write> sampled: array<u32>;
// Cells on lists of work (shared/tasks.wgsl), each with its place among all of them.
@group(0) @binding(18) var<storage, read_write> tasks: array<vec2<u32>>;
@group(0) @binding(19) var<storage, read_write> work: array<atomic<u32>, 4>;

// How a cell is shown, sampled at a level or by one colour; and what that may do to light.
struct Choice {
    kind: u32,
    interval: Interval,
}

// Beside the levels 0 to 4.
const SUPER_PIXEL: u32 = 5u;

// What a choice may do to light, for the cell at a place of `bounds`.
fn interval_of(place: u32, kind: u32, slack: vec4<f32>) -> Interval {
    if kind == SUPER_PIXEL {
        // Its error is lateral: it is not relaxed (Sec. 5.2).
        return bounds[place].levels[0];
    }
    return relaxed(bounds[place].levels[kind], slack);
}

// Whether a choice may be made for a cell, whatever stands around it: no cell's coarse level may use up the
// budget alone, and this is never relaxed (l_max of Sec. 4.2). Cells at a surface stay as they are, since
// relaxation would have it that they are not.
fn is_allowed(place: u32, kind: u32, budget: f32) -> bool {
    if bounds[place].is_surface != 0u {
        return false;
    }
    if kind == SUPER_PIXEL {
        return chunk.super_pixels != 0u;
    }
    return chunk.between != NOTHING_BETWEEN && width(bounds[place].levels[kind]) < budget;
}

// The widest choice that keeps the whole ray below the budget; of equal ones the super-pixel, which
// takes no samples. Level 0 where none does. (A width that is no number is below nothing.)
fn choose(place: u32, back: Interval, budget: f32) -> Choice {
    let slack = slack_of(bounds[place].levels[0]);
    let front = bounds[place].front;
    var best = Choice(0u, interval_of(place, 0u, slack));
    var widest = -1.0;
    for (var kind = 1u; kind <= SUPER_PIXEL; kind += 1u) {
        let interval = interval_of(place, kind, slack);
        let own = width(interval);
        let whole = width(behind(front, behind(interval, back)));
        if own >= widest && whole < budget && is_allowed(place, kind, budget) {
            best = Choice(kind, interval);
            widest = own;
        }
    }
    return best;
}

// The middle of a cell's interval: a picture of colours, no brighter than they are opaque.
fn middle_of_cell(level_0: Interval) -> vec4<f32> {
    let middle = 0.5 * (level_0.low + level_0.high);
    return min(middle, middle.aaaa);
}

// Enters what becomes of a cell at a place of `bounds`.
fn file_cell(cell: u32, place: u32, kind: u32) {
    if kind == SUPER_PIXEL {
        let middle = middle_of_cell(bounds[place].levels[0]);
        for (var column = 0u; column < COLUMNS; column += 1u) {
            shows[place * COLUMNS + column] = middle;
        }
        sampled[cell] = 1u;
        note_class(cell, CELLS_SUPER_PIXEL, 0u);
        return;
    }
    if kind == 0u {
        list_cell(cell, WHOLES);
        note_class(cell, CELLS_FULL, 0xffffffffu);
    } else {
        list_cell(cell, PARTS);
        note_class(cell, CELLS_Z_ADAPTIVE + kind - 1u, 0u);
    }
}

// `class_index`: the place of its counter; `bricks`: each word of the mask of those sampled at level 0.
fn note_class(cell: u32, class_index: u32, bricks: u32) {
    atomicAdd(&counters[class_index], 1u);
    cell_values[cell].class_index = class_index;
    cell_values[cell].sampled = vec2(bricks);
    cell_values[cell].coarse = vec2(0u);
}

// Makes the choices, from back to front; returns what is charged to the rays.
fn choose_cells(index: u32, front: Front) -> f32 {
    let budget = chunk.budget - front.hidden;
    var back = nothing();
    var adapted = false;
    for (var layer = front.end_layer; layer > 0u; layer -= 1u) {
        let cell = index * tile.layers + layer - 1u;
        let end = cells[cell];
        if end <= first_of_cell(cell) || end > tile.pair_capacity {
            continue;
        }
        let place = cell_values[cell].slot - FIRST_SLOT;
        if is_left_out(bounds[place].levels[0]) {
            sampled[cell] = 0u;
            note_class(cell, CELLS_TRANSPARENT, 0u);
            continue;
        }
        let choice = choose(place, back, budget);
        back = behind(choice.interval, back);
        adapted |= choice.kind > 0u;
        file_cell(cell, place, choice.kind);
    }
    return front.hidden + select(0.0, width(back), adapted);
}

@compute @workgroup_size(LANES)
fn choose_by_intervals(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let turn = chunk.first_turn + flat(workgroup);
    if turn >= chunk.end_turn {
        return;
    }
    let index = bundle_of(turn);
    let front = bound_cells(index, ray_slope(frame, corner_of(index) + 3.5), lane);
    if lane == 0u {
        let charged = choose_cells(index, front);
        for (var column = 0u; column < COLUMNS; column += 1u) {
            bundle_entries[index].charged[column] = charged;
        }
        bundle_entries[index].end_layer = front.end_layer;
        atomicMax(&counters[LARGEST_CHARGE], bitcast<u32>(charged));
    }
}
