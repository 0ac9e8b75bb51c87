// Adaptive sampling: a workgroup takes a bundle from front to back. In each cell some bricks are
// shown by their middle, at no cost, and the others are sampled, by lanes that stand for a ray's four
// samples in a brick: however few bricks are left, the lanes are busy.
//
// The plan of `levels.wgsl` says which bricks to take, but the account is kept here, with the
// transparencies that the rays really have: nothing is taken that would exceed the budget.

// As in adapt/levels.wgsl.
@group(0) @binding(13) var<storage, read> cell_values: array<vec2<u32>>;
@group(0) @binding(14) var<storage, read> bricks: array<u32>;
@group(0) @binding(15) var<storage, read> plan: array<vec2<f32>>;

// What happens to a brick.
const NOTHING: u32 = 0u;
const SHOWN: u32 = 1u;
const SAMPLED: u32 = 2u;
// With more bricks than this to be sampled, a cell is sampled as a whole: two brick samples a lane.
const MOST_BRICKS: u32 = 32u;
// A column has ended where this share of the budget may still come through.
const OCCLUDED: f32 = 0.0625;

// Upper bounds of the transparency of each ray of the fully sampled picture up to here.
var<workgroup> fronts: array<f32, LANES>;
// Hulls of the bricks: middle, charge and upper bound of the transparency.
var<workgroup> middles: array<vec4<f32>, LANES>;
var<workgroup> offs: array<f32, LANES>;
var<workgroup> opened: array<f32, LANES>;
var<workgroup> fates: array<u32, LANES>;
// Bricks to be sampled.
var<workgroup> todo: array<u32, LANES>;
// How many bricks are to be sampled, are shown and seen, and are not behind the end of their column:
// 8 bits each, from above.
var<workgroup> counts: atomic<u32>;
// Colour and opacity of ray r in the brick layer b of the cell: 4r + b.
var<workgroup> segments: array<vec4<f32>, 256>;

// The books of a column; its four lanes keep the same.
struct Account {
    spent: f32,
    // What may be spent on bricks that are not in the plan.
    credit: f32,
    // Transparency in front as the plan has it.
    planned_front: f32,
    class_end: f32,
    closed: bool,
}

// Decides on the lane's brick, and books all four of its column.
fn decide(account: ptr<function, Account>, column: u32, brick_layer: u32, particles: f32) -> u32 {
    let rays = vec4(fronts[4u * column], fronts[4u * column + 1u], fronts[4u * column + 2u], fronts[4u * column + 3u]);
    var front = max(max(rays.x, rays.y), max(rays.z, rays.w));
    if (*account).closed {
        return NOTHING;
    }
    let rest = (*account).spent + front;
    if rest <= chunk.budget && front <= max(OCCLUDED * chunk.budget, (*account).credit) {
        (*account).spent = rest;
        (*account).closed = true;
        return NOTHING;
    }
    var fate = NOTHING;
    for (var i = 0u; i < BRICK_DEPTH; i += 1u) {
        let lane = i * COLUMNS + column;
        let planned = (*account).planned_front * offs[lane];
        let charge = front * offs[lane] * (1.0 + ROUNDING);
        let in_plan = planned > 0.0 && f32(class_of(planned, particles)) < (*account).class_end;
        let affordable = (*account).spent + charge <= chunk.budget;
        var next = SAMPLED;
        if charge == 0.0 {
            next = SHOWN;
        } else if affordable && in_plan {
            (*account).credit += max(planned - charge, 0.0);
            (*account).spent += charge;
            next = SHOWN;
        } else if affordable && 2.0 * charge <= (*account).credit {
            (*account).credit -= charge;
            (*account).spent += charge;
            next = SHOWN;
        }
        if i == brick_layer {
            fate = next;
        }
        front *= opened[lane];
        (*account).planned_front *= opened[lane];
    }
    return fate;
}

// The books where the whole cell is sampled after all: what `booked` spent on it since `before` is
// free again.
fn booked_back(booked: Account, before: Account) -> Account {
    if booked.closed {
        return booked;
    }
    let credit = booked.credit + booked.spent - before.spent;
    return Account(before.spent, credit, booked.planned_front, booked.class_end, false);
}

fn class_of_cell(sampled: u32, shown: u32) -> u32 {
    if sampled > MOST_BRICKS || sampled > 0u && shown == 0u {
        return CELLS_FULL;
    }
    if sampled > 0u {
        return CELLS_MIXED;
    }
    return select(CELLS_TRANSPARENT, CELLS_SUPER_PIXEL, shown > 0u);
}

// One lane's four samples of a ray in a brick.
struct Unit {
    // 1 where there is such a unit, else 0.
    busy: u32,
    ray: u32,
    brick_layer: u32,
    from_axis: vec2<f32>,
    weights: vec4<f32>,
    charges: vec4<f32>,
}

fn unit_of(number: u32, units: u32) -> Unit {
    let brick = todo[min(number, units - 1u) / 4u];
    let ray = 4u * (brick % COLUMNS) + number % 4u;
    return Unit(select(0u, 1u, number < units), ray, brick / COLUMNS, ray_from_axis(ray), vec4(0.0), vec4(0.0));
}

// Adds a particle to a unit; returns the evaluations that it took.
fn add_to_unit(unit: ptr<function, Unit>, axis: vec2<f32>, ball: vec4<f32>, charge: vec2<f32>) -> u32 {
    let direction = vec3(axis + (*unit).from_axis, 1.0);
    let arc = arc_through(ball, (*unit).from_axis, direction, dot(direction, direction));
    let depths = frame.sample_offset[(*unit).brick_layer];
    if arc.top <= 0.0 || !meets(depths, arc) {
        return 0u;
    }
    let k = kernel_on(depths, arc);
    (*unit).weights += charge.x * k;
    (*unit).charges += charge.y * k;
    return 4u;
}

fn finish_unit(unit: Unit, axis: vec2<f32>, reference: f32, depth: f32) {
    let scale = depth * length(vec3(axis + unit.from_axis, 1.0)) * frame.path_scale;
    let paths = frame.slab_depth[unit.brick_layer] * scale;
    segments[4u * unit.ray + unit.brick_layer] =
        composite_four(vec4(0.0), unit.weights, unit.charges, reference, paths);
}

// Samples the `count` bricks of `todo`, at most MOST_BRICKS, into `segments`.
fn sample_bricks(layer: u32, first: u32, end: u32, count: u32, axis: vec2<f32>, lane: u32) {
    let depths = layer_depth[tile.first_layer + layer];
    let middle = vec3(depths.x * axis, depths.y);
    let reference = clamp(quantities[pairs[first]], 0.0, 1.0);
    let units = 4u * count;
    var a = unit_of(lane, units);
    var b = unit_of(lane + LANES, units);
    var done = 0u;
    for (var base = first; base < end; base += LANES) {
        if base + lane < end {
            load_particle(base + lane, lane, middle, depths.x, reference);
        }
        workgroupBarrier();
        let loaded = min(LANES, end - base);
        
        for (var i = 0u; i < loaded * a.busy; i += 1u) {
            done += add_to_unit(&a, axis, balls[i], charges[i]);
        }
        
        for (var i = 0u; i < loaded * b.busy; i += 1u) {
            done += add_to_unit(&b, axis, balls[i], charges[i]);
        }
        workgroupBarrier();
    }
    for (var once = 0u; once < a.busy; once += 1u) {
        finish_unit(a, axis, reference, depths.x);
    }
    for (var once = 0u; once < b.busy; once += 1u) {
        finish_unit(b, axis, reference, depths.x);
    }
    add_to_tally(0u, done);
}

// Takes the lane's ray through the bricks of a cell; `front` bounds its transparency in the fully
// sampled picture.
fn composite_bricks(ray: ptr<function, Ray>, front: ptr<function, f32>, lane: u32) {
    for (var i = 0u; i < BRICK_DEPTH; i += 1u) {
        let brick = i * COLUMNS + lane / 4u;
        var segment = vec4(0.0);
        if fates[brick] == SHOWN {
            segment = middles[brick];
            *front *= opened[brick];
        } else if fates[brick] == SAMPLED {
            segment = segments[4u * lane + i];
            *front *= 1.0 - segment.a;
        }
        (*ray).colour += (*ray).transparency * segment.rgb;
        (*ray).transparency *= 1.0 - segment.a;
    }
}

// Values of the lane's brick; false where the cell was not analysed.
fn load_hull(cell: u32, paths: vec2<f32>, lane: u32) -> bool {
    let entry = cell_values[cell];
    if entry.x <= 1u {
        middles[lane] = vec4(0.0);
        offs[lane] = 0.0;
        opened[lane] = 1.0;
        return entry.x == 1u && is_transparent(entry.y);
    }
    let hull = hull_of(bricks[(entry.x - 2u) * LANES + lane], paths);
    middles[lane] = hull.middle;
    offs[lane] = hull.charge;
    opened[lane] = hull.open;
    return true;
}

@compute @workgroup_size(LANES)
fn cast_adaptively(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let turn = chunk.first_turn + flat(workgroup);
    if turn >= chunk.end_turn {
        return;
    }
    let index = bundle_of(turn);
    let corner = corner_of(index);
    let axis = ray_slope(frame, corner + 3.5);
    let from_axis = ray_from_axis(lane);
    let column = lane % COLUMNS;
    let brick_layer = lane / COLUMNS;
    let paths = paths_of(brick_layer, axis + column_from_axis(column));

    let in_picture = all(corner + vec2<f32>(place_in_bundle(lane)) < vec2<f32>(frame.size));
    var ray = Ray(vec3(0.0), 1.0);
    var front = select(0.0, 1.0, in_picture);
    let planned = plan[index * COLUMNS + column];
    var account = Account(0.0, planned.y, 1.0, planned.x, !column_in_picture(corner, column));

    var first = first_reference(index);
    for (var layer = 0u; layer < tile.layers; layer += 1u) {
        let cell = index * tile.layers + layer;
        let end = cells[cell];
        if end > first && end <= tile.pair_capacity {
            // What the cell before has left is read.
            workgroupBarrier();
            if lane == 0u {
                settle_tally(0u, EVALUATIONS);
                atomicStore(&counts, 0u);
            }
            let analysed = load_hull(cell, paths * layer_depth[tile.first_layer + layer].x, lane);
            fronts[lane] = select(front, 0.0, ray.transparency <= OPAQUE);
            workgroupBarrier();
            var booked = account;
            var fate = decide(&booked, column, brick_layer, f32(end - first));
            if !analysed && !booked.closed {
                fate = SAMPLED;
            }
            fates[lane] = fate;
            let sampled = fate == SAMPLED;
            let seen = fate == SHOWN && middles[lane].a > 0.0;
            let number = atomicAdd(
                &counts,
                select(0u, 1u << 16u, sampled) + select(0u, 1u << 8u, seen) + select(1u, 0u, booked.closed),
            );
            if sampled {
                todo[number >> 16u] = lane;
            }
            let sums = workgroupUniformLoad(&counts);
            let count = sums >> 16u;
            let shown = sums >> 8u & 0xffu;
            if (sums & 0xffu) == 0u {
                account = booked;
                break;
            }
            let whole = select(0u, 1u, count > MOST_BRICKS);
            for (var once = 0u; once < whole; once += 1u) {
                let stretch = cast_cell(layer, first, end, axis, axis + from_axis, from_axis, lane);
                ray.colour += ray.transparency * stretch.rgb;
                ray.transparency *= 1.0 - stretch.a;
                front *= 1.0 - stretch.a;
                account = booked_back(booked, account);
            }
            for (var once = whole; once < 1u; once += 1u) {
                for (var some = 0u; some < min(count, 1u); some += 1u) {
                    sample_bricks(layer, first, end, count, axis, lane);
                    workgroupBarrier();
                }
                composite_bricks(&ray, &front, lane);
                account = booked;
            }
            if lane == 0u {
                atomicAdd(&counters[class_of_cell(count, shown)], 1u);
            }
        }
        first = end;
    }
    workgroupBarrier();
    if lane == 0u {
        settle_tally(0u, EVALUATIONS);
    }
    if lane < COLUMNS {
        atomicMax(&counters[LARGEST_CHARGE], bitcast<u32>(account.spent));
    }
    pixels[index * LANES + lane] = vec4(ray.colour, ray.transparency);
}
