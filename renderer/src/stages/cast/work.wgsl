// Cells that are work of their own, as adapt/filing.wgsl listed them, and what becomes of them.

// Colour and opacity of each ray in a listed cell, 64 a cell.
@group(0) @binding(14) var<storage, read_write> segments: array<vec4<f32>>;
@group(0) @binding(15) var<storage, read> work: array<u32, 4>;
// Cells on lists of work (shared/tasks.wgsl), each with its place among all of them.
@group(0) @binding(16) var<storage, read> tasks: array<vec2<u32>>;
@group(0) @binding(17) var<storage, read> cell_values: array<CellEntry>;
@group(0) @binding(18) var<storage, read> bricks: array<FieldValues>;
// Costs of a column's bricks (adapt/offers.wgsl), negative where no light comes from.
@group(0) @binding(19) var<storage, read> offers: array<array<vec4<f32>, 2>>;

// Of a cell.
override BRICKS: u32 = COLUMNS * BRICK_DEPTH;

fn task_at(list: u32, number: u32) -> vec2<u32> {
    return tasks[place_in_list(list, number, arrayLength(&tasks))];
}

// Whether a brick is in a mask of CellEntry.
fn is_chosen(mask: vec2<u32>, column: u32, brick_layer: u32) -> bool {
    return (mask[brick_layer / 2u] >> (column + 16u * (brick_layer % 2u)) & 1u) == 1u;
}

// Where the values of a cell's column stand.
fn place_of_column(cell: u32, column: u32) -> u32 {
    return (max(cell_values[cell].slot, FIRST_SLOT) - FIRST_SLOT) * COLUMNS + column;
}

// A ray's stretch through a cell, and behind it the samples in one more brick, which follows its slope. `ray`: in its
// column; `scale`: that of its paths.
fn pass_slope(segment: vec4<f32>, values: FieldValues, brick_layer: u32, ray: u32, scale: f32) -> vec4<f32> {
    let charges = charges_on_slope(values, brick_layer, ray);
    let paths = frame.slab_depth[brick_layer] * scale;
    return composite_four(segment, vec4(1.0), charges, Quantity(), paths, frame.sample_offset[brick_layer]);
}

// What stands for a brick that is not sampled.
fn middle_of(cell: u32, column: u32, brick_layer: u32, axis: vec2<f32>) -> vec4<f32> {
    let place = place_of_column(cell, column);
    let depth = layer_depth[tile.first_layer + cell % tile.layers].x;
    let paths = paths_of(brick_layer, axis + column_from_axis(column)) * depth;
    let seen = seen_in(bricks[place], brick_layer);
    let hull = hull_of(seen.values, seen.shades.range, paths);
    return select(vec4(0.0), hull.middle, offers[place][0][brick_layer] >= 0.0);
}
