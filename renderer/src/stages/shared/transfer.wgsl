// Transfer function and absorption. Nodes cover [0, 1] without a gap; the last one lies beyond 1.

// A texture, not a buffer: a texel is one fetch of four numbers. A row a node: the colour and opacity
// at its u; their change up to the next node; its u, 1/(u of the next node − u) or 0 at a step, and
// the u of the next node; then, for runs of 1, 2, 4, ... nodes from this one on, the least and the
// greatest of their colours and opacities, and how steep these are at most from there to the next node.

const BUCKETS: f32 = 256.0;

// The segment between two nodes in which u lies: its first node, and that node's third texel.
struct Segment {
    node: u32,
    place: vec4<f32>,
}

fn segment_at(u: f32) -> Segment {
    var node = buckets[u32(u * BUCKETS)];
    var place = vec4(0.0);
    // Mostly the first one; software adapters go once through what follows in the loop, so nothing is fetched there.
    loop {
        place = textureLoad(nodes, vec2(2u, node), 0);
        // What is no number ends here, too.
        if !(place.z <= u) {
            break;
        }
        node += 1u;
    }
    return Segment(node, place);
}

// The transfer function in a segment.
struct Piece {
    place: vec4<f32>,
    value: vec4<f32>,
    change: vec4<f32>,
}

fn piece_of(segment: Segment) -> Piece {
    let value = textureLoad(nodes, vec2(0u, segment.node), 0);
    return Piece(segment.place, value, textureLoad(nodes, vec2(1u, segment.node), 0));
}

fn piece_at(u: f32) -> Piece {
    return piece_of(segment_at(u));
}

fn on_piece(piece: Piece, u: f32) -> vec4<f32> {
    return piece.value + ((u - piece.place.x) * piece.place.y) * piece.change;
}

fn value_in(segment: Segment, u: f32) -> vec4<f32> {
    return on_piece(piece_of(segment), u);
}

// Colour and opacity at u in [0, 1].
fn transfer_at(u: f32) -> vec4<f32> {
    return value_in(segment_at(u), u);
}

// A column each for those of four `places` in [0, 1] that are `wanted`; zero for the others. One look-up does for all
// that lie in a segment, as neighbouring samples mostly do.
fn transfer_at_four(places: vec4<f32>, wanted: vec4<bool>) -> mat4x4<f32> {
    var result = mat4x4<f32>();
    var left = wanted;
    let u = select(vec4(0.0), places, wanted);
    loop {
        let next = left & vec4(true, !left.x, !(left.x || left.y), !(left.x || left.y || left.z));
        let piece = piece_at(select(select(select(u.w, u.z, next.z), u.y, next.y), u.x, next.x));
        let here = left & u >= vec4(piece.place.x) & u < vec4(piece.place.z);
        result[0] = select(result[0], on_piece(piece, u.x), here.x);
        result[1] = select(result[1], on_piece(piece, u.y), here.y);
        result[2] = select(result[2], on_piece(piece, u.z), here.z);
        result[3] = select(result[3], on_piece(piece, u.w), here.w);
        left &= !(here | next);
        // At the end, so that software adapters do not fetch once more.
        if !any(left) {
            break;
        }
    }
    return result;
}

// Least and greatest of each of four channels.
struct Extremes {
    low: vec4<f32>,
    high: vec4<f32>,
}

// The first texel of a row in which the extremes of 1, 2, 4, ... nodes from there on stand, and how many
// texels each of these runs has.
const EXTREMES: u32 = 3u;
const RUN: u32 = 3u;

// Bounds of colour and opacity over [low, high] in [0, 1]: at the ends, and at the nodes between
// them, which two overlapping runs of a power of two cover. Widened by the rounding of `value_in`.
fn transfer_range(low: f32, high: f32) -> Extremes {
    return extremes_between(segment_at(low), low, segment_at(high), high);
}

fn extremes_between(begin: Segment, low: f32, end: Segment, high: f32) -> Extremes {
    let a = value_in(begin, low);
    let b = value_in(end, high);
    var least = min(a, b);
    var greatest = max(a, b);
    let between = end.node - begin.node;
    if between > 0u {
        let level = firstLeadingBit(between);
        let texel = EXTREMES + RUN * level;
        let first = begin.node + 1u;
        let second = end.node + 1u - (1u << level);
        least = min(least, min(textureLoad(nodes, vec2(texel, first), 0), textureLoad(nodes, vec2(texel, second), 0)));
        greatest = max(
            greatest,
            max(textureLoad(nodes, vec2(texel + 1u, first), 0), textureLoad(nodes, vec2(texel + 1u, second), 0)),
        );
    }
    return Extremes(max(least * (1.0 - ROUNDING), vec4(0.0)), min(greatest * (1.0 + ROUNDING), vec4(1.0)));
}

// Bound of the change of colour and opacity by u, anywhere in the segments from `begin` to `end`.
fn steepness_between(begin: Segment, end: Segment) -> vec4<f32> {
    let segments = end.node + 1u - begin.node;
    let level = firstLeadingBit(segments);
    let texel = EXTREMES + RUN * level + 2u;
    let second = begin.node + segments - (1u << level);
    let steepest = max(textureLoad(nodes, vec2(texel, begin.node), 0), textureLoad(nodes, vec2(texel, second), 0));
    return steepest * (1.0 + ROUNDING);
}

// Relative error of a value of the transfer function, and of an opacity.
const ROUNDING: f32 = 4e-6;

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
