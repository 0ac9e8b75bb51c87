// Samples most bricks of a cell: a workgroup a cell, a lane a ray.

@compute @workgroup_size(LANES)
fn sample_wholes(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = flat(workgroup);
    if number >= work[WHOLES] {
        return;
    }
    let task = task_at(WHOLES, number);
    let cell = task.x;
    let entry = cell_values[cell];
    let axis = ray_slope(frame, corner_of(cell / tile.layers) + 3.5);
    if lane < BRICKS {
        middles[lane] = middle_of(cell, lane % COLUMNS, lane / COLUMNS, axis);
    }
    let values = bricks[place_of_column(cell, lane / COLUMN_RAYS)];
    var sampled = 0u;
    for (var i = 0u; i < BRICK_DEPTH; i += 1u) {
        sampled |= select(0u, 1u << i, is_chosen(entry.sampled, lane / COLUMN_RAYS, i));
        sampled |= select(0u, 16u << i, is_chosen(entry.coarse, lane / COLUMN_RAYS, i));
        if !HAS_LEVEL_2 {
            on_slope[i] = charges_on_slope(values, i, lane % COLUMN_RAYS);
        }
    }
    workgroupBarrier();
    let from_axis = ray_from_axis(lane);
    segments[task.y * LANES + lane] =
        cast_cell(cell % tile.layers, first_of_cell(cell), cells[cell], axis, from_axis, sampled, lane);
    workgroupBarrier();
    if lane == 0u {
        settle_tally(0u, EVALUATIONS);
        if COUNT_INSIDE { settle_tally(2u, EVALUATIONS_INSIDE); }
    }
}
