// Chooses which bricks to show by the middle of their hull, at no cost, and which to sample.
//
// The error of a ray is at most Σ F·charge over the bricks on it that are not sampled, where F bounds
// the transparency in front of the brick (error-bounds.md, Sec. 5: the difference of two pictures
// telescopes along the ray). So each column has a budget to spend, and spends it best on the bricks
// with the least charge for each particle saved.
//
// A workgroup takes a bundle from front to back, four filled cells at a time: lane l has column
// l mod 16 of the group's cell l/16, with its four bricks.

@group(0) @binding(12) var<storage, read_write> cell_values: array<CellEntry>;
@group(0) @binding(13) var<storage, read_write> slots_taken: atomic<u32>;
// For each column of a slot: lower and upper values of its bricks; what they charge, −1 where no light comes from; and
// the colour and opacity of their middles together.
@group(0) @binding(14) var<storage, read_write> bricks: array<ColumnValues>;
@group(0) @binding(15) var<storage, read_write> charges: array<vec4<f32>>;
@group(0) @binding(16) var<storage, read_write> shows: array<vec4<f32>>;
// For each bundle of the tile the layer after the last one that is seen.
@group(0) @binding(17) var<storage, read_write> last_layers: array<u32>;
// For each cell its place among those that are sampled + 2, 1 where it is shown, 0 where nothing is.
@group(0) @binding(18) var<storage, read_write> sampled: array<u32>;
// Cells to be sampled, where most bricks are and where few are: cell, place among the sampled ones, and
// bits of the bricks to be sampled.
@group(0) @binding(19) var<storage, read_write> wholes: array<vec4<u32>>;
@group(0) @binding(20) var<storage, read_write> parts: array<vec4<u32>>;
@group(0) @binding(21) var<storage, read_write> work: Work;

struct Work {
    wholes: atomic<u32>,
    parts: atomic<u32>,
    sampled: atomic<u32>,
}

const GROUP_CELLS: u32 = 4u;
// With more bricks than this to be sampled, lanes stand for rays, else for a ray's samples in a brick.
const MOST_BRICKS: u32 = 32u;
// Scores, charge for each particle saved, fall into classes of half an octave, down to 2⁻³².
const CLASSES: u32 = 64u;
// A charge as large as the budget, in `spending`.
const WHOLE: f32 = 262144.0;
// A column has ended where this share of the budget may still come through.
const OCCLUDED: f32 = 0.0625;

// A slot for each particle that is loaded: 16 of each cell.
var<workgroup> balls: array<vec4<f32>, LANES>;
// Weight, and quantity relative to the cell's reference.
var<workgroup> loads: array<vec2<f32>, LANES>;
// Extremes of each cell.
var<workgroup> cell_low: array<atomic<u32>, GROUP_CELLS>;
var<workgroup> cell_high: array<atomic<u32>, GROUP_CELLS>;
var<workgroup> most_particles: atomic<u32>;
var<workgroup> slots: array<u32, GROUP_CELLS>;
// Transparency of a column of a cell; charges of its marginal bricks.
var<workgroup> opened: array<f32, LANES>;
var<workgroup> marginal: array<f32, LANES>;
var<workgroup> open_columns: atomic<u32>;
// Charges by column and class, in shares of the budget.
var<workgroup> spending: array<atomic<u32>, 1024>;
// Bricks of a cell to be sampled, to be shown, and whether any of them is seen.
var<workgroup> masks: array<atomic<u32>, 8>;
var<workgroup> shown: array<atomic<u32>, GROUP_CELLS>;

// The lane's cell of a group, where there is one.
struct Cell {
    exists: bool,
    cell: u32,
    layer: u32,
    first: u32,
    end: u32,
}

// Nothing is known of a crowded cell: it may let all light through, and is sampled as a whole.
fn is_crowd(cell: Cell) -> bool {
    return cell.end - cell.first > CROWD;
}

// Where a walk over a bundle's filled cells stands.
struct Walk {
    layer: u32,
    first: u32,
}

// The next group of filled cells; the lane's one of them.
fn next_group(walk: ptr<function, Walk>, index: u32, end_layer: u32, number: u32) -> Cell {
    var mine = Cell(false, 0u, 0u, 0u, 0u);
    var found = 0u;
    var layer = (*walk).layer;
    var first = (*walk).first;
    for (; layer < end_layer && found < GROUP_CELLS; layer += 1u) {
        let cell = index * tile.layers + layer;
        let end = cells[cell];
        if end > first && end <= tile.pair_capacity {
            if found == number {
                mine = Cell(true, cell, layer, first, end);
            }
            found += 1u;
        }
        first = end;
    }
    *walk = Walk(layer, first);
    return mine;
}

// Values of the cells that are not known yet, from the quantities of their particles.
fn find_extremes(cell: Cell, unknown: bool, number: u32, column: u32) -> vec2<f32> {
    // The bits of floats that are not negative are in their order.
    if column == 0u {
        atomicStore(&cell_low[number], bitcast<u32>(FAR));
        atomicStore(&cell_high[number], 0u);
    }
    workgroupBarrier();
    let end = select(cell.first, cell.end, unknown);
    var low = FAR;
    var high = 0.0;
    for (var place = cell.first + column; place < end; place += COLUMNS) {
        let quantity = quantities[pairs[place]];
        let u = clamp(quantity, 0.0, 1.0);
        low = select(min(low, u), low, quantity > REJECTED);
        high = select(max(high, u), high, quantity > REJECTED);
    }
    atomicMin(&cell_low[number], bitcast<u32>(low));
    atomicMax(&cell_high[number], bitcast<u32>(high));
    workgroupBarrier();
    let least = bitcast<f32>(atomicLoad(&cell_low[number]));
    let greatest = bitcast<f32>(atomicLoad(&cell_high[number]));
    let values = vec2(max(least - 2e-6, 0.0), min(greatest + 2e-6, 1.0));
    return select(values, EMPTY, least > greatest);
}

fn load_particle(place: u32, lane: u32, middle: vec3<f32>, depth: f32, reference: f32) {
    let particle = pairs[place];
    let ball = projected[particle];
    let inverse_radius = depth / ball.w;
    let quantity = quantities[particle];
    let rejected = quantity > REJECTED;
    balls[lane] = vec4((ball.xyz - middle) / depth, inverse_radius * inverse_radius);
    loads[lane] = vec2(weights[particle], quantity - reference);
    if rejected {
        // So far away that it reaches no brick.
        balls[lane] = vec4(vec3(1e6), 1.0);
        loads[lane] = vec2(0.0);
    }
}

// Values of the lane's bricks from the particles of its cell, where it is `wanted`. All lanes together.
//
// Their quantities are taken relative to a value of the cell that does not depend on their order.
fn expand(
    cell: Cell, reference: f32, wanted: bool, most: u32, axis: vec2<f32>, column: Column, lane: u32,
) -> ColumnValues {
    let depths = layer_depth[tile.first_layer + cell.layer];
    let middle = vec3(depths.x * axis, depths.y);
    let end = select(cell.first, cell.end, wanted);
    let group_lane = lane / COLUMNS * COLUMNS;
    var expansion = no_expansion();
    var evaluations = 0u;
    for (var base = 0u; base < most; base += COLUMNS) {
        let place = cell.first + base + lane % COLUMNS;
        if place < end {
            load_particle(place, lane, middle, depths.x, reference);
        }
        workgroupBarrier();
        let loaded = min(COLUMNS, max(end, cell.first + base) - (cell.first + base));
        for (var i = 0u; i < loaded; i += 1u) {
            let particle = group_lane + i;
            let load = loads[particle];
            evaluations += add_particle(&expansion, column, balls[particle], load.x, load.y);
        }
        workgroupBarrier();
    }
    add_to_tally(0u, evaluations);
    return values_of(expansion, column, reference);
}

// Values of the lane's bricks: kept, or found out and kept; with the slot, + 2. Those of a cell that is
// transparent as a whole are not looked for: slot 1.
fn values_in_cell(
    cell: Cell, axis: vec2<f32>, column: Column, lane: u32, slot: ptr<function, u32>,
) -> ColumnValues {
    let number = lane / COLUMNS;
    let leader = lane % COLUMNS == 0u;
    var entry = cell_values[cell.cell];
    let analysed = cell.exists && !is_crowd(cell);
    let unknown = analysed && entry.slot == 0u;
    // Read by all before it is written by one.
    let extremes = find_extremes(cell, unknown, number, lane % COLUMNS);
    if unknown {
        entry = CellEntry(extremes, 1u, 0u);
    }
    let transparent = !analysed || is_transparent(entry.values);
    let wanted = !transparent && entry.slot == 1u;
    if lane == 0u {
        atomicStore(&most_particles, 0u);
    }
    workgroupBarrier();
    if wanted && leader {
        atomicMax(&most_particles, cell.end - cell.first);
        slots[number] = atomicAdd(&slots_taken, 1u);
    }
    let most = workgroupUniformLoad(&most_particles);
    var values = ColumnValues(vec4(EMPTY.x), vec4(EMPTY.y));
    for (var once = 0u; once < min(most, 1u); once += 1u) {
        let found = expand(cell, entry.values.x, wanted, most, axis, column, lane);
        if wanted {
            values = found;
            entry.slot = slots[number] + 2u;
            bricks[slots[number] * COLUMNS + lane % COLUMNS] = values;
        }
        if lane == 0u {
            settle_tally(0u, EVALUATIONS_OF_BOUNDS);
        }
    }
    if leader && cell.exists {
        cell_values[cell.cell] = entry;
    }
    *slot = entry.slot;
    if !transparent && !wanted {
        values = bricks[(entry.slot - 2u) * COLUMNS + lane % COLUMNS];
    }
    return values;
}

// The four hulls of a column, one behind the other.
struct ColumnHull {
    // Colour and opacity of the middles together.
    shown: vec4<f32>,
    // Charges of each, and transparencies in front of each, if nothing stood before the column.
    charge: vec4<f32>,
    front: vec4<f32>,
    open: f32,
}

fn behind(shown: vec4<f32>, middle: vec4<f32>) -> vec4<f32> {
    return shown + (1.0 - shown.a) * vec4(middle.rgb, middle.a);
}

fn hull_of_column(values: ColumnValues, paths: array<vec2<f32>, 4>, depth: f32) -> ColumnHull {
    let a = hull_of(vec2(values.low.x, values.high.x), paths[0] * depth);
    let b = hull_of(vec2(values.low.y, values.high.y), paths[1] * depth);
    let c = hull_of(vec2(values.low.z, values.high.z), paths[2] * depth);
    let d = hull_of(vec2(values.low.w, values.high.w), paths[3] * depth);
    let front = vec4(1.0, a.open, a.open * b.open, a.open * b.open * c.open);
    let shown = behind(behind(behind(a.middle, b.middle), c.middle), d.middle);
    return ColumnHull(shown, vec4(a.charge, b.charge, c.charge, d.charge), front, front.w * d.open);
}

// By exponent and first bit of the score: no rounding, so both loops find the same class.
fn class_of(charge: vec4<f32>, particles: f32) -> vec4<u32> {
    let score = max(charge, vec4(0.0)) * (1.0 / (chunk.budget * particles));
    return clamp(bitcast<vec4<u32>>(score) >> vec4(22u), vec4(LEAST_CLASS), vec4(LEAST_CLASS + CLASSES - 1u)) - LEAST_CLASS;
}

const LEAST_CLASS: u32 = 254u - 63u;

fn spend(column: u32, charge: f32, class_index: u32) {
    if charge > 0.0 {
        // Twice the budget is too much in any company.
        let share = u32(ceil(min(charge / chunk.budget, 2.0) * WHOLE));
        atomicAdd(&spending[column * CLASSES + class_index], share);
    }
}

// What a column may show: bricks of the classes before `marginal`, and bricks of that class, from
// front to back, until `left` is used up.
struct Plan {
    marginal: u32,
    left: f32,
    spent: f32,
}

fn plan_column(column: u32, reserve: f32) -> Plan {
    let budget = chunk.budget - reserve;
    var spent = 0.0;
    var class_index = 0u;
    for (; class_index < CLASSES; class_index += 1u) {
        let more = f32(atomicLoad(&spending[column * CLASSES + class_index])) * (chunk.budget / WHOLE);
        if spent + more > budget {
            break;
        }
        spent += more;
    }
    return Plan(class_index, budget - spent, spent);
}

// Bits of a cell's bricks in two words, four columns' layers each: brick b of column c is bit
// 16·(b mod 2) + c of word b/2.
fn set_bits(number: u32, column: u32, chosen: vec4<bool>) {
    let bit = 1u << column;
    let low = select(0u, bit, chosen.x) | select(0u, bit << 16u, chosen.y);
    let high = select(0u, bit, chosen.z) | select(0u, bit << 16u, chosen.w);
    atomicOr(&masks[2u * number], low);
    atomicOr(&masks[2u * number + 1u], high);
}

// Puts a cell on the list of those to be sampled as a whole or in parts, and counts its class.
fn file_cell(cell: Cell, number: u32) {
    let mask = vec2(atomicLoad(&masks[2u * number]), atomicLoad(&masks[2u * number + 1u]));
    let count = countOneBits(mask.x) + countOneBits(mask.y);
    // Whether a brick that is seen is not sampled.
    let shows_some = atomicLoad(&shown[number]) > 0u;
    if count == 0u {
        sampled[cell.cell] = select(0u, 1u, shows_some);
        note_class(cell.cell, select(CELLS_TRANSPARENT, CELLS_SUPER_PIXEL, shows_some), 0u);
        return;
    }
    let place = atomicAdd(&work.sampled, 1u);
    sampled[cell.cell] = place + 2u;
    if count > MOST_BRICKS {
        wholes[atomicAdd(&work.wholes, 1u)] = vec4(cell.cell, place, mask);
    } else {
        parts[atomicAdd(&work.parts, 1u)] = vec4(cell.cell, place, mask);
    }
    note_class(cell.cell, select(CELLS_FULL, CELLS_MIXED, shows_some), count);
}

// `class_index`: the place of its counter.
fn note_class(cell: u32, class_index: u32, sampled_bricks: u32) {
    atomicAdd(&counters[class_index], 1u);
    cell_values[cell].class_and_bricks = class_index | sampled_bricks << 8u;
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
    let number = lane / COLUMNS;
    let column_index = lane % COLUMNS;
    let column = column_at(column_index, axis);
    let slope = column.direction.xy;
    let paths = array(paths_of(0u, slope), paths_of(1u, slope), paths_of(2u, slope), paths_of(3u, slope));
    for (var i = lane; i < COLUMNS * CLASSES; i += LANES) {
        atomicStore(&spending[i], 0u);
    }

    // Charges, from front to back, until nothing more is seen.
    let start = Walk(0u, first_of_cell(index * tile.layers));
    var front = select(0.0, 1.0, column_in_picture(corner, column_index));
    // What is charged for everything behind the end of the column.
    var reserve = 0.0;
    var walk = start;
    while walk.layer < tile.layers {
        let cell = next_group(&walk, index, tile.layers, number);
        var slot = 0u;
        let values = values_in_cell(cell, axis, column, lane, &slot);
        let hull = hull_of_column(values, paths, layer_depth[tile.first_layer + cell.layer].x);
        if lane == 0u {
            atomicStore(&open_columns, 0u);
        }
        opened[lane] = hull.open;
        workgroupBarrier();
        var before = front;
        for (var i = 0u; i < GROUP_CELLS; i += 1u) {
            before = select(before, before * opened[i * COLUMNS + column_index], i < number);
        }
        let charge = before * hull.front * hull.charge * (1.0 + ROUNDING);
        // The column ends before a cell; so the charge is not more than the rest's.
        let ended = before <= OCCLUDED * chunk.budget;
        if cell.exists && slot > 1u {
            let place = (slot - 2u) * COLUMNS + column_index;
            charges[place] = select(charge, vec4(-1.0), ended);
            shows[place] = select(hull.shown, vec4(0.0), ended);
        }
        if !ended {
            let classes = class_of(charge, f32(cell.end - cell.first));
            spend(column_index, charge.x, classes.x);
            spend(column_index, charge.y, classes.y);
            spend(column_index, charge.z, classes.z);
            spend(column_index, charge.w, classes.w);
        }
        for (var i = 0u; i < GROUP_CELLS; i += 1u) {
            if reserve == 0.0 && front <= OCCLUDED * chunk.budget {
                reserve = front;
            }
            front *= opened[i * COLUMNS + column_index];
        }
        if front > OCCLUDED * chunk.budget {
            atomicAdd(&open_columns, 1u);
        }
        if workgroupUniformLoad(&open_columns) == 0u {
            break;
        }
    }
    if reserve == 0.0 && front <= OCCLUDED * chunk.budget {
        reserve = front;
    }
    let end_layer = walk.layer;
    // Cells' entries were written by one lane each.
    storageBarrier();
    workgroupBarrier();
    let plan = plan_column(column_index, reserve);

    // Choices.
    var used = 0.0;
    walk = start;
    while walk.layer < end_layer {
        let cell = next_group(&walk, index, end_layer, number);
        var charge = vec4(0.0);
        var seen = false;
        let slot = cell_values[cell.cell].slot;
        if cell.exists && slot > 1u {
            let place = (slot - 2u) * COLUMNS + column_index;
            charge = charges[place];
            seen = shows[place].a > 0.0;
        }
        let classes = class_of(charge, f32(cell.end - cell.first));
        let at_margin = (charge > vec4(0.0)) & (classes == vec4(plan.marginal));
        marginal[lane] = dot(select(vec4(0.0), charge, at_margin), vec4(1.0));
        if lane < 8u {
            atomicStore(&masks[lane], 0u);
        }
        if lane < GROUP_CELLS {
            atomicStore(&shown[lane], 0u);
        }
        workgroupBarrier();
        var with_mine = used;
        for (var i = 0u; i < GROUP_CELLS; i += 1u) {
            let more = marginal[i * COLUMNS + column_index];
            with_mine += select(0.0, more, i <= number);
            used += more;
        }
        let affordable = with_mine * (1.0 + ROUNDING) <= plan.left;
        let chosen = vec4(is_crowd(cell))
            | ((charge > vec4(0.0)) & ((classes > vec4(plan.marginal)) | (at_margin & vec4(!affordable))));
        set_bits(number, column_index, chosen);
        if seen && !all(chosen) {
            atomicAdd(&shown[number], 1u);
        }
        workgroupBarrier();
        if column_index == 0u && cell.exists {
            file_cell(cell, number);
        }
        workgroupBarrier();
    }
    if number == 0u {
        let charged = plan.spent + min(used, plan.left) + reserve;
        atomicMax(&counters[LARGEST_CHARGE], bitcast<u32>(charged));
    }
    if lane == 0u {
        last_layers[index] = end_layer;
    }
}
