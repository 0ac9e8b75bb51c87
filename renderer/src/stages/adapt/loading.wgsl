// Particles of some cells of a stretch (survey.wgsl), loaded by all lanes together.

// Particles of a cell that are loaded at a time.
const BATCH: u32 = 16u;

var<workgroup> balls: array<vec4<f32>, BATCH * STRETCH_CELLS>;
// Weight, and quantity relative to the cell's reference.
var<workgroup> loads: array<Load, BATCH * STRETCH_CELLS>;
var<workgroup> most_particles: atomic<u32>;
var<workgroup> slots: array<u32, STRETCH_CELLS>;

// The lane's part in loading particles: those of a cell, together with other lanes.
struct Loader {
    wanted: bool,
    cell: Cell,
    // Place of the cell among those that are loaded.
    number: u32,
    // The lane among those of the cell, and how many there are.
    lane: u32,
    lanes: u32,
}

// The loader of one of the walk's next cells, of which each has so many lanes, and those that bits tell are wanted.
fn loader_of(walk: Walk, index: u32, lanes: u32, wanted: u32, lane: u32) -> Loader {
    let number = lane / lanes;
    let is_wanted = (wanted >> number & 1u) == 1u;
    return Loader(is_wanted, listed_cell(walk, index, number), number, lane % lanes, lanes);
}

// The largest number of particles of any cell that is wanted, each of which gets a slot. All lanes together.
fn start_loading(loader: Loader, lane: u32) -> u32 {
    if lane == 0u {
        atomicStore(&most_particles, 0u);
    }
    workgroupBarrier();
    if loader.wanted && loader.lane == 0u {
        atomicMax(&most_particles, loader.cell.end - loader.cell.first);
        slots[loader.number] = atomicAdd(&slots_taken, 1u);
    }
    return workgroupUniformLoad(&most_particles);
}

// Loads the next particles of a cell, from number `base` on.
//
// Quantities are taken relative to a value of the cell that does not depend on their order.
fn load_batch(loader: Loader, reference: Quantity, base: u32, axis: vec2<f32>) {
    let depths = layer_depth[tile.first_layer + loader.cell.layer];
    let middle = vec3(depths.x * axis, depths.y);
    let first_ball = loader.number * BATCH;
    let loaded = select(0u, loaded_of(loader.cell, base), loader.wanted);
    var i = loader.lane;
    loop {
        if i < loaded {
            let particle = particle_in_cell(loader.cell.first + base + i, middle, depths.x, reference);
            balls[first_ball + i] = particle.ball;
            loads[first_ball + i] = Load(particle.weight, particle.quantity);
        }
        i += loader.lanes;
        if i >= loaded {
            break;
        }
    }
}

fn loaded_of(cell: Cell, base: u32) -> u32 {
    let first = cell.first + base;
    return min(BATCH, max(cell.end, first) - first);
}
