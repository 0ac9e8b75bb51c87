// World to view space: one thread a particle.

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> positions_high: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> positions_low: array<vec4<f32>>;
// Position in view space relative to the pivot, and support radius; radius 0 outside the view
// volume's depths.
@group(0) @binding(3) var<storage, read_write> projected: array<vec4<f32>>;
// V/h³ of the radius as projected, in common units.
@group(0) @binding(4) var<storage, read_write> weights: array<f32>;

// No product of a weight with a kernel value or a quantity overflows or vanishes.
const WEIGHT_LIMIT: f32 = 1e15;

@compute @workgroup_size(256)
fn project(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let particle = flat(workgroup) * 256u + local;
    if particle >= frame.particle_count {
        return;
    }
    let high = positions_high[particle];
    let low = positions_low[particle];
    let from_pivot = (high.xyz - frame.pivot_high) + (low.xyz - frame.pivot_low);
    let x = dot(from_pivot, frame.right);
    let y = dot(from_pivot, frame.up);
    let z = dot(from_pivot, frame.forward);

    let depth = clamp(z + frame.pivot_depth, frame.near, frame.far);
    let radius = max(high.w, frame.radius_floor * depth);
    let root = low.w * high.w / radius;
    weights[particle] = clamp(root * root * root, 1.0 / WEIGHT_LIMIT, WEIGHT_LIMIT);
    let outside = z + radius < frame.near_offset || z - radius > frame.far_offset;
    projected[particle] = vec4(x, y, z, select(radius, 0.0, outside));
}
