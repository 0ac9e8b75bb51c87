// Puts the references of large cells in order, in place: a workgroup a cell.
//
// By a bitonic sort whose comparisons all point the same way (Batcher's network with the first half of
// each merge mirrored): missing elements at the end then count as larger than all others, and numbers of
// elements need not be powers of two.

const LANES: u32 = 256u;
// Cells with more stay as they are: one workgroup would be at it for too long.
const MOST: u32 = 131072u;

fn order_pair(a: u32, b: u32) {
    let particles = vec2(pairs[a], pairs[b]);
    let keys = vec2(key_of(particles.x), key_of(particles.y));
    var swapped = keys.y < keys.x;
    if keys.x == keys.y {
        swapped = precedes(particles.y, particles.x);
    }
    if swapped {
        pairs[a] = particles.y;
        pairs[b] = particles.x;
    }
}

// One step of the network: element a of each pair and its partner, which may be missing.
fn step(first: u32, count: u32, half: u32, mirrored: bool, lane: u32) {
    // Elements in blocks of two halves; a half's last may be the last that there is.
    let elements = (count + 2u * half - 1u) / (2u * half) * half;
    for (var i = lane; i < elements; i += LANES) {
        let block = i / half * half * 2u;
        let place = i % half;
        let a = block + place;
        let b = select(a + half, block + 2u * half - 1u - place, mirrored);
        if b < count {
            order_pair(first + a, first + b);
        }
    }
    storageBarrier();
    workgroupBarrier();
}

@compute @workgroup_size(LANES)
fn order_large(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = flat(workgroup);
    if number >= atomicLoad(&totals[LARGE_CELLS]) {
        return;
    }
    let cell = large[number];
    let first = select(cells[max(cell, 1u) - 1u], 0u, cell == 0u);
    let count = cells[cell] - first;
    if count > MOST {
        return;
    }
    for (var sorted = 1u; sorted < count; sorted *= 2u) {
        step(first, count, sorted, true, lane);
        for (var half = sorted / 2u; half > 0u; half /= 2u) {
            step(first, count, half, false, lane);
        }
    }
}
