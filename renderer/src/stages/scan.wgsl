// Exclusive prefix sums in place, level by level: `scan` sums blocks and leaves each block's total
// one level up, `add` brings the totals before a block back down.

struct Level {
    // Where this level begins in `sums`, where the next one begins, and how many numbers this one has.
    begin: u32,
    next: u32,
    length: u32,
    // 1 on the level of the cells: count those that are not empty.
    count_cells: u32,
}

@group(0) @binding(0) var<uniform> level: Level;
@group(0) @binding(1) var<storage, read_write> sums: array<u32>;
// References in all, cells that hold any.
@group(0) @binding(2) var<storage, read_write> totals: array<atomic<u32>, 4>;

const GROUP: u32 = 256u;
const PER_THREAD: u32 = 8u;
const BLOCK: u32 = GROUP * PER_THREAD;

var<workgroup> partial: array<u32, GROUP>;
var<workgroup> occupied: atomic<u32>;

// Sums stop at the largest number instead of wrapping, so that too many references are seen as such.
fn saturating(a: u32, b: u32) -> u32 {
    let sum = a + b;
    return select(sum, 0xffffffffu, sum < a);
}

@compute @workgroup_size(GROUP)
fn scan(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let block = flat(workgroup);
    if block * BLOCK >= level.length {
        return;
    }
    let first = block * BLOCK + local * PER_THREAD;
    var sum = 0u;
    var filled = 0u;
    var values: array<u32, PER_THREAD>;
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        values[i] = sum;
        if first + i < level.length {
            let value = sums[level.begin + first + i];
            sum = saturating(sum, value);
            filled += select(0u, 1u, value > 0u);
        }
    }
    partial[local] = sum;
    atomicAdd(&occupied, filled);
    workgroupBarrier();
    for (var step = 1u; step < GROUP; step *= 2u) {
        var before = 0u;
        if local >= step {
            before = partial[local - step];
        }
        workgroupBarrier();
        partial[local] = saturating(partial[local], before);
        workgroupBarrier();
    }
    let before = select(partial[max(local, 1u) - 1u], 0u, local == 0u);
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        if first + i < level.length {
            sums[level.begin + first + i] = saturating(before, values[i]);
        }
    }
    if local == 0u {
        sums[level.next + block] = partial[GROUP - 1u];
        if level.count_cells == 1u {
            atomicAdd(&totals[1], atomicLoad(&occupied));
        }
        if level.length <= BLOCK {
            atomicStore(&totals[0], partial[GROUP - 1u]);
        }
    }
}

@compute @workgroup_size(GROUP)
fn add(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let block = flat(workgroup);
    if block * BLOCK >= level.length {
        return;
    }
    let before = sums[level.next + block];
    let first = block * BLOCK + local * PER_THREAD;
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        if first + i < level.length {
            sums[level.begin + first + i] = saturating(before, sums[level.begin + first + i]);
        }
    }
}
