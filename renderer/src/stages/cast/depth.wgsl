// What is composited along rays: where their opacity arises. (colour.wgsl has the same names for colour.)
//
// In a cell, Σ T·(1 − t)·depth with depths relative to its middle, in units of that middle's depth; in a
// ray, the same with depths relative to the pivot, and Σ T·(1 − t), which keeps more digits than 1 − T where
// little is seen. Their ratio is the mean depth, from the pivot.

fn seen_of(sample: vec4<f32>, depth: f32) -> vec3<f32> {
    return vec3(depth, 0.0, 0.0);
}

fn seen_in_cell(cell: vec4<f32>, layer: u32) -> vec3<f32> {
    let middle = layer_depth[tile.first_layer + layer];
    return vec3(cell.x * middle.x + cell.a * middle.y, cell.a, 0.0);
}

// How much the mean depth may move, as a share of itself, by what comes behind the end of a ray.
const REST: f32 = 1e-6;

// The rest of a ray weighs no more than its transparency, and lies no farther than far: a colour may be
// left out earlier.
fn is_open(ray: Ray) -> bool {
    let so_far = ray.colour.x + frame.pivot_depth * ray.colour.y;
    return ray.transparency * frame.far > REST * so_far;
}
