// Puts the references of each cell in an order of their own, so that sums over them are the same in
// every run: `scatter` leaves them as its lanes came by. The order is that of the particles' places, by
// a hash, and so does not depend on their order in the file either. A workgroup takes a bundle.

@group(0) @binding(0) var<uniform> tile: Tile;
// Position relative to the pivot, and support radius.
@group(0) @binding(1) var<storage, read> projected: array<vec4<f32>>;
// Where the references of each cell end; those of the first begin at 0.
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read_write> pairs: array<u32>;

const LANES: u32 = 64u;
// Larger cells stay as they are: the work grows with the square.
const MOST: u32 = 512u;

// Four keys an element.
var<workgroup> keys: array<vec4<u32>, 128>;

fn key_of(particle: u32) -> u32 {
    let place = bitcast<vec3<u32>>(projected[particle].xyz);
    let mixed = place.x ^ (place.y * 0x9e3779b9u) ^ (place.z * 0x85ebca6bu);
    return (mixed ^ (mixed >> 15u)) * 0xc2b2ae35u;
}

// How many references of the cell come before the given one. Equal keys are equal places.
fn rank_of(key: u32, number: u32, count: u32) -> u32 {
    var rank = vec4(0u);
    for (var i = 0u; i < (count + 3u) / 4u; i += 1u) {
        let others = keys[i];
        let earlier = vec4(4u * i) + vec4(0u, 1u, 2u, 3u) < vec4(number);
        let before = (others < vec4(key)) | ((others == vec4(key)) & earlier);
        rank += select(vec4(0u), vec4(1u), before);
    }
    return rank.x + rank.y + rank.z + rank.w;
}

// Takes each reference to its place. All are read before the first is written.
fn place_all(first: u32, count: u32, lane: u32) {
    var mine: array<vec2<u32>, 8>;
    for (var turn = 0u; turn * LANES < count; turn += 1u) {
        let i = turn * LANES + lane;
        if i < count {
            mine[turn] = vec2(pairs[first + i], rank_of(keys[i / 4u][i % 4u], i, count));
        }
    }
    storageBarrier();
    workgroupBarrier();
    for (var turn = 0u; turn * LANES < count; turn += 1u) {
        if turn * LANES + lane < count {
            pairs[first + mine[turn].y] = mine[turn].x;
        }
    }
    workgroupBarrier();
}

@compute @workgroup_size(LANES)
fn order(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = flat(workgroup);
    if index >= tile.count.x * tile.count.y {
        return;
    }
    let row = index * tile.layers;
    var first = select(cells[max(row, 1u) - 1u], 0u, row == 0u);
    for (var layer = 0u; layer < tile.layers; layer += 1u) {
        let end = cells[row + layer];
        let count = end - first;
        if count > 1u && count <= MOST && end <= tile.pair_capacity {
            // Past the last reference stand keys that come before none.
            for (var i = lane; i < (count + 3u) / 4u; i += LANES) {
                keys[i] = vec4(0xffffffffu);
            }
            workgroupBarrier();
            for (var i = lane; i < count; i += LANES) {
                keys[i / 4u][i % 4u] = key_of(pairs[first + i]);
            }
            workgroupBarrier();
            place_all(first, count, lane);
        }
        first = end;
    }
}
