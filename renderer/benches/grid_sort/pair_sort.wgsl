// Least-significant-digit radix sort of pairs by their keys, after Satish, Harris and Garland (IPDPS
// 2009) and Merrill and Grimshaw (2011), and the cells that the sorted keys show.
//
// A pass over one digit of four bits: `histogram` counts the digits of each block of pairs, a scan
// over digits, and blocks within a digit, gives every block the place of its first pair of each
// digit, and `reorder` ranks a block's pairs in shared memory and writes them digit by digit.

struct Sort {
    pairs: u32,
    blocks: u32,
    // Bits below the digit.
    shift: u32,
    padding: u32,
}

@group(0) @binding(0) var<uniform> sort: Sort;
@group(0) @binding(1) var<storage, read> keys: array<u32>;
@group(0) @binding(2) var<storage, read> particles: array<u32>;
// A row a digit, a column a block. From `histogram`: pairs. For `reorder`: place of the first one.
@group(0) @binding(3) var<storage, read_write> digits: array<u32>;
@group(0) @binding(4) var<storage, read_write> sorted_keys: array<u32>;
@group(0) @binding(5) var<storage, read_write> sorted_particles: array<u32>;
// First reference of each cell, and the one after its last.
@group(0) @binding(6) var<storage, read_write> bounds: array<vec2<u32>>;

const GROUP: u32 = 256u;
const PER_THREAD: u32 = 8u;
const BLOCK: u32 = GROUP * PER_THREAD;
const RADIX: u32 = 16u;
// Behind all pairs: stands last within the largest digit, and is not written.
const NO_KEY: u32 = 0xffffffffu;

fn key_at(place: u32) -> u32 {
    return select(NO_KEY, keys[min(place, sort.pairs - 1u)], place < sort.pairs);
}

fn digit_of(key: u32) -> u32 {
    return extractBits(key, sort.shift, 4u);
}

// Sixteen histograms, which neighbouring threads take in turn: where they met in one counter, they
// would wait for each other.
var<workgroup> counts: array<atomic<u32>, GROUP>;

@compute @workgroup_size(GROUP)
fn histogram(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let block = flat(workgroup);
    if block >= sort.blocks {
        return;
    }
    atomicStore(&counts[local], 0u);
    workgroupBarrier();
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        let key = key_at(block * BLOCK + i * GROUP + local);
        atomicAdd(&counts[local % RADIX * RADIX + digit_of(key)], 1u);
    }
    workgroupBarrier();
    if local < RADIX {
        var count = 0u;
        for (var copy = 0u; copy < RADIX; copy += 1u) {
            count += atomicLoad(&counts[copy * RADIX + local]);
        }
        digits[local * sort.blocks + block] = count;
    }
}

// First the counters of `rank`, then the block's keys, then its particles.
var<workgroup> words: array<u32, BLOCK>;
var<workgroup> partial: array<u32, GROUP>;
// Where each digit's pairs begin: in the block, and in the list less that.
var<workgroup> digit_begin: array<u32, RADIX>;
var<workgroup> digit_offset: array<u32, RADIX>;

// A thread's counter of a digit is half a word: digits 0 to 7 have the low halves, 8 to 15 the high.
fn counter_word(digit: u32, local: u32) -> u32 {
    return digit % 8u * GROUP + local;
}

fn counter_bits(digit: u32) -> u32 {
    return digit / 8u * 16u;
}

// Exclusive sums, in place, of all counters in the order of digits, then of threads.
fn scan_counters(local: u32) {
    var sum = 0u;
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        let count = words[local * PER_THREAD + i];
        words[local * PER_THREAD + i] = sum;
        sum += count;
    }
    partial[local] = sum;
    workgroupBarrier();
    for (var step = 1u; step < GROUP; step *= 2u) {
        var before = 0u;
        if local >= step {
            before = partial[local - step];
        }
        workgroupBarrier();
        partial[local] += before;
        workgroupBarrier();
    }
    // All low halves come before the high ones.
    let low_halves = partial[GROUP - 1u] << 16u;
    let before = low_halves + select(partial[max(local, 1u) - 1u], 0u, local == 0u);
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        words[local * PER_THREAD + i] += before;
    }
}

// Ranks of a thread's keys, which follow one another in the list, among the block's by digit. Stable.
fn rank(thread_keys: array<u32, PER_THREAD>, local: u32) -> array<u32, PER_THREAD> {
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        words[i * GROUP + local] = 0u;
    }
    var ranks: array<u32, PER_THREAD>;
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        let digit = digit_of(thread_keys[i]);
        let word = counter_word(digit, local);
        ranks[i] = extractBits(words[word], counter_bits(digit), 16u);
        words[word] += 1u << counter_bits(digit);
    }
    workgroupBarrier();
    scan_counters(local);
    workgroupBarrier();
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        let digit = digit_of(thread_keys[i]);
        ranks[i] += extractBits(words[counter_word(digit, local)], counter_bits(digit), 16u);
    }
    if local < RADIX {
        digit_begin[local] = extractBits(words[counter_word(local, 0u)], counter_bits(local), 16u);
    }
    workgroupBarrier();
    return ranks;
}

@compute @workgroup_size(GROUP)
fn reorder(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let block = flat(workgroup);
    if block >= sort.blocks {
        return;
    }
    let first = block * BLOCK + local * PER_THREAD;
    var thread_keys: array<u32, PER_THREAD>;
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        thread_keys[i] = key_at(first + i);
    }
    let ranks = rank(thread_keys, local);
    if local < RADIX {
        digit_offset[local] = digits[local * sort.blocks + block] - digit_begin[local];
    }
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        words[ranks[i]] = thread_keys[i];
    }
    workgroupBarrier();
    // From here on a thread takes every 256th pair: neighbours write side by side.
    var places: array<u32, PER_THREAD>;
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        let key = words[i * GROUP + local];
        places[i] = digit_offset[digit_of(key)] + i * GROUP + local;
        if places[i] < sort.pairs {
            sorted_keys[places[i]] = key;
        }
    }
    workgroupBarrier();
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        words[ranks[i]] = particles[min(first + i, sort.pairs - 1u)];
    }
    workgroupBarrier();
    for (var i = 0u; i < PER_THREAD; i += 1u) {
        if places[i] < sort.pairs {
            sorted_particles[places[i]] = words[i * GROUP + local];
        }
    }
}

// The cells that hold particles begin and end where the key changes; all others stay as they are.
@compute @workgroup_size(GROUP)
fn find_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let place = flat(workgroup) * GROUP + local;
    if place >= sort.pairs {
        return;
    }
    let cell = keys[place];
    if place == 0u || keys[max(place, 1u) - 1u] != cell {
        bounds[cell].x = place;
    }
    if key_at(place + 1u) != cell {
        bounds[cell].y = place + 1u;
    }
}
