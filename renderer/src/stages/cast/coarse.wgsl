// Samples a cell more coarsely along the rays: a workgroup a cell, a lane a ray, at most 8 samples.
//
// A sample of level l stands for 2^l slabs and lies on the edge in their middle (contract, section 1).

// Number of samples, their depths, and how deep the slabs are that they stand for. Beyond the last one it
// is repeated, for no depth at all.
struct Samples {
    count: u32,
    depths: array<vec4<f32>, 2>,
    spans: array<vec4<f32>, 2>,
}

fn samples_of(level: u32) -> Samples {
    let slabs = 1u << level;
    var samples = Samples(16u >> level, array(vec4(0.0), vec4(0.0)), array(vec4(0.0), vec4(0.0)));
    for (var i = 0u; i < 8u; i += 1u) {
        let first = min(i, samples.count - 1u) * slabs;
        let span = edge_of_slab(first + slabs) - edge_of_slab(first);
        samples.depths[i / 4u][i % 4u] = edge_of_slab(first + slabs / 2u);
        samples.spans[i / 4u][i % 4u] = select(0.0, span, i < samples.count);
    }
    return samples;
}

// Colour and opacity of a ray's stretch through a cell, whose particles are those from `first` to `end`.
fn cast_coarsely(layer: u32, first: u32, end: u32, samples: Samples, slope: vec2<f32>, lane: u32) -> vec4<f32> {
    let depths = layer_depth[tile.first_layer + layer];
    let middle = vec3(depths.x * slope, depths.y);
    let from_axis = ray_from_axis(lane);
    let direction = vec3(slope + from_axis, 1.0);
    let direction_squared = dot(direction, direction);
    let reference = reference_of(first);
    var w0 = vec4(0.0); var w1 = vec4(0.0);
    var q0 = vec4(0.0); var q1 = vec4(0.0);
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
            count += add_samples(samples.depths[0], arc, loads[i], &w0, &q0);
            if samples.count > 4u { count += add_samples(samples.depths[1], arc, loads[i], &w1, &q1); }
        }
        workgroupBarrier();
    }
    // Of fewer than four samples, the last is repeated.
    add_to_tally(0u, count.x / 4u * min(samples.count, 4u));
    let scale = depths.x * sqrt(direction_squared) * frame.path_scale;
    let near = composite_four(vec4(0.0), w0, q0, reference, samples.spans[0] * scale, samples.depths[0]);
    return composite_four(near, w1, q1, reference, samples.spans[1] * scale, samples.depths[1]);
}

@compute @workgroup_size(LANES)
fn sample_coarsely(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = flat(workgroup);
    if number >= work[PARTS] {
        return;
    }
    let task = task_at(PARTS, number);
    let cell = task.x;
    let samples = samples_of(cell_values[cell].class_index + 1u - CELLS_Z_ADAPTIVE);
    let slope = ray_slope(frame, corner_of(cell / tile.layers) + 3.5);
    segments[task.y * LANES + lane] =
        cast_coarsely(cell % tile.layers, first_of_cell(cell), cells[cell], samples, slope, lane);
    workgroupBarrier();
    if lane == 0u {
        settle_tally(0u, EVALUATIONS);
    }
}
