// Transfer function and absorption. Nodes cover [0, 1] without a gap; the last one lies beyond 1.

// A texture, not a buffer: a texel is one fetch of four numbers. A row a node: the colour and opacity
// at its u; their change up to the next node; its u, 1/(u of the next node − u) or 0 at a step, and
// the u of the next node.

const BUCKETS: f32 = 256.0;

// Colour and opacity at u in [0, 1].
fn transfer_at(u: f32) -> vec4<f32> {
    var node = buckets[u32(u * BUCKETS)];
    var place = textureLoad(nodes, vec2(2u, node), 0);
    while place.z <= u {
        node += 1u;
        place = textureLoad(nodes, vec2(2u, node), 0);
    }
    let value = textureLoad(nodes, vec2(0u, node), 0);
    let change = textureLoad(nodes, vec2(1u, node), 0);
    return value + ((u - place.x) * place.y) * change;
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
