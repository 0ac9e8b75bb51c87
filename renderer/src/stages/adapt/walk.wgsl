// A workgroup's walk over the filled cells of its bundle, from front to back, in groups of so many that each of their columns has
// a lane.

// 4 or 16.
override GROUP_CELLS: u32 = LANES / COLUMNS;
const MOST_GROUP_CELLS: u32 = 16u;

// Layers of the filled cells among 64 layers, in order; those layers as bits; how many they are.
var<workgroup> filled: array<u32, LANES>;
var<workgroup> filled_bits: array<atomic<u32>, 2>;
var<workgroup> filled_count: u32;

// A filled cell of the bundle, where there is one.
struct Cell {
    exists: bool,
    cell: u32,
    layer: u32,
    first: u32,
    end: u32,
}

struct Walk {
    // Layers to be walked through, 64 at a time: from here on they are not listed yet, and here they end.
    layer: u32,
    end_layer: u32,
    // The next one of `filled`, and how many are listed.
    next: u32,
    count: u32,
}

fn start_walk(end_layer: u32) -> Walk {
    return Walk(0u, end_layer, 0u, 0u);
}

// Lists the filled cells among the next 64 layers, which may be none: a lane a layer. All lanes together.
fn list_filled(walk: ptr<function, Walk>, index: u32, lane: u32) {
    if lane < 2u {
        atomicStore(&filled_bits[lane], 0u);
    }
    workgroupBarrier();
    let layer = (*walk).layer + lane;
    let cell = index * tile.layers + min(layer, tile.layers - 1u);
    let end = cells[cell];
    let is_listed = layer < (*walk).end_layer && is_filled(first_of_cell(cell), end);
    let bit = 1u << (lane % 32u);
    if is_listed {
        atomicOr(&filled_bits[lane / 32u], bit);
    }
    workgroupBarrier();
    let bits = vec2(atomicLoad(&filled_bits[0]), atomicLoad(&filled_bits[1]));
    let before = select(vec2(bits.x, bits.y & (bit - 1u)), vec2(bits.x & (bit - 1u), 0u), lane < 32u);
    if is_listed {
        filled[countOneBits(before.x) + countOneBits(before.y)] = layer;
    }
    if lane == 0u {
        filled_count = countOneBits(bits.x) + countOneBits(bits.y);
    }
    (*walk).layer += LANES;
    (*walk).next = 0u;
    (*walk).count = workgroupUniformLoad(&filled_count);
}

// Whether there is another group among the listed cells.
fn has_group(walk: Walk) -> bool {
    return walk.next < walk.count;
}

// Whether there are layers that are not listed yet.
fn has_layers(walk: Walk) -> bool {
    return walk.layer < walk.end_layer;
}

// Cell `number` of the next group.
fn next_group(walk: ptr<function, Walk>, index: u32, number: u32) -> Cell {
    let cell = listed_cell(*walk, index, number);
    (*walk).next += GROUP_CELLS;
    return cell;
}

// The cell that is so many after the next one.
fn listed_cell(walk: Walk, index: u32, number: u32) -> Cell {
    let place = walk.next + number;
    if place >= walk.count {
        return Cell(false, 0u, 0u, 0u, 0u);
    }
    let layer = filled[place];
    let cell = index * tile.layers + layer;
    return Cell(true, cell, layer, first_of_cell(cell), cells[cell]);
}

// The layer after the last group.
fn layer_after(walk: Walk) -> u32 {
    return filled[min(walk.next, walk.count) - 1u] + 1u;
}
