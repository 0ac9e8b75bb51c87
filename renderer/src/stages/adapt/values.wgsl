// The quantity's bounds in the bricks of cells: kept where they are known, else found out and kept.
//
// A workgroup takes four filled cells at a time: lane l has column l mod 16 of cell l/16.

var<workgroup> slots: array<u32, STRETCH_CELLS>;

// Nothing is known of a crowded cell: it may let all light through, and is sampled as a whole.
fn is_crowd(cell: Cell) -> bool {
    return cell.end - cell.first > CROWD;
}

// Values of the lane's bricks in a cell that was surveyed: kept, or found out and kept. Those of a cell that is
// transparent as a whole are not looked for. `slot`: as the cell's entry has it then.
fn values_in_cell(
    cell: Cell, axis: vec2<f32>, column: Column, lane: u32, slot: ptr<function, u32>,
) -> FieldValues {
    let number = lane / COLUMNS;
    var entry = cell_values[cell.cell];
    let transparent = !cell.exists || is_crowd(cell) || is_transparent(entry.values);
    let wanted = !transparent && entry.slot == BY_COLUMNS;
    let most = most_of(cell, wanted, lane);
    var values = no_field_values();
    for (var once = 0u; once < min(most, 1u); once += 1u) {
        let leader = wanted && lane % COLUMNS == 0u;
        if leader {
            slots[number] = atomicAdd(&slots_taken, 1u);
        }
        let reference = reference_in(cell, entry.values.x);
        let found = expand(cell, reference, wanted, most, axis, column, COLUMNS, lane);
        if wanted {
            values = field_values_of(found, column, reference);
            entry.slot = slots[number] + FIRST_SLOT;
            bricks[slots[number] * COLUMNS + lane % COLUMNS] = values;
        }
        settle_expansions(lane);
        if leader {
            cell_values[cell.cell].slot = entry.slot;
        }
    }
    *slot = entry.slot;
    if !transparent && !wanted {
        values = bricks[(entry.slot - FIRST_SLOT) * COLUMNS + lane % COLUMNS];
    }
    return values;
}
