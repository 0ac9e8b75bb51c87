// What is composited along rays: colour. (depth.wgsl has the same names for depth.)

// Of a sample with this colour and opacity. `depth`: of the sample, relative to the middle of its cell.
fn seen_of(sample: vec4<f32>, depth: f32) -> vec3<f32> {
    return sample.rgb;
}

// What a ray's stretch through a cell of `layer` adds to a ray that is not dimmed yet.
fn seen_in_cell(cell: vec4<f32>, layer: u32) -> vec3<f32> {
    return cell.rgb;
}

// Whether anything can still be added to the ray.
fn is_open(ray: Ray) -> bool {
    return ray.transparency > OPAQUE;
}
