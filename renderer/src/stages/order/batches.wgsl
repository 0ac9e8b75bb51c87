// Puts the references of cells in order, as many cells at a time as shared memory holds. A workgroup
// takes a bundle.
//
// Keys are as good as random: those of a cell of n references fall into n buckets, one each more or
// less, which are in order among themselves. What is left is to look for its place in a bucket.

const LANES: u32 = 64u;
// References of a batch. Larger cells are left to `order_large`,
const BATCH: u32 = 512u;
// and so are cells with more than this in a bucket: particles at one place.
const MOST_ALIKE: u32 = 32u;
const PER_LANE: u32 = BATCH / LANES;

// Where the next cells end, from the first reference of the batch on.
var<workgroup> ends: array<u32, LANES>;
// The batch as it was: particles, their keys and buckets.
var<workgroup> particles: array<u32, BATCH>;
var<workgroup> keys: array<u32, BATCH>;
var<workgroup> buckets: array<u32, BATCH>;
// For each bucket the number of its members; then the place of its next one; at last where it ends.
var<workgroup> counters: array<atomic<u32>, BATCH>;
// Numbers of the batch's references, bucket by bucket.
var<workgroup> members: array<u32, BATCH>;
// Members of a lane's buckets and of those of all lanes before.
var<workgroup> sums: array<u32, LANES>;
// 1 for the cells of the batch that are left to `order_large`.
var<workgroup> is_left: array<u32, LANES>;

// How many of the first `count` cells end at or before a reference: the number of its cell.
fn cells_before(reference: u32, count: u32) -> u32 {
    var low = 0u;
    var high = count;
    while low < high {
        let middle = (low + high) / 2u;
        if ends[middle] <= reference {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// Those of a cell lie where its references do.
fn bucket_of(key: u32, reference: u32, cell_count: u32) -> u32 {
    let cell = cells_before(reference, cell_count);
    let begin = select(ends[max(cell, 1u) - 1u], 0u, cell == 0u);
    let count = ends[cell] - begin;
    // Exact up to 2²⁴, and monotone.
    let share = f32(key >> 8u) * (1.0 / 16777216.0);
    return begin + min(u32(share * f32(count)), count - 1u);
}

fn load(first: u32, count: u32, cell_count: u32, lane: u32) {
    for (var i = lane; i < BATCH; i += LANES) {
        atomicStore(&counters[i], 0u);
    }
    workgroupBarrier();
    for (var i = lane; i < count; i += LANES) {
        let particle = pairs[first + i];
        let key = key_of(particle);
        let bucket = bucket_of(key, i, cell_count);
        particles[i] = particle;
        keys[i] = key;
        buckets[i] = bucket;
        atomicAdd(&counters[bucket], 1u);
    }
    workgroupBarrier();
}

// Leaves the cells of the lane's buckets that are too full.
fn leave_full(cell_count: u32, lane: u32) {
    for (var bucket = PER_LANE * lane; bucket < PER_LANE * (lane + 1u); bucket += 1u) {
        if atomicLoad(&counters[bucket]) > MOST_ALIKE {
            is_left[cells_before(bucket, cell_count)] = 1u;
        }
    }
}

// From the number of each bucket's members to where they begin.
fn sum_counters(cell_count: u32, lane: u32) {
    var sum = 0u;
    var most = 0u;
    for (var i = 0u; i < PER_LANE; i += 1u) {
        let members = atomicLoad(&counters[PER_LANE * lane + i]);
        sum += members;
        most = max(most, members);
    }
    if most > MOST_ALIKE {
        leave_full(cell_count, lane);
    }
    sums[lane] = sum;
    workgroupBarrier();
    for (var step = 1u; step < LANES; step *= 2u) {
        let before = select(0u, sums[max(lane, step) - step], lane >= step);
        workgroupBarrier();
        sums[lane] += before;
        workgroupBarrier();
    }
    var begin = sums[lane] - sum;
    for (var i = 0u; i < PER_LANE; i += 1u) {
        begin += atomicExchange(&counters[PER_LANE * lane + i], begin);
    }
    workgroupBarrier();
}

// Where a member of a bucket is to be, once counters say where buckets end.
fn place_of(member: u32) -> u32 {
    let reference = members[member];
    let bucket = buckets[reference];
    let begin = select(atomicLoad(&counters[max(bucket, 1u) - 1u]), 0u, bucket == 0u);
    let end = atomicLoad(&counters[bucket]);
    if end - begin > MOST_ALIKE {
        // Of a cell that is left: it may stay.
        return member;
    }
    let key = keys[reference];
    var place = begin;
    var alike = 0u;
    for (var i = begin; i < end; i += 1u) {
        let other = keys[members[i]];
        place += select(0u, 1u, other < key);
        alike += select(0u, 1u, other == key);
    }
    if alike > 1u {
        for (var i = begin; i < end; i += 1u) {
            let other = members[i];
            if keys[other] == key && precedes(particles[other], particles[reference]) {
                place += 1u;
            }
        }
    }
    return place;
}

// Puts the references of `cell_count` cells in order, `count` of them from `first` on.
fn order_batch(first: u32, count: u32, cell_count: u32, lane: u32) {
    load(first, count, cell_count, lane);
    sum_counters(cell_count, lane);
    for (var i = lane; i < count; i += LANES) {
        members[atomicAdd(&counters[buckets[i]], 1u)] = i;
    }
    workgroupBarrier();
    for (var i = lane; i < count; i += LANES) {
        pairs[first + place_of(i)] = particles[members[i]];
    }
    workgroupBarrier();
}

// Leaves cells, of `cell_count` from `first_cell` on, to `order_large`.
fn leave(first_cell: u32, cell_count: u32, lane: u32) {
    if lane < cell_count && is_left[lane] == 1u {
        let count = ends[lane] - select(ends[max(lane, 1u) - 1u], 0u, lane == 0u);
        large[atomicAdd(&totals[LARGE_CELLS], 1u)] = first_cell + lane;
        atomicMax(&totals[LARGEST_CELL], count);
    }
}

@compute @workgroup_size(LANES)
fn order_batches(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = flat(workgroup);
    if index >= tile.count.x * tile.count.y {
        return;
    }
    let row = index * tile.layers;
    // The grid is built again where it does not fit.
    if cells[row + tile.layers - 1u] > tile.pair_capacity {
        return;
    }
    var first = select(cells[max(row, 1u) - 1u], 0u, row == 0u);
    var walked = 0u;
    var layer = 0u;
    while layer < tile.layers {
        ends[lane] = cells[row + min(layer + lane, tile.layers - 1u)] - first;
        is_left[lane] = 0u;
        workgroupBarrier();
        let small_cells = cells_before(BATCH, min(LANES, tile.layers - layer));
        let cell_count = max(small_cells, 1u);
        let count = ends[cell_count - 1u];
        if count > BATCH {
            is_left[lane] = 1u;
        } else if count > 1u {
            order_batch(first, count, cell_count, lane);
        }
        leave(row + layer, cell_count, lane);
        walked += select(count, 0u, count > CROWD);
        first += count;
        layer += cell_count;
        workgroupBarrier();
    }
    if lane == 0u {
        atomicMax(&totals[BUSIEST_BUNDLE], walked);
    }
}
