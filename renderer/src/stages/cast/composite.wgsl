// Puts the cells of a bundle together, from front to back: those that were sampled, and those shown by
// the middles of their bricks. A lane a ray.

// As in adapt/levels.wgsl and cast/work.wgsl.
@group(0) @binding(12) var<storage, read_write> pixels: array<vec4<f32>>;
@group(0) @binding(13) var<storage, read> segments: array<vec4<f32>>;
@group(0) @binding(14) var<storage, read> sampled: array<u32>;
@group(0) @binding(15) var<storage, read> bundle_entries: array<BundleEntry>;
@group(0) @binding(16) var<storage, read> cell_values: array<CellEntry>;
@group(0) @binding(17) var<storage, read> shows: array<vec4<f32>>;

@compute @workgroup_size(LANES)
fn composite_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let turn = chunk.first_turn + flat(workgroup);
    if turn >= chunk.end_turn {
        return;
    }
    let index = bundle_of(turn);
    var ray = Ray(vec3(0.0), 1.0);
    let end_layer = bundle_entries[index].end_layer;
    var layer = next_filled(index, 0u);
    while layer < end_layer && ray.transparency > OPAQUE {
        let cell = index * tile.layers + layer;
        let place = sampled[cell];
        var segment = vec4(0.0);
        if place > 1u {
            segment = segments[(place - 2u) * LANES + lane];
        } else if place == 1u {
            segment = shows[(cell_values[cell].slot - FIRST_SLOT) * COLUMNS + lane / 4u];
        }
        ray.colour += ray.transparency * segment.rgb;
        ray.transparency *= 1.0 - segment.a;
        layer = next_filled(index, layer + 1u);
    }
    pixels[index * LANES + lane] = vec4(ray.colour, ray.transparency);
}
