// Pairs (cell, particle), as the paper makes them (HPG 2016, Sec. 6.1). Stands behind grid.wgsl, so
// that the same particles come to the same cells.
//
// A thread takes the same columns in both passes. So its pairs are counted without an atomic, a scan
// over all threads gives them their place, and columns are shared out as evenly as in grid.wgsl.

// For `count_pairs`: pairs of each thread. For `write_pairs`: where they begin.
@group(0) @binding(3) var<storage, read_write> places: array<u32>;
@group(0) @binding(4) var<storage, read_write> keys: array<u32>;
@group(0) @binding(5) var<storage, read_write> particles: array<u32>;

@compute @workgroup_size(GROUP)
fn count_pairs(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let first_particle = flat(workgroup) * GROUP;
    if first_particle >= frame.particle_count {
        return;
    }
    let columns = share_columns(first_particle + local, local);
    var count = 0u;
    for (var column = local; column < columns; column += GROUP) {
        let run = run_of(column, first_particle);
        count += run.end - run.first;
    }
    places[first_particle + local] = count;
}

@compute @workgroup_size(GROUP)
fn write_pairs(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let first_particle = flat(workgroup) * GROUP;
    if first_particle >= frame.particle_count {
        return;
    }
    let columns = share_columns(first_particle + local, local);
    var place = places[first_particle + local];
    for (var column = local; column < columns; column += GROUP) {
        let run = run_of(column, first_particle);
        for (var cell = run.first; cell < run.end; cell += 1u) {
            keys[place] = cell;
            particles[place] = run.particle;
            place += 1u;
        }
    }
}
