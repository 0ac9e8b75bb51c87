// Bounds of the quantity in the four bricks of a column, all at once: components of vec4 are bricks,
// from front to back.
//
// In a brick with middle c, let N(x) = Σ (q_j − λ) w_j(x). Taylor's theorem gives
//   N(c + δ) ≤ N(c) + ∇N(c)·δ + ½ δ·H(c)δ + C(δ) + Σ |q_j − λ| m_j, H = N'', C of third order (cubic.wgsl),
// where all but the last term are sums in which neighbours cancel, and m_j bounds what the expansion of w_j
// leaves out. Q ≤ λ wherever N ≤ 0. The last sum is at most √(Σ m_j · Σ (q_j − λ)² m_j) (Cauchy and Schwarz): a
// parabola in λ from three sums. So one pass over the particles bounds Q from both sides, more tightly than
// intervals of the weights (their error falls with the brick's width, this one's with its cube and more), and
// the lower bound of Σ w_j proves coverage.
//
// Where samples lie in a brick, δ = a·x̂ + b·ŷ + s·(direction of the column): derivatives are taken with
// respect to a, b and s.

// Parts that are left out where somebody measures what they are worth.
override EXTREMES_ONLY: bool = false;
override NO_COVERAGE: bool = false;

// Lengths and places as in the cell.
struct Column {
    // The axis where it crosses the middle of the cell, and its direction per unit of depth.
    from_axis: vec2<f32>,
    direction: vec3<f32>,
    // Depths of the bricks' middles.
    depth: vec4<f32>,
    // How far samples lie from the middle of a brick: across, along depth, and in all.
    half_width: vec4<f32>,
    half_depth: vec4<f32>,
    reach: vec4<f32>,
    // None lies closer to its axis, or to its middle along depth.
    least_width: vec4<f32>,
    least_depth: vec4<f32>,
}

// The samples of a square of so many columns around an axis, as if they were one.
fn bundle_of_columns(from_axis: vec2<f32>, columns: u32, axis: vec2<f32>) -> Column {
    let at = frame.sample_offset;
    let first = vec4(at[0].x, at[1].x, at[2].x, at[3].x);
    let second = vec4(at[0].y, at[1].y, at[2].y, at[3].y);
    let third = vec4(at[0].z, at[1].z, at[2].z, at[3].z);
    let last = vec4(at[0].w, at[1].w, at[2].w, at[3].w);
    let depth = 0.5 * (first + last);
    let direction = vec3(axis + from_axis, 1.0);
    // In pixels.
    let aside = 0.5 * (f32(COLUMN_SIDE) * sqrt(f32(columns)) - 1.0);
    let half_depth = 0.5 * (last - first) * SLACK;
    let half_width = aside * frame.pitch * (1.0 + last) * SLACK;
    let across = sqrt(2.0) * half_width + half_depth * length(direction.xy);
    let reach = sqrt(across * across + half_depth * half_depth) * SLACK;
    let least_width = 0.5 * frame.pitch * (1.0 + first) / SLACK;
    let least_depth = min(abs(second - depth), abs(third - depth)) / SLACK;
    return Column(from_axis, direction, depth, half_width, half_depth, reach, least_width, least_depth);
}

fn column_at(column: u32, axis: vec2<f32>) -> Column {
    return bundle_of_columns(column_from_axis(column), 1u, axis);
}

// The axis amid a square of so many columns: on Morton's curve the first and the last one are opposite corners.
fn axis_of_columns(first: u32, columns: u32) -> vec2<f32> {
    return 0.5 * (column_from_axis(first) + column_from_axis(first + columns - 1u));
}

struct Expansion {
    // Σ w and Σ q·w.
    weight: Taylor,
    charge: Taylor,
    // Σ of weights that the particles have at least, wherever in a brick.
    least: vec4<f32>,
    // Σ m, Σ q·m, Σ q²·m, where m bounds what the expansion of a particle leaves out.
    rest: vec4<f32>,
    rest_q: vec4<f32>,
    rest_qq: vec4<f32>,
    // Extremes of the quantity of particles that reach a brick: inverted where there are none.
    low: vec4<f32>,
    high: vec4<f32>,
    // Σ of the particles' weights, wherever they are; and what the magnitudes of terms add up to that have been
    // moved (sheaves.wgsl).
    mass: f32,
    moved: f32,
}

fn no_expansion() -> Expansion {
    let none = vec4(0.0);
    return Expansion(no_taylor(), no_taylor(), none, none, none, none, vec4(FAR), vec4(-FAR), 0.0, 0.0);
}

// What a particle adds to the sums of a column's bricks, whatever its quantity.
struct Share {
    term: Taylor,
    least: vec4<f32>,
    // Bounds what the expansion leaves out.
    left_out: vec4<f32>,
    mass: f32,
    // Bricks that the particle may reach.
    reached: vec4<bool>,
}

// Ways from the middles of bricks to a particle, in radii.
struct Ways {
    x: vec4<f32>,
    y: vec4<f32>,
    // Their products with the direction of the column.
    along: vec4<f32>,
    rho: vec4<f32>,
    // With the way from there to a sample, δ, at most: |δ|, the product p·δ, and 2 p·δ − δ².
    reach: vec4<f32>,
    product: vec4<f32>,
    nearing: vec4<f32>,
}

// `ball`: place relative to the cell, and 1/h².
fn ways_to(column: Column, ball: vec4<f32>) -> Ways {
    let inverse_radius = sqrt(ball.w);
    let from_axis = (ball.xyz - vec3(column.from_axis, 0.0)) * inverse_radius;
    let depth = column.depth * inverse_radius;
    let x = from_axis.x - depth * column.direction.x;
    let y = from_axis.y - depth * column.direction.y;
    let z = from_axis.z - depth;
    let along = x * column.direction.x + y * column.direction.y + z;
    let aside = column.half_width * inverse_radius * (abs(x) + abs(y));
    let half_depth = column.half_depth * inverse_radius;
    let behind = half_depth * abs(along);
    // δ is no shorter than it is deep.
    let nearing = select(along * along, 2.0 * behind - half_depth * half_depth, abs(along) > half_depth);
    let rho = sqrt(x * x + y * y + z * z);
    return Ways(x, y, along, rho, column.reach * inverse_radius, aside + behind, 2.0 * aside + nearing);
}

// Which bricks a particle may reach.
fn reached_on(ways: Ways) -> vec4<bool> {
    return (1.0 - ways.rho) * (1.0 + ways.rho) + ways.nearing > vec4(-2e-5);
}

// Kernel weights that a share takes: one in the middle of each brick.
const EVALUATIONS_OF_SHARE: u32 = BRICK_DEPTH;

// The share of a particle of some weight and 1/h².
fn share_of(column: Column, ways: Ways, inverse_square: f32, weight: f32) -> Share {
    let jet = weighted_jet(weight, ways.rho);
    let term = taylor_of(jet, sqrt(inverse_square), ways, column.direction);
    // The second part stands for the rounding of ρ².
    let left_out = weight * kernel_rest(ways) + 1e-6 * jet.bend;
    // A kernel only falls with the distance: what it is where a brick is farthest, by its expansion to there.
    let bent = jet.stretch * ways.product * ways.product - jet.bend * ways.reach * ways.reach;
    let fall = jet.bend * ways.product - 0.5 * bent + cubic_fall(jet, ways);
    let least = max(jet.value * (1.0 - 1e-5) - fall - left_out, vec4(0.0));
    return Share(term, least, left_out, weight, reached_on(ways));
}

// Adds a particle's share, with its quantity relative to the cell's reference.
fn add_share(expansion: ptr<function, Expansion>, share: Share, q: f32) {
    (*expansion).weight = plus((*expansion).weight, 1.0, share.term);
    (*expansion).charge = plus((*expansion).charge, q, share.term);
    (*expansion).mass += share.mass;
    (*expansion).least += share.least;
    (*expansion).rest += share.left_out;
    (*expansion).rest_q += q * share.left_out;
    (*expansion).rest_qq += q * q * share.left_out;
    (*expansion).low = select((*expansion).low, min((*expansion).low, vec4(q)), share.reached);
    (*expansion).high = select((*expansion).high, max((*expansion).high, vec4(q)), share.reached);
}

// The upper bound of Σ |q − λ|·m.
fn left_out_of(e: Expansion, lambda: vec4<f32>) -> vec4<f32> {
    return remainder(e.rest, e.rest_q, e.rest_qq, lambda);
}

// The upper bound of Σ (q − λ)·w over the bricks where `side` is 1, of Σ (λ − q)·w where it is −1.
fn excess(e: Expansion, column: Column, lambda: vec4<f32>, side: f32) -> vec4<f32> {
    let relative = less(e.charge, lambda, e.weight);
    let known = side * relative.value + swing(relative, column) + sag(relative, column, side);
    return known + twist(relative.cubic, column) + left_out_of(e, lambda);
}

// The square of a quantity, times a sum of weights, is a number. (Weights are at most 10¹⁵.)
const LARGEST_QUANTITY: f32 = 1e8;

// An upper (side 1) or lower (side −1) bound of Q, where Σ w is at least `least_weight` > 0.
//
// Q is farther from λ than the mean by no more than the excess over Σ w: `far`. And where the excess is
// negative there, a tighter bound lies between: it is convex, so its chord crosses zero no earlier.
fn bound(e: Expansion, column: Column, least_weight: vec4<f32>, side: f32) -> vec4<f32> {
    let mean = e.charge.value / e.weight.value;
    let above = max(excess(e, column, mean, side), vec4(0.0));
    let far = above / least_weight;
    let below = min(excess(e, column, mean + side * far, side), vec4(0.0));
    return mean + side * far * select(vec4(1.0), above / (above - below), above > below);
}

// Well within what half floats hold, as they are kept: no brick that is as steep follows its slope.
const STEEP: f32 = 15.0;

// How the quantity runs through bricks in which Σ w is at least `least_weight`, and how far it is from that:
// Q − mean = N/Σw, where only ∇N·δ, a middle of what is quadratic in δ, and the Σw of the middle are taken.
fn add_slopes(values: ptr<function, ColumnValues>, e: Expansion, column: Column, least_weight: vec4<f32>) {
    let mean = e.charge.value / e.weight.value;
    let relative = less(e.charge, mean, e.weight);
    let right = clamp(column.half_width * relative.a / e.weight.value, vec4(-STEEP), vec4(STEEP));
    let up = clamp(column.half_width * relative.b / e.weight.value, vec4(-STEEP), vec4(STEEP));
    let back = clamp(column.half_depth * relative.s / e.weight.value, vec4(-STEEP), vec4(STEEP));
    let too_steep = max(max(abs(right), abs(up)), abs(back)) >= vec4(STEEP);
    let rise = abs(right) + abs(up) + abs(back);
    // What is left is known up to the second order, too: its middle is added to the slope.
    let bent = bend_of_quotient(relative, e.weight);
    let most = sag(bent, column, 1.0);
    let least = -sag(bent, column, -1.0);
    let lift = 0.5 * (most + least) / e.weight.value;
    let weight_bent = sag_either_way(e.weight, column) + twist(e.weight.cubic, column) + e.rest;
    let weight_off = rise * weight_bent + abs(lift) * (swing(e.weight, column) + weight_bent);
    let off = 0.5 * (most - least) + twist(relative.cubic, column) + weight_off + left_out_of(e, mean);
    // Half floats have 11 bits.
    let rounding = 0.001 * rise + sum_rounding(e, least_weight) + 4e-6;
    let all_off = min(off / least_weight + rounding, vec4(WIDEST)) * 1.001;
    (*values).middle += mean + lift;
    for (var i = 0u; i < BRICK_DEPTH; i += 1u) {
        (*values).across[i] = pack_slope(vec2(right[i], up[i]));
        (*values).along[i] = pack_slope(vec2(back[i], select(all_off[i], WIDEST, too_steep[i])));
    }
}

// What the magnitudes of the terms of Σ w add up to.
fn magnitude(e: Expansion) -> vec4<f32> {
    return max(e.weight.value, vec4(e.moved));
}

// By how much the rounding of the sums may move a bound of Q.
fn sum_rounding(e: Expansion, least_weight: vec4<f32>) -> vec4<f32> {
    return SUM_ROUNDING * max(abs(e.low), abs(e.high)) * max(magnitude(e) / least_weight, vec4(1.0));
}

fn values_of(e: Expansion, column: Column, reference: f32) -> ColumnValues {
    let swayed = swing(e.weight, column) + sag(e.weight, column, -1.0) + twist(e.weight.cubic, column) + e.rest;
    let expanded = e.weight.value - 1e-5 * magnitude(e) - swayed;
    let least_weight = max(expanded, e.least * (1.0 - 1e-5));
    // Beyond, sums of squares may overflow.
    let sound = max(abs(e.low), abs(e.high)) < vec4(LARGEST_QUANTITY);
    // A polynomial, moved, may be anything where it leaves out much.
    let known = (least_weight > 1e-4 * e.weight.value) & (e.weight.value > 0.1 * least_weight);
    let covered = sound & known & (least_weight > vec4(0.0));
    let safe_weight = select(vec4(1.0), least_weight, covered);
    let rounding = sum_rounding(e, safe_weight);
    let upper = bound(e, column, safe_weight, 1.0) + rounding;
    let lower = bound(e, column, safe_weight, -1.0) - rounding;
    // Where one of them is no number, the extremes stay.
    let better = covered & (lower <= upper) & vec4(!EXTREMES_ONLY);
    let low = select(e.low, max(e.low, min(lower, e.high)), better);
    let high = select(e.high, min(e.high, max(upper, e.low)), better);
    // Rounded outward by as much as a sample's quantity may be off.
    let least = clamp(reference + low - 2e-6, vec4(0.0), vec4(1.0));
    let greatest = clamp(reference + high + 2e-6, vec4(0.0), vec4(1.0));
    let empty = e.low > e.high;
    var values = ColumnValues(
        select(least, vec4(EMPTY.x), empty),
        select(greatest + select(vec4(0.0), vec4(COVERED), covered & vec4(!NO_COVERAGE)), vec4(EMPTY.y), empty),
        vec4(reference),
        vec4(0u),
        vec4(0u),
    );
    add_slopes(&values, e, column, safe_weight);
    return values;
}
