// The quantity's bounds in the bricks of cells, found out and kept: by columns of a group of cells, or by sheaves of
// sixteen cells at a time. So each lane has a column or a sheaf, of four columns or of all.

// The lane's part in bounding bricks: some columns of a cell that is loaded.
struct Task {
    wanted: bool,
    cell: Cell,
    number: u32,
    // The first column, and how many there are.
    first_column: u32,
    columns: u32,
}

// The sums of the lane's columns, taken together, over the particles of its cell, where it is wanted. `most`: that any
// cell has. All lanes together.
fn expand(task: Task, loader: Loader, around: Column, reference: Quantity, most: u32, axis: vec2<f32>) -> Expansions {
    let first_ball = task.number * BATCH;
    var expansions = no_expansions();
    var evaluations = 0u;
    var base = 0u;
    loop {
        load_batch(loader, reference, base, axis);
        workgroupBarrier();
        let end = first_ball + select(0u, loaded_of(task.cell, base), task.wanted);
        var particle = first_ball;
        loop {
            if particle < end {
                evaluations += add_particle(&expansions, around, balls[particle], loads[particle]);
            }
            particle += 1u;
            if particle >= end {
                break;
            }
        }
        workgroupBarrier();
        base += BATCH;
        if base >= most {
            break;
        }
    }
    add_to_tally(0u, evaluations);
    return expansions;
}

fn reference_of_bounds(cell: Cell) -> Quantity {
    return reference_in(cell, cell_values[cell.cell].values.x);
}

// Bounds the bricks of some cells. All lanes together.
fn bound_bricks(task: Task, loader: Loader, axis: vec2<f32>, lane: u32) {
    let around = bundle_of_columns(axis_of_columns(task.first_column, task.columns), task.columns, axis);
    let most = start_loading(loader, lane);
    let expansions = expand(task, loader, around, reference_of_bounds(loader.cell), most, axis);
    let reference = reference_of_bounds(task.cell);
    let place = slots[task.number] * COLUMNS;
    let end = select(0u, task.columns, task.wanted);
    var i = 0u;
    loop {
        let column = column_at(task.first_column + i, axis);
        let values = field_values_of(moved_expansions(expansions, move_to(column, around)), column, reference);
        if i < end {
            bricks[place + task.first_column + i] = values;
        }
        i += 1u;
        if i >= end {
            break;
        }
    }
    // What some lanes write is read by others, and all have added to the tally.
    storageBarrier();
    workgroupBarrier();
    if loader.wanted && loader.lane == 0u {
        cell_values[loader.cell.cell].slot = slots[loader.number] + FIRST_SLOT;
    }
    if lane == 0u {
        settle_tally(0u, EVALUATIONS_OF_BOUNDS);
    }
    storageBarrier();
    workgroupBarrier();
}

// A lane's part where some cells of a stretch go by sheaves of four columns, a lane each, and behind those others as one
// sheaf each.
fn task_of_sheaves(walk: Walk, index: u32, by_sheaves: u32, as_sheaf: u32, lane: u32) -> Task {
    let lanes = SHEAVES * countOneBits(by_sheaves);
    let is_whole = lane >= lanes;
    let left = without_first(
        select(by_sheaves, as_sheaf, is_whole),
        select(lane / SHEAVES, lane - lanes, is_whole),
    );
    let number = min(firstTrailingBit(left), STRETCH_CELLS - 1u);
    return Task(
        left != 0u,
        listed_cell(walk, index, number),
        number,
        select(lane % SHEAVES * SHEAF_COLUMNS, 0u, is_whole),
        select(SHEAF_COLUMNS, COLUMNS, is_whole),
    );
}

// Cells of a stretch, as bits, without so many of the first.
fn without_first(stretch: u32, count: u32) -> u32 {
    var left = stretch;
    for (var i = 0u; i < min(count, STRETCH_CELLS); i += 1u) {
        left &= left - 1u;
    }
    return left;
}

// Bounds the bricks of all cells of the next stretch that go by sheaves.
fn bound_stretch(walk: Walk, index: u32, axis: vec2<f32>, lane: u32) {
    let by_sheaves = workgroupUniformLoad(&cells_by_sheaves);
    let as_sheaf = workgroupUniformLoad(&cells_as_sheaf);
    if (by_sheaves | as_sheaf) != 0u {
        let loader = loader_of(walk, index, LANES / STRETCH_CELLS, by_sheaves | as_sheaf, lane);
        bound_bricks(task_of_sheaves(walk, index, by_sheaves, as_sheaf, lane), loader, axis, lane);
    }
}

// The bits of the walk's next group among those of its stretch.
fn of_group(cells: u32, walk: Walk) -> u32 {
    return cells >> (walk.next % STRETCH_CELLS) & ((1u << GROUP_CELLS) - 1u);
}

// Bounds the bricks of those cells of the next group that go by columns, of which bits tell; returns the others' bits.
fn bound_group(walk: Walk, by_columns: u32, index: u32, axis: vec2<f32>, lane: u32) -> u32 {
    let wanted = of_group(by_columns, walk);
    if wanted != 0u {
        let loader = loader_of(walk, index, COLUMNS, wanted, lane);
        bound_bricks(Task(loader.wanted, loader.cell, loader.number, lane % COLUMNS, 1u), loader, axis, lane);
    }
    return by_columns & ~(wanted << (walk.next % STRETCH_CELLS));
}

// Values of a column of the cell that is number `place` of the walk's, where anything is seen there.
fn values_in_cell(place: u32, slot: u32, column: u32) -> FieldValues {
    var values = no_field_values();
    if (atomicLoad(&visible_cells) >> (place % STRETCH_CELLS) & 1u) == 1u {
        values = bricks[(slot - FIRST_SLOT) * COLUMNS + column];
    }
    return values;
}
