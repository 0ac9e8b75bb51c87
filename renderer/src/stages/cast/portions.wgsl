// Sums over crowded cells, made ahead of the casting: a portion of CROWD references each.

// Cell, and first reference, in ascending order.
@group(0) @binding(12) var<storage, read> portions: array<vec2<u32>>;
// Of each of 64 rays.
@group(0) @binding(13) var<storage, read_write> portion_sums: array<PortionSums>;

// The weights at a ray's 16 samples, and those times the quantity.
struct PortionSums {
    w0: vec4<f32>, w1: vec4<f32>, w2: vec4<f32>, w3: vec4<f32>,
    q0: Charges, q1: Charges, q2: Charges, q3: Charges,
}

// Portions of the cell with the given references: the first, and the one after the last. None where the
// cell is not crowded.
fn portions_of(first: u32, end: u32) -> vec2<u32> {
    let is_crowd = end - first > CROWD;
    var low = 0u;
    var high = select(0u, tile.portions, is_crowd);
    while low < high {
        let middle = (low + high) / 2u;
        if portions[middle].y < first {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    let count = (end - first + CROWD - 1u) / CROWD;
    return vec2(low, low + select(0u, count, is_crowd));
}
