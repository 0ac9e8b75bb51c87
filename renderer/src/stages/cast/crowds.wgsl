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
    let reference = reference_of(first_of_cell(cell));
    let sums =
        sum_particles(cell % tile.layers, first, end, reference, axis, ray_from_axis(lane), ALL_BRICKS, lane);
    portion_sums[number * LANES + lane] =
        PortionSums(sums.w0, sums.w1, sums.w2, sums.w3, sums.q0, sums.q1, sums.q2, sums.q3);
    workgroupBarrier();
    if lane == 0u {
        settle_tally(0u, EVALUATIONS);
        if COUNT_INSIDE { settle_tally(2u, EVALUATIONS_INSIDE); }
    }
}
