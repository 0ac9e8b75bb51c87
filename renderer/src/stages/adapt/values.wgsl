// The quantity's bounds in the bricks of cells: kept where they are known, else found out and kept.
//
// A workgroup takes four filled cells at a time: lane l has column l mod 16 of cell l/16.

// A place for each particle that is loaded: 16 of each cell.
var<workgroup> balls: array<vec4<f32>, LANES>;
// Weight, and quantity relative to the cell's reference.
var<workgroup> loads: array<Load, LANES>;
// Extremes of each cell.
var<workgroup> cell_low: array<atomic<u32>, GROUP_CELLS>;
var<workgroup> cell_high: array<atomic<u32>, GROUP_CELLS>;
var<workgroup> most_particles: atomic<u32>;
var<workgroup> slots: array<u32, GROUP_CELLS>;

// Nothing is known of a crowded cell: it may let all light through, and is sampled as a whole.
fn is_crowd(cell: Cell) -> bool {
    return cell.end - cell.first > CROWD;
}

// Values of the cells that are not known yet, from the quantities of their particles that decide the opacity.
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
        let u = for_opacity(in_range(quantity));
        low = select(min(low, u), low, is_rejected(quantity));
        high = select(max(high, u), high, is_rejected(quantity));
    }
    atomicMin(&cell_low[number], bitcast<u32>(low));
    atomicMax(&cell_high[number], bitcast<u32>(high));
    workgroupBarrier();
    let least = bitcast<f32>(atomicLoad(&cell_low[number]));
    let greatest = bitcast<f32>(atomicLoad(&cell_high[number]));
    let values = vec2(max(least - 2e-6, 0.0), min(greatest + 2e-6, 1.0));
    return select(values, EMPTY, least > greatest);
}

// Which of so many particles that are loaded may reach the column, as bits. Found out before any of them is
// added: lanes that run together then each add one of theirs, not all the same one.
fn met_by(column: Column, first: u32, loaded: u32) -> u32 {
    var met = 0u;
    for (var i = 0u; i < loaded; i += 1u) {
        met |= select(0u, 1u << i, may_reach(column, balls[first + i]));
    }
    return met;
}

// Values of the lane's bricks from the particles of its cell, where it is `wanted`. All lanes together.
//
// Their quantities are taken relative to a value of the cell that does not depend on their order.
fn expand(
    cell: Cell, reference: Quantity, wanted: bool, most: u32, axis: vec2<f32>, column: Column, lane: u32,
) -> FieldValues {
    let depths = layer_depth[tile.first_layer + cell.layer];
    let middle = vec3(depths.x * axis, depths.y);
    let end = select(cell.first, cell.end, wanted);
    let group_lane = lane / COLUMNS * COLUMNS;
    var expansion = no_expansions();
    var evaluations = 0u;
    for (var base = 0u; base < most; base += COLUMNS) {
        let place = cell.first + base + lane % COLUMNS;
        if place < end {
            let particle = particle_in_cell(place, middle, depths.x, reference);
            balls[lane] = particle.ball;
            loads[lane] = Load(particle.weight, particle.quantity);
        }
        workgroupBarrier();
        let loaded = min(COLUMNS, max(end, cell.first + base) - (cell.first + base));
        var met = met_by(column, group_lane, loaded);
        for (var left = countOneBits(met); left > 0u; left -= 1u) {
            let particle = group_lane + firstTrailingBit(met);
            evaluations += add_particle(&expansion, column, balls[particle], loads[particle]);
            met &= met - 1u;
        }
        workgroupBarrier();
    }
    add_to_tally(0u, evaluations);
    return field_values_of(expansion, column, reference);
}

// Values of the lane's bricks: kept, or found out and kept; with the slot, + 2. Those of a cell that is
// transparent as a whole are not looked for: slot 1.
fn values_in_cell(
    cell: Cell, axis: vec2<f32>, column: Column, lane: u32, slot: ptr<function, u32>,
) -> FieldValues {
    let number = lane / COLUMNS;
    let leader = lane % COLUMNS == 0u;
    var entry = cell_values[cell.cell];
    let analysed = cell.exists && !is_crowd(cell);
    let unknown = analysed && entry.slot == 0u;
    // Read by all before it is written by one.
    let extremes = find_extremes(cell, unknown, number, lane % COLUMNS);
    if unknown {
        entry = CellEntry(extremes, 1u, 0u, vec2(0u), vec2(0u));
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
    var values = no_field_values();
    for (var once = 0u; once < min(most, 1u); once += 1u) {
        let reference = reference_in(cell, entry.values.x);
        let found = expand(cell, reference, wanted, most, axis, column, lane);
        if wanted {
            values = found;
            entry.slot = slots[number] + 2u;
            bricks[slots[number] * COLUMNS + lane % COLUMNS] = values;
        }
        // All lanes have added to the tally.
        workgroupBarrier();
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

