// Puts the cells of a bundle together, from front to back: those that were sampled, and those shown by
// the middles of their bricks. A lane a ray.

// As in adapt/levels.wgsl and cast/work.wgsl.
@group(0) @binding(12) var<storage, read_write> pixels: array<vec4<f32>>;
@group(0) @binding(13) var<storage, read> segments: array<vec4<f32>>;
@group(0) @binding(14) var<storage, read> sampled: array<u32>;
@group(0) @binding(15) var<storage, read> bundle_entries: array<BundleEntry>;
@group(0) @binding(16) var<storage, read> cell_values: array<CellEntry>;
@group(0) @binding(17) var<storage, read> shows: array<vec4<f32>>;

// Places of the next 64 layers' cells in `segments` + 2, or 1 where middles are shown; those of either as bits.
var<workgroup> places: array<u32, LANES>;
var<workgroup> seen_layers: array<atomic<u32>, 2>;

// Notes what is seen in the layers from `first` to `end_layer`, at most 64: a lane a layer.
fn note_layers(index: u32, first: u32, end_layer: u32, lane: u32) {
    if lane < 2u {
        atomicStore(&seen_layers[lane], 0u);
    }
    workgroupBarrier();
    let layer = first + lane;
    let cell = index * tile.layers + min(layer, tile.layers - 1u);
    // Of cells that hold nothing, nothing was noted.
    let is_noted = layer < end_layer && is_filled(first_of_cell(cell), cells[cell]);
    let place = select(0u, sampled[cell], is_noted);
    places[lane] = place;
    atomicOr(&seen_layers[lane / 32u], select(0u, 1u << (lane % 32u), place > 0u));
    workgroupBarrier();
}

// A ray's stretch through the cell of a layer, `place` as in `sampled`.
fn segment_in(cell: u32, place: u32, lane: u32) -> vec4<f32> {
    if place > 1u {
        return segments[(place - 2u) * LANES + lane];
    }
    return shows[(cell_values[cell].slot - FIRST_SLOT) * COLUMNS + lane / COLUMN_RAYS];
}

// Passes the cells of these layers, those in `seen_layers`.
fn pass_layers(index: u32, first: u32, lane: u32, ray: ptr<function, Ray>) {
    var left = vec2(atomicLoad(&seen_layers[0]), atomicLoad(&seen_layers[1]));
    loop {
        if any(left != vec2(0u)) {
            let number = next_of(left);
            let segment = segment_in(index * tile.layers + first + number, places[number], lane);
            (*ray).colour += (*ray).transparency * segment.rgb;
            (*ray).transparency *= 1.0 - segment.a;
        }
        left = without_next(left);
        if all(left == vec2(0u)) || (*ray).transparency <= OPAQUE {
            break;
        }
    }
}

@compute @workgroup_size(LANES)
fn composite_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let turn = chunk.first_turn + flat(workgroup);
    if turn >= chunk.end_turn {
        return;
    }
    let index = bundle_of(turn);
    var ray = Ray(vec3(0.0), 1.0);
    let end_layer = bundle_entries[index].end_layer;
    var first = 0u;
    loop {
        note_layers(index, first, end_layer, lane);
        pass_layers(index, first, lane, &ray);
        first += LANES;
        workgroupBarrier();
        if first >= end_layer {
            break;
        }
    }
    pixels[index * LANES + lane] = vec4(ray.colour, ray.transparency);
}
