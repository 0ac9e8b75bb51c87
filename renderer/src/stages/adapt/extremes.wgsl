// What a cell is as a whole: the extremes of the quantity, and, where sheaves may do, what tells whether it is smooth
// and amid the fluid.

// Of each cell of a stretch (survey.wgsl), as bits of floats that are not negative: they are in their order.
var<workgroup> cell_low: array<atomic<u32>, STRETCH_CELLS>;
var<workgroup> cell_high: array<atomic<u32>, STRETCH_CELLS>;
// The largest 1/h, and how far another quantity is from that of the first particle.
var<workgroup> cell_finest: array<atomic<u32>, STRETCH_CELLS>;
var<workgroup> cell_stray: array<atomic<u32>, STRETCH_CELLS>;
// Sides beyond which there is a particle's centre.
var<workgroup> cell_sides: array<atomic<u32>, STRETCH_CELLS>;

const LANES_OF_WHOLE: u32 = LANES / STRETCH_CELLS;

struct Whole {
    // Bounds of the quantity that decides the opacity; EMPTY where no particle has one.
    values: vec2<f32>,
    // The range of all quantities, about; and the largest 1/h, lengths as in the cell.
    spread: f32,
    finest: f32,
    // Whether there are centres of particles beyond all its sides: mostly so where the fluid does not end.
    is_amid: bool,
}

const ALL_SIDES: u32 = 63u;

// Sides of a cell beyond which a place lies, as bits. `place`: relative to the cell's middle, in units of its depth.
fn sides_passed(place: vec3<f32>, axis: vec2<f32>) -> u32 {
    let aside = place.xy - place.z * axis;
    let half = 3.5 * frame.pitch;
    let beyond = vec3(aside < vec2(-half), place.z < frame.sample_offset[0].x);
    let behind = vec3(aside > vec2(half), place.z > frame.sample_offset[3].w);
    return dot(select(vec3(0u), vec3(1u, 2u, 4u), beyond) + select(vec3(0u), vec3(8u, 16u, 32u), behind), vec3(1u));
}

// Of the lane's cell, by the four lanes of each cell together, where it is `unknown`.
fn whole_of(cell: Cell, unknown: bool, axis: vec2<f32>, lane: u32) -> Whole {
    let number = lane / LANES_OF_WHOLE;
    if lane % LANES_OF_WHOLE == 0u {
        atomicStore(&cell_low[number], bitcast<u32>(FAR));
        atomicStore(&cell_high[number], 0u);
        atomicStore(&cell_finest[number], 0u);
        atomicStore(&cell_stray[number], 0u);
        atomicStore(&cell_sides[number], 0u);
    }
    workgroupBarrier();
    let end = select(cell.first, cell.end, unknown);
    var low = FAR;
    var high = 0.0;
    var smallest = FAR;
    var stray = 0.0;
    var sides = 0u;
    let depths = layer_depth[tile.first_layer + cell.layer];
    let middle = vec3(depths.x * axis, depths.y);
    let origin = in_range(quantities[pairs[cell.first]]);
    for (var place = cell.first + lane % LANES_OF_WHOLE; place < end; place += LANES_OF_WHOLE) {
        let particle = pairs[place];
        let quantity = quantities[particle];
        let u = for_opacity(in_range(quantity));
        low = select(min(low, u), low, is_rejected(quantity));
        high = select(max(high, u), high, is_rejected(quantity));
        if HAS_SHEAVES {
            let ball = projected[particle];
            stray = max(stray, stray_of(in_range(quantity), origin));
            smallest = min(smallest, ball.w);
            sides |= sides_passed((ball.xyz - middle) / depths.x, axis);
        }
    }
    atomicMin(&cell_low[number], bitcast<u32>(low));
    atomicMax(&cell_high[number], bitcast<u32>(high));
    atomicMax(&cell_finest[number], bitcast<u32>(depths.x / smallest));
    atomicMax(&cell_stray[number], bitcast<u32>(stray));
    atomicOr(&cell_sides[number], sides);
    workgroupBarrier();
    let least = bitcast<f32>(atomicLoad(&cell_low[number]));
    let greatest = bitcast<f32>(atomicLoad(&cell_high[number]));
    let values = vec2(max(least - 2e-6, 0.0), min(greatest + 2e-6, 1.0));
    let finest = bitcast<f32>(atomicLoad(&cell_finest[number]));
    let spread = max(greatest - least, 2.0 * bitcast<f32>(atomicLoad(&cell_stray[number])));
    let is_amid = atomicLoad(&cell_sides[number]) == ALL_SIDES;
    return Whole(select(values, EMPTY, least > greatest), spread, finest, is_amid);
}
