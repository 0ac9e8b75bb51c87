// The quantity's bounds in the bricks of cells, found out and kept: by columns of four cells, or by sheaves of sixteen
// cells at a time. So each lane has a column or a sheaf.

// Particles of a cell that are loaded at a time.
const BATCH: u32 = 16u;

var<workgroup> balls: array<vec4<f32>, BATCH * STRETCH_CELLS>;
// Weight, and quantity relative to the cell's reference.
var<workgroup> loads: array<Load, BATCH * STRETCH_CELLS>;
var<workgroup> most_particles: atomic<u32>;
var<workgroup> slots: array<u32, STRETCH_CELLS>;

// Which of so many particles that are loaded may reach the column, as bits. Found out before any of them is
// added: lanes that run together then each add one of theirs, not all the same one.
fn met_by(column: Column, first: u32, loaded: u32) -> u32 {
    var met = 0u;
    var i = 0u;
    loop {
        met |= select(0u, 1u << i, i < loaded && may_reach(column, balls[first + i]));
        i += 1u;
        if i >= loaded {
            break;
        }
    }
    return met;
}

// The lane's part in bounding bricks: some columns of a cell.
struct Task {
    wanted: bool,
    cell: Cell,
    // Place of the cell among those that are looked at, and how many lanes it has.
    number: u32,
    lanes: u32,
    // The first column, and how many there are.
    first_column: u32,
    columns: u32,
}

// The largest number of particles of any cell that is wanted, each of which gets a slot. All lanes together.
fn start_tasks(task: Task, lane: u32) -> u32 {
    if lane == 0u {
        atomicStore(&most_particles, 0u);
    }
    workgroupBarrier();
    if task.wanted && task.first_column == 0u {
        atomicMax(&most_particles, task.cell.end - task.cell.first);
        slots[task.number] = atomicAdd(&slots_taken, 1u);
    }
    return workgroupUniformLoad(&most_particles);
}

// The sums of the lane's columns, taken together, over the particles of its cell, where it is wanted. All lanes
// together.
//
// Quantities are taken relative to a value of the cell that does not depend on their order.
fn expand(task: Task, around: Column, reference: Quantity, most: u32, axis: vec2<f32>, lane: u32) -> Expansions {
    let depths = layer_depth[tile.first_layer + task.cell.layer];
    let middle = vec3(depths.x * axis, depths.y);
    let end = select(task.cell.first, task.cell.end, task.wanted);
    let first_ball = task.number * BATCH;
    var expansions = no_expansions();
    var evaluations = 0u;
    var base = 0u;
    loop {
        let first = task.cell.first + base;
        let loaded = min(BATCH, max(end, first) - first);
        var i = lane % task.lanes;
        loop {
            if i < loaded {
                let particle = particle_in_cell(first + i, middle, depths.x, reference);
                balls[first_ball + i] = particle.ball;
                loads[first_ball + i] = Load(particle.weight, particle.quantity);
            }
            i += task.lanes;
            if i >= loaded {
                break;
            }
        }
        workgroupBarrier();
        var met = met_by(around, first_ball, loaded);
        loop {
            if met != 0u {
                let particle = first_ball + firstTrailingBit(met);
                evaluations += add_particle(&expansions, around, balls[particle], loads[particle]);
                met &= met - 1u;
            }
            if met == 0u {
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

// Bounds the bricks of the walk's next cells that are `wanted`, as bits, so many columns at a time. All lanes together.
fn bound_bricks(walk: Walk, index: u32, axis: vec2<f32>, columns: u32, wanted: u32, lane: u32) {
    let lanes = COLUMNS / columns;
    let number = lane / lanes;
    let cell = listed_cell(walk, index, number);
    let task = Task((wanted >> number & 1u) == 1u, cell, number, lanes, lane % lanes * columns, columns);
    let around = bundle_of_columns(axis_of_columns(task.first_column, columns), columns, axis);
    let most = start_tasks(task, lane);
    let reference = reference_in(cell, cell_values[cell.cell].values.x);
    let expansions = expand(task, around, reference, most, axis, lane);
    let slot = slots[number];
    for (var i = 0u; i < columns; i += 1u) {
        let column = column_at(task.first_column + i, axis);
        let values = field_values_of(moved_expansions(expansions, move_to(column, around)), column, reference);
        if task.wanted {
            bricks[slot * COLUMNS + task.first_column + i] = values;
        }
    }
    // What some lanes write is read by others, and all have added to the tally.
    storageBarrier();
    workgroupBarrier();
    if task.wanted && task.first_column == 0u {
        cell_values[cell.cell].slot = slot + FIRST_SLOT;
    }
    if lane == 0u {
        settle_tally(0u, EVALUATIONS_OF_BOUNDS);
    }
    storageBarrier();
    workgroupBarrier();
}

// Bounds the bricks of all cells of the next stretch that go by sheaves.
fn bound_stretch(walk: Walk, index: u32, axis: vec2<f32>, lane: u32) {
    let wanted = workgroupUniformLoad(&cells_by_sheaves);
    if wanted != 0u {
        bound_bricks(walk, index, axis, SHEAF_COLUMNS, wanted, lane);
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
        bound_bricks(walk, index, axis, 1u, wanted, lane);
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
