// Chooses which bricks to show by the middle of their hull, at no cost, and which to sample.
//
// The error of a ray is at most Σ F·charge over the bricks on it that are not sampled, where F bounds
// the transparency in front of the brick (error-bounds.md, Sec. 5: the difference of two pictures
// telescopes along the ray). So each column has a budget to spend, and spends it best on the offers
// that cost least for each evaluation they save.
//
// A workgroup walks twice through a bundle, from front to back: once to make offers for every brick
// until nothing more is seen, and once to take those that fit the budget.

@group(0) @binding(12) var<storage, read_write> cell_values: array<CellEntry>;
@group(0) @binding(13) var<storage, read_write> slots_taken: atomic<u32>;
// For each column of a slot: values of its bricks, their offers, and the colour and opacity of their
// middles together.
@group(0) @binding(14) var<storage, read_write> bricks: array<FieldValues>;
@group(0) @binding(15) var<storage, read_write> offers: array<Offers>;
@group(0) @binding(16) var<storage, read_write> shows: array<vec4<f32>>;
@group(0) @binding(17) var<storage, read_write> bundle_entries: array<BundleEntry>;

// A column has ended where this share of the budget may still come through.
const OCCLUDED: f32 = 0.0625;

// Transparency of a column of a cell; costs of its marginal offers.
var<workgroup> opened: array<f32, LANES>;
var<workgroup> marginal: array<f32, LANES>;
var<workgroup> open_columns: atomic<u32>;

// A lane's bundle, and its place in it.
struct Place {
    index: u32,
    // Slope of the bundle's axis.
    axis: vec2<f32>,
    // The lane's cell in its group, and column.
    number: u32,
    column: u32,
}

// Light that comes through to a column: 1 at the eye.
struct Front {
    light: f32,
    // What is charged for everything behind the end of the column; 0 until it has ended.
    reserve: f32,
}

// Light before the lane's cell of a group, whose columns let `opened` through.
fn light_before(front: Front, place: Place) -> f32 {
    var light = front.light;
    for (var i = 0u; i < GROUP_CELLS; i += 1u) {
        light = select(light, light * opened[i * COLUMNS + place.column], i < place.number);
    }
    return light;
}

fn has_ended(light: f32) -> bool {
    return light <= OCCLUDED * chunk.budget;
}

fn end_column(front: ptr<function, Front>) {
    if (*front).reserve == 0.0 && has_ended((*front).light) {
        (*front).reserve = (*front).light;
    }
}

fn pass_group(front: ptr<function, Front>, place: Place) {
    for (var i = 0u; i < GROUP_CELLS; i += 1u) {
        end_column(front);
        (*front).light *= opened[i * COLUMNS + place.column];
    }
}

// Offers of a column's bricks, kept and summed up by class. `slot`: as the cell's entry has it.
fn make_offers(hull: ColumnHull, cell: Cell, slot: u32, before: f32, place: Place) {
    // The column ended before the cell; so what the cell does is charged with the rest.
    let ended = has_ended(before);
    let mine = offers_of(hull, before);
    if cell.exists && slot >= FIRST_SLOT {
        let kept = (slot - FIRST_SLOT) * COLUMNS + place.column;
        offers[kept] = Offers(select(mine.first, vec4(NONE), ended), mine.second);
        shows[kept] = select(hull.shown, vec4(0.0), ended);
    }
    if cell.exists && !ended {
        let classes = classes_of(mine, f32(cell.end - cell.first), cell.layer);
        spend_four(place.column, mine.first, classes.first);
        if chunk.between != NOTHING_BETWEEN {
            spend_four(place.column, mine.second, classes.second);
        }
    }
}

// Makes offers for the next group of cells; returns whether anything is seen behind it.
fn offer_group(
    walk: ptr<function, Walk>, place: Place, paths: array<vec2<f32>, 4>, lane: u32, front: ptr<function, Front>,
) -> bool {
    let first = (*walk).next;
    let cell = next_group(walk, place.index, place.number);
    let slot = cell_values[cell.cell].slot;
    let values = values_in_cell(first + place.number, slot, place.column);
    let hull = hull_of_column(values, paths, layer_depth[tile.first_layer + cell.layer].x);
    if lane == 0u {
        atomicStore(&open_columns, 0u);
    }
    opened[lane] = hull.open;
    workgroupBarrier();
    make_offers(hull, cell, slot, light_before(*front, place), place);
    pass_group(front, place);
    if !has_ended((*front).light) {
        atomicAdd(&open_columns, 1u);
    }
    return workgroupUniformLoad(&open_columns) > 0u;
}

// Makes offers for the next stretch of cells; returns whether anything is seen behind it. Groups follow upon groups
// without a look at bounds that none of them lacks.
fn offer_stretch(
    walk: ptr<function, Walk>, place: Place, paths: array<vec2<f32>, 4>, lane: u32, front: ptr<function, Front>,
) -> bool {
    survey(*walk, place.index, place.axis, lane);
    if HAS_SHEAVES {
        bound_stretch(*walk, place.index, place.axis, lane);
    }
    let end = min((*walk).next + STRETCH_CELLS, (*walk).count);
    var by_columns = workgroupUniformLoad(&cells_by_columns);
    var is_open = true;
    loop {
        by_columns = bound_group(*walk, by_columns, place.index, place.axis, lane);
        loop {
            is_open = offer_group(walk, place, paths, lane, front);
            if !is_open || (*walk).next >= end || of_group(by_columns, *walk) != 0u {
                break;
            }
        }
        if !is_open || (*walk).next >= end {
            break;
        }
    }
    return is_open;
}

// Makes offers from front to back until nothing more is seen; returns the layer after the last one.
fn offer_all(place: Place, column: Column, lane: u32, front: ptr<function, Front>) -> u32 {
    let slope = column.direction.xy;
    let paths = array(paths_of(0u, slope), paths_of(1u, slope), paths_of(2u, slope), paths_of(3u, slope));
    var walk = start_walk(tile.layers);
    var is_open = true;
    loop {
        list_filled(&walk, place.index, lane);
        loop {
            if has_group(walk) {
                is_open = offer_stretch(&walk, place, paths, lane, front);
            }
            if !is_open || !has_group(walk) {
                break;
            }
        }
        if !is_open || !has_layers(walk) {
            break;
        }
    }
    end_column(front);
    return select(layer_after(walk), tile.layers, is_open);
}

// Takes the offers for the next group of cells that the plan of the column affords, and files the cells. `taken`: what
// the marginal ones cost in all.
fn take_group(walk: ptr<function, Walk>, place: Place, plan: Plan, lane: u32, taken: ptr<function, f32>) {
    let cell = next_group(walk, place.index, place.number);
    var mine = Offers(vec4(NONE), vec4(NONE));
    var seen = false;
    let slot = cell_values[cell.cell].slot;
    if cell.exists && slot >= FIRST_SLOT {
        let kept = (slot - FIRST_SLOT) * COLUMNS + place.column;
        mine = offers[kept];
        seen = shows[kept].a > 0.0;
    }
    let classes = classes_of(mine, f32(cell.end - cell.first), cell.layer);
    marginal[lane] =
        marginal_cost(plan, mine.first, classes.first) + marginal_cost(plan, mine.second, classes.second);
    clear_masks(lane);
    workgroupBarrier();
    var affordable = false;
    for (var i = 0u; i < GROUP_CELLS; i += 1u) {
        let with_it = (*taken + marginal[i * COLUMNS + place.column]) * (1.0 + ROUNDING);
        let fits = with_it <= plan.left;
        *taken = select(*taken, with_it, fits);
        affordable = select(affordable, fits, i == place.number);
    }
    let fine = vec4(is_crowd(cell)) | declined(plan, mine.first, classes.first, affordable);
    let coarse = !fine & declined(plan, mine.second, classes.second, affordable);
    note_column(place.number, place.column, fine, coarse, seen, mine.first > vec4(0.0));
    workgroupBarrier();
    if place.column == 0u && cell.exists {
        file_cell(cell.cell, place.number);
    }
    workgroupBarrier();
}

// Takes offers in all layers before `end_layer`; returns what the marginal ones cost in all.
fn take_offers(place: Place, end_layer: u32, plan: Plan, lane: u32) -> f32 {
    var taken = 0.0;
    var walk = start_walk(end_layer);
    loop {
        list_filled(&walk, place.index, lane);
        loop {
            if has_group(walk) {
                take_group(&walk, place, plan, lane, &taken);
            }
            if !has_group(walk) {
                break;
            }
        }
        if !has_layers(walk) {
            break;
        }
    }
    return taken;
}

// What is charged to the rays of a column is kept for each 2 × 2 of them.
fn note_charge(index: u32, column: u32, charged: f32) {
    let parts = MOST_COLUMNS / COLUMNS;
    for (var i = 0u; i < parts; i += 1u) {
        bundle_entries[index].charged[column * parts + i] = charged;
    }
}

@compute @workgroup_size(LANES)
fn choose_levels(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let turn = chunk.first_turn + flat(workgroup);
    if turn >= chunk.end_turn {
        return;
    }
    let index = bundle_of(turn);
    let corner = corner_of(index);
    let place = Place(index, ray_slope(frame, corner + 3.5), lane / COLUMNS, lane % COLUMNS);
    clear_spending(lane);
    var front = Front(select(0.0, 1.0, column_in_picture(corner, place.column)), 0.0);
    let end_layer = offer_all(place, column_at(place.column, place.axis), lane, &front);
    // Cells' entries were written by one lane each.
    storageBarrier();
    workgroupBarrier();
    let plan = plan_column(place.column, front.reserve);
    let taken = take_offers(place, end_layer, plan, lane);
    if place.number == 0u {
        let charged = plan.spent + taken + front.reserve;
        atomicMax(&counters[LARGEST_CHARGE], bitcast<u32>(charged));
        note_charge(index, place.column, charged);
    }
    if lane == 0u {
        bundle_entries[index].end_layer = end_layer;
    }
}
