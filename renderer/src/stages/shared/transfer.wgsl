// Transfer function and absorption. Nodes cover [0, 1] without a gap; the last one lies beyond 1.

struct Node {
    // Colour and opacity at u.
    value: vec4<f32>,
    // Their change up to the next node.
    change: vec4<f32>,
    u: f32,
    // 1/(u of the next node − u); 0 at a step.
    inverse_width: f32,
    padding: vec2<f32>,
}

const BUCKETS: f32 = 256.0;

// Colour and opacity at u in [0, 1].
fn transfer_at(u: f32) -> vec4<f32> {
    var node = buckets[u32(u * BUCKETS)];
    while nodes[node + 1u].u <= u {
        node += 1u;
    }
    let left = nodes[node];
    return left.value + ((u - left.u) * left.inverse_width) * left.change;
}

// ln(1 − α), with full relative precision for small α; very negative, but finite, for α = 1.
fn log_transparency(alpha: f32) -> f32 {
    if alpha < 0.1 {
        return -alpha * (1.0 + alpha * (1.0 / 2.0 + alpha * (1.0 / 3.0 + alpha * (1.0 / 4.0
            + alpha * (1.0 / 5.0 + alpha * (1.0 / 6.0))))));
    }
    return select(log(1.0 - alpha), -1e30, alpha >= 1.0);
}

// 1 − (1 − α)^path: the opacity of a path, in reference lengths. Full relative precision down to zero.
fn path_opacity(alpha: f32, path: f32) -> f32 {
    // Bounded, since 0·∞ has no value: exp(−200) is zero already.
    let y = min(-log_transparency(alpha) * path, 200.0);
    if y < 0.1 {
        return y * (1.0 - y * (1.0 / 2.0 - y * (1.0 / 6.0 - y * (1.0 / 24.0 - y * (1.0 / 120.0)))));
    }
    return 1.0 - exp(-y);
}
