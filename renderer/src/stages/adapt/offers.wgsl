// What it costs to do less than sample a brick at every slice, and what a column may afford.
//
// A brick may be shown by the middle of its hull, at no evaluations. Two things lie between that and its
// samples: where bricks may be shown, it may follow its slope, at no evaluations either, but with a look at
// the transfer function for each sample; where they may not, it may be sampled once a ray for all its
// slices (level 2: Sec. 4 of the paper), charged the full width of the hull. Where that costs less for what
// it saves, there are two steps: one to there, which saves most, and one on to showing the brick, which
// saves the rest. Otherwise there is only one.

// No light comes from the brick; there is no such step.
const NONE: f32 = -1.0;
// The share of a brick's work that is saved at level 2, and by a slope.
const SAVED_AT_LEVEL_2: f32 = 0.75;
const SAVED_BY_SLOPE: f32 = 0.9;

fn saved_between() -> f32 {
    return select(SAVED_AT_LEVEL_2, SAVED_BY_SLOPE, chunk.between == SLOPES);
}

// No budget is as large.
const UNAFFORDABLE: f32 = 1e6;

// Scores, the cost of a step for each evaluation saved, fall into classes of half an octave, down to 2⁻³².
const CLASSES: u32 = 64u;
// By its bits: the class of a score of 1 and more.
const LEAST_CLASS: u32 = 254u - 63u;
// A cost as large as the budget, in `spending`.
const WHOLE: f32 = 262144.0;

const SPENT_ENOUGH: u32 = 1u << 31u;

// Costs by column and class, in shares of the budget.
var<workgroup> spending: array<atomic<u32>, MOST_COLUMNS * CLASSES>;

// The four hulls of a column, one behind the other.
struct ColumnHull {
    // Colour and opacity of the middles together.
    shown: vec4<f32>,
    charge: vec4<f32>,
    // Of what lies between: the width of the hull, or what the slope is charged.
    between: vec4<f32>,
    // Transparencies in front of each, if nothing stood before the column.
    front: vec4<f32>,
    open: f32,
}

fn behind(shown: vec4<f32>, middle: vec4<f32>) -> vec4<f32> {
    return shown + (1.0 - shown.a) * middle;
}

// The hull of one brick, and what is charged for what lies between.
struct BrickHull {
    hull: Hull,
    between: f32,
}

fn brick_hull(column: FieldValues, brick: u32, paths: vec2<f32>) -> BrickHull {
    let seen = seen_in(column, brick);
    let hull = hull_of(seen.values, seen.shades.range, paths);
    let slope = slope_charge(seen.values, seen.shades, seen.off, paths.y);
    return BrickHull(hull, select(hull.width, slope, chunk.between == SLOPES));
}

fn hull_of_column(values: FieldValues, paths: array<vec2<f32>, 4>, depth: f32) -> ColumnHull {
    let a = brick_hull(values, 0u, paths[0] * depth);
    let b = brick_hull(values, 1u, paths[1] * depth);
    let c = brick_hull(values, 2u, paths[2] * depth);
    let d = brick_hull(values, 3u, paths[3] * depth);
    let open = vec4(a.hull.open, b.hull.open, c.hull.open, d.hull.open);
    return ColumnHull(
        behind(behind(behind(a.hull.middle, b.hull.middle), c.hull.middle), d.hull.middle),
        vec4(a.hull.charge, b.hull.charge, c.hull.charge, d.hull.charge),
        vec4(a.between, b.between, c.between, d.between),
        vec4(1.0, open.x, open.x * open.y, open.x * open.y * open.z),
        open.x * open.y * open.z * open.w,
    );
}

// Costs of a column's bricks.
struct Offers {
    // Of the first step, or NONE where no light comes from the brick.
    first: vec4<f32>,
    // Of the second, or NONE where the first one leads to showing the brick.
    second: vec4<f32>,
}

// Offers for a column, before which so much light comes through.
fn offers_of(hull: ColumnHull, before: f32) -> Offers {
    let front = before * hull.front * (1.0 + ROUNDING);
    let free = hull.charge == vec4(0.0);
    let show = select(vec4(UNAFFORDABLE), front * hull.charge, free | vec4(chunk.super_pixels == 1u));
    if chunk.between == NOTHING_BETWEEN {
        return Offers(show, vec4(NONE));
    }
    // The bounds hold for whole bricks, so a brick is as wide at level 0 as at level 2.
    let relaxed = front * hull.between * (1.0 - chunk.relaxation);
    // Sec. 5 of the paper: no cell is wider than the tolerance by itself, relaxed or not.
    let between = select(vec4(UNAFFORDABLE), relaxed, hull.between < vec4(chunk.budget));
    let two_steps = between < saved_between() * show;
    return Offers(select(show, between, two_steps), select(vec4(NONE), show - between, two_steps));
}

// Classes of the steps to a brick's offers. By exponent and first bit of the score: no rounding, so both
// walks find the same class.
struct Classes {
    first: vec4<u32>,
    second: vec4<u32>,
}

fn classes_of(offers: Offers, particles: f32, layer: u32) -> Classes {
    let two_steps = offers.second >= vec4(0.0);
    let first_saves = select(vec4(1.0), vec4(saved_between()), two_steps) * particles;
    return Classes(
        class_of(offers.first, first_saves, layer),
        class_of(offers.second, vec4((1.0 - saved_between()) * particles), layer),
    );
}

// Steps in the order of their cells, whatever they save.
override FRONT_TO_BACK: bool = false;
override BACK_TO_FRONT: bool = false;

fn class_of(cost: vec4<f32>, saved: vec4<f32>, layer: u32) -> vec4<u32> {
    let place = layer * CLASSES / tile.layers;
    if FRONT_TO_BACK {
        return vec4(place);
    }
    if BACK_TO_FRONT {
        return vec4(CLASSES - 1u - place);
    }
    let score = max(cost, vec4(0.0)) / (chunk.budget * saved);
    let bits = bitcast<vec4<u32>>(score) >> vec4(22u);
    return clamp(bits, vec4(LEAST_CLASS), vec4(LEAST_CLASS + CLASSES - 1u)) - LEAST_CLASS;
}

fn clear_spending(lane: u32) {
    for (var i = lane; i < COLUMNS * CLASSES; i += LANES) {
        atomicStore(&spending[i], 0u);
    }
}

fn spend_four(column: u32, costs: vec4<f32>, classes: vec4<u32>) {
    spend(column, costs.x, classes.x);
    spend(column, costs.y, classes.y);
    spend(column, costs.z, classes.z);
    spend(column, costs.w, classes.w);
}

fn spend(column: u32, cost: f32, class_index: u32) {
    if cost > 0.0 {
        // Twice the budget is too much in any company.
        let share = u32(ceil(min(cost / chunk.budget, 2.0) * WHOLE));
        let entry = column * CLASSES + class_index;
        // Far beyond any budget the sum stands still, so that it never starts again from 0.
        if atomicAdd(&spending[entry], share) >= SPENT_ENOUGH {
            atomicStore(&spending[entry], SPENT_ENOUGH);
        }
    }
}

// Which steps a column takes: those of the classes before `marginal`, and those of that class, from
// front to back, that still fit into `left`.
struct Plan {
    marginal: u32,
    left: f32,
    spent: f32,
}

// Which of some steps are not taken. `affordable`: whether those of the marginal class are.
fn declined(plan: Plan, costs: vec4<f32>, classes: vec4<u32>, affordable: bool) -> vec4<bool> {
    let beyond = select(classes >= vec4(plan.marginal), classes > vec4(plan.marginal), vec4(affordable));
    return (costs > vec4(0.0)) & beyond;
}

// What the steps of the marginal class cost together.
fn marginal_cost(plan: Plan, costs: vec4<f32>, classes: vec4<u32>) -> f32 {
    let at_margin = (costs > vec4(0.0)) & (classes == vec4(plan.marginal));
    return dot(select(vec4(0.0), costs, at_margin), vec4(1.0));
}

fn plan_column(column: u32, reserve: f32) -> Plan {
    let budget = chunk.budget - reserve;
    var spent = 0.0;
    var class_index = 0u;
    for (; class_index < CLASSES; class_index += 1u) {
        let more = f32(atomicLoad(&spending[column * CLASSES + class_index])) * (chunk.budget / WHOLE);
        if spent + more > budget {
            break;
        }
        spent += more;
    }
    return Plan(class_index, budget - spent, spent);
}
