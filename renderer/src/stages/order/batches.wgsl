// Puts the references of cells in order, as many cells at a time as shared memory holds. A workgroup
// takes a bundle, eight lanes a cell.
//
// Keys are as good as random: those of a cell of n references fall into n buckets, one each more or
// less, which are in order among themselves. What is left is to look for a key's place in its bucket.

const LANES: u32 = 64u;
const LANES_OF_CELL: u32 = 8u;
// References of a batch. Larger cells are left to `order_large`,
const BATCH: u32 = 768u;
// and so are cells with more than this in a bucket: particles at one place.
const MOST_ALIKE: u32 = 12u;
const BUCKETS_OF_LANE: u32 = BATCH / LANES;
// The lower bits of a key give way to the number of its reference in the batch.
const NUMBER_BITS: u32 = 10u;
const NUMBERS: u32 = (1u << NUMBER_BITS) - 1u;

// Where the next cells end, from the first reference of the batch on.
var<workgroup> ends: array<u32, LANES>;
// 1 for those of them that are left to `order_large`.
var<workgroup> is_left: array<u32, LANES>;
// The batch as it was: particles, and their keys.
var<workgroup> particles: array<u32, BATCH>;
var<workgroup> keys: array<u32, BATCH>;
// For each bucket the number of its keys; then the place of its next one; at last where it ends. The
// buckets of a cell lie where its references do.
var<workgroup> counters: array<atomic<u32>, BATCH>;
// Keys bucket by bucket.
var<workgroup> in_buckets: array<u32, BATCH>;
// Keys in a lane's buckets and in those of all lanes before.
var<workgroup> sums: array<u32, LANES>;

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

// The first reference of a cell of the batch, and the one after the last.
fn references_of(cell: u32) -> vec2<u32> {
    return vec2(select(ends[max(cell, 1u) - 1u], 0u, cell == 0u), ends[cell]);
}

// The same, or none beyond the last cell.
fn references_in_batch(cell: u32, cell_count: u32) -> vec2<u32> {
    return select(vec2(0u), references_of(cell), cell < cell_count);
}

fn bucket_of(key: u32, cell: vec2<u32>) -> u32 {
    let count = cell.y - cell.x;
    // Exact, and so monotone.
    let share = f32(key >> NUMBER_BITS) * (1.0 / f32(1u << (32u - NUMBER_BITS)));
    return cell.x + min(u32(share * f32(count)), count - 1u);
}

// Lanes go through their references in two loops, of cells and of each cell's: one loop over both took the grid of a
// mixer 8 % longer on a software adapter.

// Loads the references of `cell_count` cells, from `first` on, and counts the keys of each bucket.
fn load(first: u32, cell_count: u32, lane: u32) {
    for (var i = lane; i < BATCH; i += LANES) {
        atomicStore(&counters[i], 0u);
    }
    workgroupBarrier();
    var number = lane / LANES_OF_CELL;
    loop {
        let cell = references_in_batch(number, cell_count);
        var i = cell.x + lane % LANES_OF_CELL;
        loop {
            if i < cell.y {
                let particle = pairs[first + i];
                let key = (key_of(particle) & ~NUMBERS) | i;
                particles[i] = particle;
                keys[i] = key;
                atomicAdd(&counters[bucket_of(key, cell)], 1u);
            }
            i += LANES_OF_CELL;
            if i >= cell.y {
                break;
            }
        }
        number += LANES / LANES_OF_CELL;
        if number >= cell_count {
            break;
        }
    }
    workgroupBarrier();
}

// From the number of each bucket's keys to where they begin.
fn sum_counters(cell_count: u32, lane: u32) {
    let first = BUCKETS_OF_LANE * lane;
    var sum = 0u;
    for (var bucket = first; bucket < first + BUCKETS_OF_LANE; bucket += 1u) {
        let count = atomicLoad(&counters[bucket]);
        sum += count;
        if count > MOST_ALIKE {
            is_left[cells_before(bucket, cell_count)] = 1u;
        }
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
    for (var bucket = first; bucket < first + BUCKETS_OF_LANE; bucket += 1u) {
        let count = atomicLoad(&counters[bucket]);
        atomicStore(&counters[bucket], begin);
        begin += count;
    }
    workgroupBarrier();
}

fn fill_buckets(cell_count: u32, lane: u32) {
    var number = lane / LANES_OF_CELL;
    loop {
        let cell = references_in_batch(number, cell_count);
        var i = cell.x + lane % LANES_OF_CELL;
        loop {
            if i < cell.y {
                let key = keys[i];
                in_buckets[atomicAdd(&counters[bucket_of(key, cell)], 1u)] = key;
            }
            i += LANES_OF_CELL;
            if i >= cell.y {
                break;
            }
        }
        number += LANES / LANES_OF_CELL;
        if number >= cell_count {
            break;
        }
    }
    workgroupBarrier();
}

// The place of a key among those of its bucket, once counters say where buckets end.
fn place_of(key: u32, cell: vec2<u32>) -> u32 {
    let bucket = bucket_of(key, cell);
    let begin = select(atomicLoad(&counters[max(bucket, 1u) - 1u]), 0u, bucket == 0u);
    let end = atomicLoad(&counters[bucket]);
    var place = begin;
    var has_twin = false;
    var i = begin;
    loop {
        let other = in_buckets[i];
        place += select(0u, 1u, other < key);
        has_twin = has_twin || are_twins(other, key);
        i += 1u;
        if i >= end {
            break;
        }
    }
    if has_twin {
        place = begin;
        for (var i = begin; i < end; i += 1u) {
            let other = in_buckets[i];
            let before = precedes(particles[other & NUMBERS], particles[key & NUMBERS]);
            place += select(0u, 1u, select(other < key, before, are_twins(other, key)));
        }
    }
    return place;
}

// Whether two keys differ in the number of their references alone.
fn are_twins(a: u32, b: u32) -> bool {
    return a != b && a >> NUMBER_BITS == b >> NUMBER_BITS;
}

// Cells that are left stay as they are.
fn write_back(first: u32, cell_count: u32, lane: u32) {
    var number = lane / LANES_OF_CELL;
    loop {
        let cell = references_in_batch(number, cell_count);
        let end = select(cell.y, cell.x, is_left[number] == 1u);
        var i = cell.x + lane % LANES_OF_CELL;
        loop {
            if i < end {
                let key = in_buckets[i];
                pairs[first + place_of(key, cell)] = particles[key & NUMBERS];
            }
            i += LANES_OF_CELL;
            if i >= end {
                break;
            }
        }
        number += LANES / LANES_OF_CELL;
        if number >= cell_count {
            break;
        }
    }
}

// Leaves cells, of `cell_count` from `first_cell` on, to `order_large`.
fn leave(first_cell: u32, cell_count: u32, lane: u32) {
    if lane < cell_count && is_left[lane] == 1u {
        let cell = references_of(lane);
        large[atomicAdd(&totals[LARGE_CELLS], 1u)] = first_cell + lane;
        atomicMax(&totals[LARGEST_CELL], cell.y - cell.x);
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
    loop {
        ends[lane] = cells[row + min(layer + lane, tile.layers - 1u)] - first;
        workgroupBarrier();
        let small_cells = cells_before(BATCH, min(LANES, tile.layers - layer));
        let cell_count = max(small_cells, 1u);
        let count = ends[cell_count - 1u];
        is_left[lane] = select(0u, 1u, count > BATCH);
        if count > 1u && count <= BATCH {
            load(first, cell_count, lane);
            sum_counters(cell_count, lane);
            fill_buckets(cell_count, lane);
            write_back(first, cell_count, lane);
        }
        workgroupBarrier();
        leave(row + layer, cell_count, lane);
        walked += select(count, 0u, count > CROWD);
        first += count;
        layer += cell_count;
        workgroupBarrier();
        if layer >= tile.layers {
            break;
        }
    }
    if lane == 0u {
        atomicMax(&totals[BUSIEST_BUNDLE], walked);
    }
}
