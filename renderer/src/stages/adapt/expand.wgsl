// Sums over the particles of several cells at once, for a column or a sheaf a lane.

// Particles of a cell that are loaded at a time.
const BATCH: u32 = 16u;

var<workgroup> balls: array<vec4<f32>, BATCH * STRETCH_CELLS>;
// Weight, and quantity relative to the cell's reference.
var<workgroup> loads: array<Load, BATCH * STRETCH_CELLS>;
var<workgroup> most_particles: atomic<u32>;

// Which of so many particles that are loaded may reach the column, as bits. Found out before any of them is
// added: lanes that run together then each add one of theirs, not all the same one.
fn met_by(column: Column, first: u32, loaded: u32) -> u32 {
    var met = 0u;
    for (var i = 0u; i < loaded; i += 1u) {
        met |= select(0u, 1u << i, may_reach(column, balls[first + i]));
    }
    return met;
}

// The largest number of particles of any cell that is `wanted`. All lanes together.
fn most_of(cell: Cell, wanted: bool, lane: u32) -> u32 {
    if lane == 0u {
        atomicStore(&most_particles, 0u);
    }
    workgroupBarrier();
    if wanted {
        atomicMax(&most_particles, cell.end - cell.first);
    }
    return workgroupUniformLoad(&most_particles);
}

// The sums of the lane's column or sheaf over the particles of its cell, where it is `wanted`. All lanes together:
// `lanes` of them have the same cell.
//
// Quantities are taken relative to a value of the cell that does not depend on their order.
fn expand(
    cell: Cell, reference: Quantity, wanted: bool, most: u32, axis: vec2<f32>, column: Column, lanes: u32, lane: u32,
) -> Expansions {
    let depths = layer_depth[tile.first_layer + cell.layer];
    let middle = vec3(depths.x * axis, depths.y);
    let end = select(cell.first, cell.end, wanted);
    let first_ball = lane / lanes * BATCH;
    var expansions = no_expansions();
    var evaluations = 0u;
    for (var base = 0u; base < most; base += BATCH) {
        let first = cell.first + base;
        let loaded = min(BATCH, max(end, first) - first);
        for (var i = lane % lanes; i < loaded; i += lanes) {
            let particle = particle_in_cell(first + i, middle, depths.x, reference);
            balls[first_ball + i] = particle.ball;
            loads[first_ball + i] = Load(particle.weight, particle.quantity);
        }
        workgroupBarrier();
        var met = met_by(column, first_ball, loaded);
        for (var left = countOneBits(met); left > 0u; left -= 1u) {
            let particle = first_ball + firstTrailingBit(met);
            evaluations += add_particle(&expansions, column, balls[particle], loads[particle]);
            met &= met - 1u;
        }
        workgroupBarrier();
    }
    add_to_tally(0u, evaluations);
    return expansions;
}

// Counts what all lanes have added to the tally. All lanes together.
fn settle_expansions(lane: u32) {
    workgroupBarrier();
    if lane == 0u {
        settle_tally(0u, EVALUATIONS_OF_BOUNDS);
    }
}
