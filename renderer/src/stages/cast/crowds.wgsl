// Sums over the references of crowded cells, ahead of the casting: a workgroup a portion, a lane a ray.
// So no workgroup is at it for long, however many particles are in one place.

@compute @workgroup_size(LANES)
fn sum_portions(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    // Turns of this stage are portions.
    let number = chunk.first_turn + flat(workgroup);
    if number >= chunk.end_turn {
        return;
    }
    let cell = portions[number].x;
    let first = portions[number].y;
    let end = min(first + CROWD, cells[cell]);
    let axis = ray_slope(frame, corner_of(cell / tile.layers) + 3.5);
    let depths = layer_depth[tile.first_layer + cell % tile.layers];
    let middle = vec3(depths.x * axis, depths.y);
    let reference = reference_of(first_of_cell(cell));
    let from_axis = ray_from_axis(lane);
    let direction = vec3(axis + from_axis, 1.0);
    let direction_squared = dot(direction, direction);
    let at = frame.sample_offset;
    var w0 = vec4(0.0); var w1 = vec4(0.0); var w2 = vec4(0.0); var w3 = vec4(0.0);
    var q0 = vec4(0.0); var q1 = vec4(0.0); var q2 = vec4(0.0); var q3 = vec4(0.0);
    var count = vec2(0u);
    for (var base = first; base < end; base += LANES) {
        if base + lane < end {
            load_particle(base + lane, lane, middle, depths.x, reference);
        }
        workgroupBarrier();
        let loaded = min(LANES, end - base);
        for (var i = 0u; i < loaded; i += 1u) {
            let arc = arc_through(balls[i], from_axis, direction, direction_squared);
            if arc.top <= 0.0 {
                continue;
            }
            count += add_samples(at[0], arc, loads[i], &w0, &q0);
            count += add_samples(at[1], arc, loads[i], &w1, &q1);
            count += add_samples(at[2], arc, loads[i], &w2, &q2);
            count += add_samples(at[3], arc, loads[i], &w3, &q3);
        }
        workgroupBarrier();
    }
    portion_sums[number * LANES + lane] = array(w0, w1, w2, w3, q0, q1, q2, q3);
    add_to_tally(0u, count.x);
    if COUNT_INSIDE { add_to_tally(2u, count.y); }
    workgroupBarrier();
    if lane == 0u {
        settle_tally(0u, EVALUATIONS);
        if COUNT_INSIDE { settle_tally(2u, EVALUATIONS_INSIDE); }
    }
}
