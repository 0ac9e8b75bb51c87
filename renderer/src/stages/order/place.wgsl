// The order of the references of a cell: that of a hash of the particles' places. So it depends neither
// on how `scatter` came by them, nor on the particles' order in the file.

@group(0) @binding(0) var<uniform> tile: Tile;
// Position relative to the pivot, and support radius.
@group(0) @binding(1) var<storage, read> projected: array<vec4<f32>>;
// Where the references of each cell end; those of the first begin at 0.
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read_write> pairs: array<u32>;
// As `Totals` of grid.rs.
@group(0) @binding(4) var<storage, read_write> totals: array<atomic<u32>, 8>;
// Cells that are left to `order_large`, in no particular order.
@group(0) @binding(5) var<storage, read_write> large: array<u32>;

// Cells in `large`, references of the largest of them, and of a bundle's cells that are no crowds.
const LARGE_CELLS: u32 = 2u;
const LARGEST_CELL: u32 = 3u;
const BUSIEST_BUNDLE: u32 = 4u;

fn key_of(particle: u32) -> u32 {
    let place = bitcast<vec3<u32>>(projected[particle].xyz);
    var mixed = place.x ^ (place.y * 0x9e3779b9u) ^ (place.z * 0x85ebca6bu);
    mixed = (mixed ^ (mixed >> 15u)) * 0xc2b2ae35u;
    return mixed ^ (mixed >> 16u);
}

// Which of two particles with one key comes first: by their places, then by their radii. Only where all
// of these are alike, the order of the particles in the file decides.
fn precedes(a: u32, b: u32) -> bool {
    let places = array(bitcast<vec4<u32>>(projected[a]), bitcast<vec4<u32>>(projected[b]));
    var before = a < b;
    for (var i = 4u; i > 0u; i -= 1u) {
        let numbers = vec2(places[0][i - 1u], places[1][i - 1u]);
        before = select(before, numbers.x < numbers.y, numbers.x != numbers.y);
    }
    return before;
}
