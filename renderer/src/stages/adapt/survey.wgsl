// A look ahead over a stretch of sixteen filled cells of a bundle: what each is as a whole, whether it is seen at all,
// and how its bricks are to be bounded. Four lanes have the same cell.

const STRETCH_CELLS: u32 = 16u;

// Cells of the stretch, as bits: those of which something may be seen, and those of them whose bricks are to be
// bounded by columns, by sheaves, and as one sheaf.
var<workgroup> visible_cells: atomic<u32>;
var<workgroup> cells_by_columns: atomic<u32>;
var<workgroup> cells_by_sheaves: atomic<u32>;
var<workgroup> cells_as_sheaf: atomic<u32>;

// How far samples of a sheaf lie from the middle of a brick at most, in radii of particles, for it to tell much of what
// columns would; and what it may lose, by a rough guess, where it is one of four columns, and where it is all of a cell.
// (Measured: more, and more is sampled for it than it saves.)
const NEAR: f32 = 0.21;
const LOSS_OF_FOUR: f32 = 2e-4;
const LOSS_OF_ALL: f32 = 1e-5;

// Whether sheaves of so many columns are likely to do. What poly6 leaves out is of the fourth order.
fn is_smooth(whole: Whole, columns: u32, loss: f32, axis: vec2<f32>) -> bool {
    let reach = bundle_of_columns(vec2(0.0), columns, axis).reach.w * whole.finest;
    let left_out = reach * reach * reach * select(1.0, reach, has_cubic());
    return reach < NEAR && whole.spread * left_out < loss;
}

// How the bricks of a cell are to be bounded.
fn way_to_bound(whole: Whole, axis: vec2<f32>) -> u32 {
    if !HAS_SHEAVES {
        return BY_COLUMNS;
    }
    let by_sheaves = is_smooth(whole, SHEAF_COLUMNS, LOSS_OF_FOUR, axis);
    let as_sheaf = whole.is_amid && is_smooth(whole, COLUMNS, LOSS_OF_ALL, axis);
    return select(select(BY_COLUMNS, BY_SHEAVES, by_sheaves), AS_SHEAF, as_sheaf);
}

// Nothing is known of a crowded cell: it may let all light through, and is sampled as a whole.
fn is_crowd(cell: Cell) -> bool {
    return cell.end - cell.first > CROWD;
}

fn clear_stretch(lane: u32) {
    if lane == 0u {
        atomicStore(&visible_cells, 0u);
        atomicStore(&cells_by_columns, 0u);
        atomicStore(&cells_by_sheaves, 0u);
        atomicStore(&cells_as_sheaf, 0u);
    }
}

// Looks at the cells from the walk's next one on. All lanes together.
fn survey(walk: Walk, index: u32, axis: vec2<f32>, lane: u32) {
    let number = lane / LANES_OF_WHOLE;
    let cell = listed_cell(walk, index, number);
    var entry = cell_values[cell.cell];
    let analysed = cell.exists && !is_crowd(cell);
    let unknown = analysed && entry.slot == UNKNOWN;
    clear_stretch(lane);
    // Read by all before it is written by one.
    let whole = whole_of(cell, unknown, axis, lane);
    if unknown {
        entry = CellEntry(whole.values, way_to_bound(whole, axis), 0u, vec2(0u), vec2(0u));
    }
    let visible = analysed && !is_transparent(entry.values);
    if lane % LANES_OF_WHOLE == 0u {
        let bit = select(0u, 1u << number, visible);
        atomicOr(&visible_cells, bit);
        atomicOr(&cells_by_columns, select(0u, bit, entry.slot == BY_COLUMNS));
        atomicOr(&cells_by_sheaves, select(0u, bit, entry.slot == BY_SHEAVES));
        atomicOr(&cells_as_sheaf, select(0u, bit, entry.slot == AS_SHEAF));
        if unknown {
            cell_values[cell.cell] = entry;
        }
    }
    storageBarrier();
    workgroupBarrier();
}
