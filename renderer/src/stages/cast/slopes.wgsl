// Shows a cell in which nothing is sampled, but some bricks follow their slopes: a workgroup a cell, a lane a ray.

@compute @workgroup_size(LANES)
fn follow_slopes(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = flat(workgroup);
    if number >= work[SLOPED] {
        return;
    }
    let task = task_at(SLOPED, number);
    let cell = task.x;
    let sloped = cell_values[cell].coarse;
    let axis = ray_slope(frame, corner_of(cell / tile.layers) + 3.5);
    if lane < BRICKS {
        middles[lane] = middle_of(cell, lane % COLUMNS, lane / COLUMNS, axis);
    }
    workgroupBarrier();
    let depth = layer_depth[tile.first_layer + cell % tile.layers].x;
    let scale = path_scale_of(depth, axis + ray_from_axis(lane));
    let column = lane / COLUMN_RAYS;
    let values = bricks[place_of_column(cell, column)];
    var segment = vec4(0.0);
    var i = 0u;
    loop {
        let followed = pass_slope(segment, values, i, lane % COLUMN_RAYS, scale);
        let shown = segment + (1.0 - segment.a) * middles[COLUMNS * i + column];
        segment = select(shown, followed, is_chosen(sloped, column, i));
        i += 1u;
        if i >= BRICK_DEPTH {
            break;
        }
    }
    segments[task.y * LANES + lane] = segment;
}
