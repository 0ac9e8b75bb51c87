// Samples a cell as a whole: a workgroup a cell, a lane a ray.

struct Work {
    wholes: u32,
    parts: u32,
    sampled: u32,
}

// Colour and opacity of each ray in a sampled cell, 64 a cell.
@group(0) @binding(12) var<storage, read_write> segments: array<vec4<f32>>;
@group(0) @binding(13) var<storage, read> work: Work;
// Cell, and its place among the sampled ones.
@group(0) @binding(14) var<storage, read> wholes: array<vec2<u32>>;

@compute @workgroup_size(LANES)
fn sample_wholes(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = flat(workgroup);
    if number >= work.wholes {
        return;
    }
    let cell = wholes[number].x;
    let axis = ray_slope(frame, corner_of(cell / tile.layers) + 3.5);
    let from_axis = ray_from_axis(lane);
    let first = first_of_cell(cell);
    segments[wholes[number].y * LANES + lane] =
        cast_cell(cell % tile.layers, first, cells[cell], axis, axis + from_axis, from_axis, lane);
    workgroupBarrier();
    if lane == 0u {
        settle_tally(0u, EVALUATIONS);
        if COUNT_INSIDE { settle_tally(2u, EVALUATIONS_INSIDE); }
    }
}
