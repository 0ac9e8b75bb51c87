// World to view space: one thread a particle.

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> positions_high: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> positions_low: array<vec4<f32>>;
// Position in view space and support radius; radius 0 outside the view volume's depths.
@group(0) @binding(3) var<storage, read_write> projected: array<vec4<f32>>;
// V/h³ in common units.
@group(0) @binding(4) var<storage, read_write> weights: array<f32>;

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
    let from_eye = (high.xyz - frame.eye_high) + (low.xyz - frame.eye_low);
    let x = dot(from_eye, frame.right);
    let y = dot(from_eye, frame.up);
    let z = dot(from_eye, frame.forward);

    let radius = max(high.w, frame.radius_floor * clamp(z, frame.near, frame.far));
    let shrink = high.w / radius;
    weights[particle] = low.w * shrink * shrink * shrink;
    let outside = z + radius < frame.near || z - radius > frame.far;
    projected[particle] = vec4(x, y, z, select(radius, 0.0, outside));
}
