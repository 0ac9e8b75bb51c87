// Full sampling: a workgroup takes a bundle of 8 × 8 rays from front to back, a lane one ray.

// Premultiplied linear RGB, or what depth.wgsl has in its place, and transparency, 64 pixels a bundle.
@group(0) @binding(14) var<storage, read_write> pixels: array<vec4<f32>>;

var<workgroup> open_rays: atomic<u32>;

@compute @workgroup_size(LANES)
fn cast_rays(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let turn = chunk.first_turn + flat(workgroup);
    if turn >= chunk.end_turn {
        return;
    }
    let index = bundle_of(turn);
    let corner = corner_of(index);
    let in_bundle = vec2<f32>(place_in_bundle(lane));
    let axis = ray_slope(frame, corner + 3.5);
    let from_axis = ray_from_axis(lane);

    let pixel = index * LANES + lane;
    let in_picture = all(corner + in_bundle < vec2<f32>(frame.size));
    var ray = Ray(vec3(0.0), 1.0);
    if tile.first_layer > 0u {
        let so_far = pixels[pixel];
        ray = Ray(so_far.rgb, so_far.w);
    }
    var layer = next_filled(index, 0u);
    if layer == tile.layers {
        pixels[pixel] = vec4(ray.colour, ray.transparency);
        return;
    }
    loop {
        let place = index * tile.layers + layer;
        let cell = cast_cell(layer, first_of_cell(place), cells[place], axis, from_axis, ALL_BRICKS, lane);
        ray.colour += ray.transparency * seen_in_cell(cell, layer);
        ray.transparency *= 1.0 - cell.a;
        if lane == 0u {
            atomicStore(&open_rays, 0u);
        }
        workgroupBarrier();
        if in_picture && is_open(ray) {
            atomicAdd(&open_rays, 1u);
        }
        if lane == 0u {
            settle_tally(0u, EVALUATIONS);
            if COUNT_INSIDE { settle_tally(2u, EVALUATIONS_INSIDE); }
        }
        layer = next_filled(index, layer + 1u);
        if workgroupUniformLoad(&open_rays) == 0u || layer >= tile.layers {
            break;
        }
    }
    pixels[pixel] = vec4(ray.colour, ray.transparency);
}
