// Full sampling by a hash grid in world space: each sample looks up the particles near its own place. For
// comparison with cells along the rays, whose particles a bundle reads once for all its samples (HPG 2016,
// Sec. 6 and the last row of its table of run times).

struct HashGrid {
    // The pivot from the first corner of the grid, in the axes of the world.
    pivot: vec3<f32>,
    // Side of a cell.
    side: f32,
    // Cells in x, y and z.
    count: vec3<u32>,
    // Number of slots, a power of two, less one.
    mask: u32,
}

// A cell with particles: its number + 1, 0 in an empty slot, and its references.
struct Slot {
    key: u32,
    first: u32,
    end: u32,
}

@group(0) @binding(12) var<uniform> hash_grid: HashGrid;
@group(0) @binding(13) var<storage, read> slots: array<Slot>;
@group(0) @binding(14) var<storage, read> references: array<u32>;
// As in full.wgsl.
@group(0) @binding(15) var<storage, read_write> pixels: array<vec4<f32>>;

// As in mod.rs: Fibonacci hashing (Knuth, The Art of Computer Programming 3, Sec. 6.4).
fn slot_of(cell: u32) -> u32 {
    return (cell * 2654435769u >> 7u) & hash_grid.mask;
}

// References to the particles near a place, which is relative to the pivot and in view space.
fn references_at(place: vec3<f32>) -> vec2<u32> {
    let world = hash_grid.pivot + place.x * frame.right + place.y * frame.up + place.z * frame.forward;
    let cell = floor(world / hash_grid.side);
    if any(cell < vec3(0.0)) || any(cell >= vec3<f32>(hash_grid.count)) {
        return vec2(0u);
    }
    let at = vec3<u32>(cell);
    let number = at.x + hash_grid.count.x * (at.y + hash_grid.count.y * at.z);
    var slot = slot_of(number);
    while slots[slot].key != 0u && slots[slot].key != number + 1u {
        slot = (slot + 1u) & hash_grid.mask;
    }
    return select(vec2(slots[slot].first, slots[slot].end), vec2(0u), slots[slot].key == 0u);
}

// Adds the sample at a place to the ray; returns the evaluations that it took.
fn add_sample(ray: ptr<function, Ray>, place: vec3<f32>, path: f32) -> u32 {
    let near = references_at(place);
    var weight = 0.0;
    var charge = Quantity();
    for (var i = near.x; i < near.y; i += 1u) {
        let particle = references[i];
        let ball = projected[particle];
        let from_middle = (place - ball.xyz) / ball.w;
        let left_out = ball.w <= 0.0 || is_rejected(quantities[particle]);
        let x = select(max(1.0 - dot(from_middle, from_middle), 0.0), 0.0, left_out);
        let w = weights[particle] * kernel(vec4(x)).x;
        weight += w;
        charge += select(w * quantities[particle], Quantity(), left_out);
    }
    if weight > 0.0 {
        let sample = shade_of(charge / weight);
        let opacity = path_opacity(sample.w, path);
        (*ray).colour += (*ray).transparency * opacity * sample.rgb;
        (*ray).transparency *= 1.0 - opacity;
    }
    return near.y - near.x;
}

@compute @workgroup_size(LANES)
fn cast_by_places(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let turn = chunk.first_turn + flat(workgroup);
    if turn >= chunk.end_turn {
        return;
    }
    let index = bundle_of(turn);
    let in_bundle = vec2<f32>(place_in_bundle(lane));
    let slope = ray_slope(frame, corner_of(index) + in_bundle);
    let pixel = index * LANES + lane;
    var ray = Ray(vec3(0.0), 1.0);
    if tile.first_layer > 0u {
        ray = Ray(pixels[pixel].rgb, pixels[pixel].w);
    }
    var evaluations = 0u;
    for (var slice = 0u; slice < 16u * tile.layers && ray.transparency > OPAQUE; slice += 1u) {
        let depths = layer_depth[tile.first_layer + slice / 16u];
        let offset = depths.x * frame.sample_offset[slice / 4u % 4u][slice % 4u];
        let place = vec3(slope * (depths.x + offset), depths.y + offset);
        let path = frame.slab_depth[slice / 4u % 4u][slice % 4u] * depths.x * frame.path_scale;
        evaluations += add_sample(&ray, place, path * length(vec3(slope, 1.0)));
    }
    pixels[pixel] = vec4(ray.colour, ray.transparency);
    add_to_tally(0u, evaluations);
    workgroupBarrier();
    if lane == 0u {
        settle_tally(0u, EVALUATIONS);
    }
}
