// A look ahead over a stretch of sixteen filled cells of a bundle: what each is as a whole, and the bricks of those
// that are smooth, by sheaves.
//
// Four lanes have the same cell, and a sheaf of it each.

const STRETCH_CELLS: u32 = 16u;
const SHEAVES: u32 = 4u;

// How far samples of a sheaf lie from the middle of a brick at most, in radii of particles, for it to tell much of what
// columns would; and what it may lose, by a rough guess. (Measured: more, and more is sampled for it than it saves.)
const NEAR: f32 = 0.21;
const SMOOTH: f32 = 2e-4;

// Whether sheaves are likely to do. What poly6 leaves out is of the fourth order.
fn is_smooth(whole: Whole, axis: vec2<f32>) -> bool {
    let reach = column_about(vec2(0.0), SHEAF_ASIDE, axis).reach.w * whole.finest;
    let left_out = reach * reach * reach * select(1.0, reach, has_cubic());
    return reach < NEAR && whole.spread * left_out < SMOOTH;
}

// Looks at the cells from the walk's next one on. All lanes together.
fn survey(walk: Walk, index: u32, axis: vec2<f32>, lane: u32) {
    let cell = listed_cell(walk, index, lane / SHEAVES);
    let sheaf = sheaf_at(lane % SHEAVES, axis);
    var entry = cell_values[cell.cell];
    let analysed = cell.exists && !is_crowd(cell);
    let unknown = analysed && entry.slot == UNKNOWN;
    // Read by all before it is written by one.
    let whole = whole_of(cell, unknown, lane);
    if unknown {
        let state = select(BY_COLUMNS, BY_SHEAVES, is_smooth(whole, axis));
        entry = CellEntry(whole.values, state, 0u, vec2(0u), vec2(0u));
    }
    let wanted = analysed && entry.slot == BY_SHEAVES && !is_transparent(entry.values);
    let most = most_of(cell, wanted, lane);
    for (var once = 0u; once < min(most, 1u); once += 1u) {
        if wanted && lane % SHEAVES == 0u {
            slots[lane / SHEAVES] = atomicAdd(&slots_taken, 1u);
        }
        let reference = reference_in(cell, entry.values.x);
        let expansions = expand(cell, reference, wanted, most, axis, sheaf, SHEAVES, lane);
        let slot = slots[lane / SHEAVES];
        for (var i = 0u; i < SHEAF_COLUMNS; i += 1u) {
            let number = lane % SHEAVES * SHEAF_COLUMNS + i;
            let column = column_at(number, axis);
            let values = field_values_of(moved_expansions(expansions, move_to(column, sheaf)), column, reference);
            if wanted {
                bricks[slot * COLUMNS + number] = values;
            }
        }
        entry.slot = select(entry.slot, slot + FIRST_SLOT, wanted);
        settle_expansions(lane);
    }
    if lane % SHEAVES == 0u && cell.exists {
        cell_values[cell.cell] = entry;
    }
    // What four lanes wrote is read by sixteen others.
    storageBarrier();
    workgroupBarrier();
}
