// The view-aligned grid (HPG 2016, Sec. 6.1) by a counting sort: `count` counts the references of
// each cell, a scan turns counts into places, `scatter` writes the references. Both walk over the
// same cells in the same way.
//
// A workgroup takes 256 particles and shares out their columns (bundles they may touch) evenly, so
// that a particle that covers the screen costs its neighbours nothing.

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<uniform> tile: Tile;
// Position relative to the pivot, and support radius.
@group(0) @binding(2) var<storage, read> projected: array<vec4<f32>>;
// For `count`: references of each cell. For `scatter`: place of the cell's next reference.
@group(0) @binding(3) var<storage, read_write> cells: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> pairs: array<u32>;

const GROUP: u32 = 256u;
// Slack in pixels and slices: wider than all rounding of positions before it.
const SLACK: f32 = 0.02;

// Columns of each particle: first bundle of the tile, width of the rectangle, and where the
// particle's columns end among those of the workgroup.
var<workgroup> first_column: array<vec2<u32>, GROUP>;
var<workgroup> row_width: array<u32, GROUP>;
var<workgroup> column_end: array<u32, GROUP>;

// Slopes c/z that a ball around (c, z) reaches in front of the near plane.
fn slope_range(c: f32, z: f32, radius: f32) -> vec2<f32> {
    let z_near = max(z - radius, frame.near);
    let z_far = z + radius;
    let low = c - radius;
    let high = c + radius;
    // The ball's box gives a bound everywhere; the tangents of the ball a tighter one away from the eye.
    let box = vec2(low / select(z_near, z_far, low > 0.0), high / select(z_far, z_near, high > 0.0));
    if z < 1.01 * radius {
        return box;
    }
    let denominator = (z - radius) * (z + radius);
    let reach = radius * sqrt(c * c + denominator);
    let tangents = vec2(c * z - reach, c * z + reach) / denominator;
    return vec2(max(box.x, tangents.x), min(box.y, tangents.y));
}

// First and last pixel, of `count` along one axis, whose centre lies in a range of slopes.
fn pixel_range(slopes: vec2<f32>, count: u32) -> vec2<f32> {
    let middle = 0.5 * f32(count) - 0.5;
    let pixels = slopes / frame.pitch + middle;
    let bound = vec2(-1.0, f32(count));
    return vec2(
        max(ceil(clamp(pixels.x - SLACK, bound.x, bound.y)), 0.0),
        min(floor(clamp(pixels.y + SLACK, bound.x, bound.y)), bound.y - 1.0),
    );
}

// Rectangle of bundles, clipped to the tile: first.xy, size.xy.
fn columns_of(ball: vec4<f32>) -> vec4<u32> {
    if !(ball.w > 0.0) {
        return vec4(0u);
    }
    let z = ball.z + frame.pivot_depth;
    let x = pixel_range(slope_range(ball.x, z, ball.w), frame.size.x);
    // Rows run downwards.
    let y = pixel_range(slope_range(-ball.y, z, ball.w), frame.size.y);
    if x.x > x.y || y.x > y.y {
        return vec4(0u);
    }
    let first = max(vec2<u32>(vec2(x.x, y.x)) / BUNDLE_SIDE, tile.first);
    let end = min(vec2<u32>(vec2(x.y, y.y)) / BUNDLE_SIDE + 1u, tile.first + tile.count);
    if any(first >= end) {
        return vec4(0u);
    }
    return vec4(first, end - first);
}

// Squared distance, at depth t beyond the ball's centre, between the axis of that depth and the
// rectangle that the bundle's rays span there, plus t²; and its derivative. `ahead` and `behind`:
// distances at t = 0 of the rectangle's low and high sides beyond the centre, with their slopes.
fn distance_to_bundle(t: f32, ahead: vec4<f32>, behind: vec4<f32>) -> vec2<f32> {
    let before = ahead.xy + ahead.zw * t;
    let after = behind.xy + behind.zw * t;
    let gap = max(max(before, after), vec2(0.0));
    let slope = select(select(vec2(0.0), behind.zw, after > vec2(0.0)), ahead.zw, before > vec2(0.0));
    return vec2(dot(gap, gap) + t * t, 2.0 * (dot(gap, slope) + t));
}

// Depths, relative to the ball's centre, between which a bundle's rays may be inside the ball;
// x > y where there are none. The distance is convex along depth, so Newton's steps from outside
// approach the ball and never enter it: every one of them is a bound.
fn depth_range(ball: vec4<f32>, bundle: vec2<u32>) -> vec2<f32> {
    let last_pixel = vec2<f32>(frame.size - 1u);
    let first = vec2<f32>(bundle * BUNDLE_SIDE);
    let last = min(first + f32(BUNDLE_SIDE - 1u), last_pixel);
    let top_left = ray_slope(frame, first);
    let bottom_right = ray_slope(frame, last);
    let low = vec2(top_left.x, bottom_right.y);
    let high = vec2(bottom_right.x, top_left.y);
    let z = ball.z + frame.pivot_depth;
    let ahead = vec4(low * z - ball.xy, low);
    let behind = vec4(ball.xy - high * z, -high);

    // Wider than the rounding of the position, and of the slopes times z.
    let radius = ball.w * 1.0001 + (abs(ball.x) + abs(ball.y) + abs(ball.z)) * 1e-6;
    let squared = radius * radius;
    var enter = -radius;
    var leave = radius;
    for (var i = 0; i < 5; i += 1) {
        let a = distance_to_bundle(enter, ahead, behind);
        let b = distance_to_bundle(leave, ahead, behind);
        let a_outside = a.x > squared;
        let b_outside = b.x > squared;
        if (a_outside && a.y >= 0.0) || (b_outside && b.y <= 0.0) {
            return vec2(1.0, -1.0);
        }
        enter = select(enter, enter - (a.x - squared) / a.y, a_outside);
        leave = select(leave, leave - (b.x - squared) / b.y, b_outside);
    }
    return vec2(enter, leave);
}

// ln(1 + x) for x ≥ 0, with full relative precision for small x.
fn log_one_plus(x: vec2<f32>) -> vec2<f32> {
    let series = x * (1.0 - x * (1.0 / 2.0 - x * (1.0 / 3.0 - x * (1.0 / 4.0 - x * (1.0 / 5.0)))));
    return select(log(1.0 + x), series, x < vec2(0.05));
}

// First layer, and layer after the last, of the tile in which a bundle's samples may be inside the
// ball. A cell counts from its first sample to its last, ½ and 15½ slices in: samples of every
// coarser level lie between them.
fn layers_of(ball: vec4<f32>, bundle: vec2<u32>) -> vec2<i32> {
    let depths = depth_range(ball, bundle);
    if depths.x > depths.y {
        return vec2(0);
    }
    let z = clamp(ball.z + depths, vec2(frame.near_offset), vec2(frame.far_offset));
    let slices = log_one_plus((z - frame.near_offset) / frame.near) / frame.log_step;
    let slack = SLACK + 1e-6 * slices.y;
    let first = i32(ceil((slices.x - slack - (CELL_SLICES - 0.5)) / CELL_SLICES));
    let last = i32(floor((slices.y + slack - 0.5) / CELL_SLICES));
    let tile_first = i32(tile.first_layer);
    return clamp(vec2(first, last + 1) - tile_first, vec2(0), vec2(i32(tile.layers)));
}

// Fills the workgroup's tables; returns the number of columns of all its particles.
fn share_columns(particle: u32, local: u32) -> u32 {
    var columns = vec4(0u);
    if particle < frame.particle_count {
        columns = columns_of(projected[particle]);
    }
    first_column[local] = columns.xy;
    row_width[local] = columns.z;
    column_end[local] = columns.z * columns.w;
    workgroupBarrier();
    for (var step = 1u; step < GROUP; step *= 2u) {
        var before = 0u;
        if local >= step {
            before = column_end[local - step];
        }
        workgroupBarrier();
        column_end[local] += before;
        workgroupBarrier();
    }
    return column_end[GROUP - 1u];
}

// The particle of the workgroup to which a column belongs: the first whose columns end beyond it.
fn owner_of(column: u32) -> u32 {
    var low = 0u;
    var high = GROUP - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if column_end[middle] > column {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}

// The cells of one column that a particle touches: `first` up to, but without, `end`.
struct Run {
    particle: u32,
    first: u32,
    end: u32,
}

// A column of the workgroup whose particles begin with `first_particle`.
fn run_of(column: u32, first_particle: u32) -> Run {
    let owner = owner_of(column);
    let rank = column - select(column_end[max(owner, 1u) - 1u], 0u, owner == 0u);
    let width = row_width[owner];
    let bundle = first_column[owner] + vec2(rank % width, rank / width);
    let particle = first_particle + owner;
    let layers = vec2<u32>(layers_of(projected[particle], bundle));

    let in_tile = bundle - tile.first;
    let row = (in_tile.y * tile.count.x + in_tile.x) * tile.layers;
    return Run(particle, row + layers.x, row + layers.y);
}

fn walk(workgroup: u32, local: u32, scattering: bool) {
    let first_particle = workgroup * GROUP;
    let columns = share_columns(first_particle + local, local);
    var column = local;
    loop {
        let run = run_of(min(column, max(columns, 1u) - 1u), first_particle);
        var cell = run.first;
        let end = select(cell, run.end, column < columns);
        loop {
            if cell < end {
                let place = atomicAdd(&cells[cell], 1u);
                if scattering && place < tile.pair_capacity {
                    pairs[place] = run.particle;
                }
            }
            cell += 1u;
            if cell >= end {
                break;
            }
        }
        column += GROUP;
        if column >= columns {
            break;
        }
    }
}

@compute @workgroup_size(GROUP)
fn count(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    walk(flat(workgroup), local, false);
}

@compute @workgroup_size(GROUP)
fn scatter(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    walk(flat(workgroup), local, true);
}
