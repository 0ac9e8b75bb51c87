// What the choice makes of cells: masks of the bricks to be sampled, classes, and lists of work.

// For each cell its place among those on lists of work + 2, 1 where it is shown, 0 where nothing is.
@group(0) @binding(18) var<storage, read_write> sampled: array<u32>;
// Cells on lists of work (shared/tasks.wgsl), each with its place among all of them.
@group(0) @binding(19) var<storage, read_write> tasks: array<vec2<u32>>;
@group(0) @binding(20) var<storage, read_write> work: array<atomic<u32>, 4>;

// Bricks, and columns at level 2, that lanes can sample with two units of work each (cast/parts.wgsl).
override MOST_UNITS: u32 = 2u * LANES / COLUMN_RAYS;

// Bricks of the group's cells to be sampled at every slice, and those between: two words each (CellEntry).
var<workgroup> sampled_masks: array<atomic<u32>, 2u * MOST_GROUP_CELLS>;
var<workgroup> coarse_masks: array<atomic<u32>, 2u * MOST_GROUP_CELLS>;
// Of each cell: SEEN, PAID.
var<workgroup> shown: array<atomic<u32>, MOST_GROUP_CELLS>;

// Some column is seen; some brick is not sampled in full, at a cost: bricks with nothing in them are not
// sampled either.
const SEEN: u32 = 1u;
const PAID: u32 = 2u;

fn clear_masks(lane: u32) {
    if lane < 2u * GROUP_CELLS {
        atomicStore(&sampled_masks[lane], 0u);
        atomicStore(&coarse_masks[lane], 0u);
    }
    if lane < GROUP_CELLS {
        atomicStore(&shown[lane], 0u);
    }
}

// Bits of a column's bricks in the two words of a mask.
fn bits_of(column: u32, chosen: vec4<bool>) -> vec2<u32> {
    let bit = 1u << column;
    return vec2(
        select(0u, bit, chosen.x) | select(0u, bit << 16u, chosen.y),
        select(0u, bit, chosen.z) | select(0u, bit << 16u, chosen.w),
    );
}

// `paid`: bricks whose offer has a cost.
fn note_column(
    number: u32, column: u32, fine: vec4<bool>, coarse: vec4<bool>, seen: bool, paid: vec4<bool>,
) {
    let fine_bits = bits_of(column, fine);
    let coarse_bits = bits_of(column, coarse);
    atomicOr(&sampled_masks[2u * number], fine_bits.x);
    atomicOr(&sampled_masks[2u * number + 1u], fine_bits.y);
    atomicOr(&coarse_masks[2u * number], coarse_bits.x);
    atomicOr(&coarse_masks[2u * number + 1u], coarse_bits.y);
    let some_paid = any(paid & !fine);
    atomicOr(&shown[number], select(0u, SEEN, seen) | select(0u, PAID, some_paid));
}

// Notes a cell's masks and class, and puts it on a list of work where it is some.
fn file_cell(cell: u32, number: u32) {
    let fine = vec2(atomicLoad(&sampled_masks[2u * number]), atomicLoad(&sampled_masks[2u * number + 1u]));
    let coarse = vec2(atomicLoad(&coarse_masks[2u * number]), atomicLoad(&coarse_masks[2u * number + 1u]));
    let flags = atomicLoad(&shown[number]);
    let bricks = countOneBits(fine.x) + countOneBits(fine.y);
    // Those that follow a slope take no evaluations.
    let levels = select(columns_in(coarse), 0u, chunk.between == SLOPES);
    let units = bricks + countOneBits(levels);
    let class_index = class_of_cell(bricks, units, flags);
    atomicAdd(&counters[class_index], 1u);
    cell_values[cell].class_index = class_index;
    cell_values[cell].sampled = fine;
    cell_values[cell].coarse = coarse;
    if units == 0u && all(coarse == vec2(0u)) {
        sampled[cell] = flags & SEEN;
        return;
    }
    list_cell(cell, select(select(PARTS, WHOLES, units > MOST_UNITS), SLOPED, units == 0u));
}

fn class_of_cell(bricks: u32, units: u32, flags: u32) -> u32 {
    if units == 0u {
        return select(CELLS_TRANSPARENT, CELLS_SUPER_PIXEL, (flags & SEEN) > 0u);
    }
    if bricks == 0u {
        return CELLS_Z_ADAPTIVE + 1u;
    }
    return select(CELLS_FULL, CELLS_MIXED, (flags & PAID) > 0u);
}
