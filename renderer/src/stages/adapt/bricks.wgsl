// Bounds of the quantity in the four bricks of a column, all at once: components of vec4 are bricks,
// from front to back.
//
// In a brick with middle c, let N(x) = Σ (q_j − λ) w_j(x). Taylor's theorem gives
//   N(c + δ) ≤ N(c) + ∇N(c)·δ + ½ |δ|² Σ |q_j − λ| max|w_j''|,
// where the first two terms are sums in which neighbours cancel. Q ≤ λ wherever N ≤ 0. The last sum
// is at most √(Σ m_j · Σ (q_j − λ)² m_j), m_j = max|w_j''| (Cauchy and Schwarz): a parabola in λ from
// three sums. So one pass over the particles bounds Q from both sides, more tightly than intervals of
// the weights (their error falls with the brick's width, this one's with its square), and the lower
// bound of Σ w_j proves coverage.

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
}

fn column_at(column: u32, axis: vec2<f32>) -> Column {
    let at = frame.sample_offset;
    let first = vec4(at[0].x, at[1].x, at[2].x, at[3].x);
    let last = vec4(at[0].w, at[1].w, at[2].w, at[3].w);
    let from_axis = column_from_axis(column);
    let direction = vec3(axis + from_axis, 1.0);
    let half_depth = 0.5 * (last - first) * SLACK;
    let half_width = 0.5 * frame.pitch * (1.0 + last) * SLACK;
    let across = sqrt(2.0) * half_width + half_depth * length(direction.xy);
    let reach = sqrt(across * across + half_depth * half_depth) * SLACK;
    return Column(from_axis, direction, 0.5 * (first + last), half_width, half_depth, reach);
}

const SLACK: f32 = 1.0001;

// Sums over particles: of w, of −w'/r, and of −w'/r times the particle's place relative to the
// column's axis in the cell: across, and along the column.
struct Sums {
    value: vec4<f32>,
    bend: vec4<f32>,
    bend_x: vec4<f32>,
    bend_y: vec4<f32>,
    bend_along: vec4<f32>,
}

struct Expansion {
    // With the weights alone, and times the quantity.
    weight: Sums,
    charge: Sums,
    // Σ of the least weights that the particles have anywhere in a brick.
    least: vec4<f32>,
    // Σ m, Σ q·m, Σ q²·m, where m bounds what the expansion of a particle leaves out.
    rest: vec4<f32>,
    rest_q: vec4<f32>,
    rest_qq: vec4<f32>,
    // Extremes of the quantity of particles that reach a brick: inverted where there are none.
    low: vec4<f32>,
    high: vec4<f32>,
}

fn no_sums() -> Sums {
    return Sums(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
}

fn no_expansion() -> Expansion {
    let none = vec4(0.0);
    return Expansion(no_sums(), no_sums(), none, none, none, none, vec4(FAR), vec4(-FAR));
}

const FAR: f32 = 1e30;

// A kernel at distances ρ (in radii): its value, −W'/ρ, and an upper bound of the norm of its second
// derivative at ρ_near and beyond. All kernels here have a second derivative, at the edge too.
struct Jet {
    value: vec4<f32>,
    bend: vec4<f32>,
    curvature: vec4<f32>,
}

fn kernel_jet(rho: vec4<f32>, rho_near: vec4<f32>) -> Jet {
    let inside = max(1.0 - rho, vec4(0.0));
    let near = max(1.0 - rho_near, vec4(0.0));
    if KERNEL == 0u {
        let x = inside * (1.0 + rho);
        let s = rho_near * rho_near;
        let y = near * (1.0 + rho_near);
        let radial = select(6.0 * y * (5.0 * s - 1.0), vec4(4.8), s < vec4(0.6));
        return Jet(x * x * x, 6.0 * x * x, max(6.0 * y * y, radial));
    }
    if KERNEL == 1u {
        let inner = rho <= vec4(0.5);
        return Jet(
            select(2.0 * inside * inside * inside, 1.0 - 6.0 * rho * rho * inside, inner),
            select(6.0 * inside * inside / max(rho, vec4(0.5)), 12.0 - 18.0 * rho, inner),
            select(12.0 * near, max(12.0 - 18.0 * rho_near, vec4(6.0)), rho_near <= vec4(0.5)),
        );
    }
    let cube = inside * inside * inside;
    let radial = select(20.0 * near * near * (4.0 * rho_near - 1.0), vec4(5.0), rho_near < vec4(0.5));
    return Jet(inside * cube * (1.0 + 4.0 * rho), 20.0 * cube, max(20.0 * near * near * near, radial));
}

// The kernel's value at distances ρ.
fn kernel_at(rho: vec4<f32>) -> vec4<f32> {
    let inside = max(1.0 - rho, vec4(0.0));
    return kernel(inside * (1.0 + rho));
}

fn plus(sums: Sums, factor: f32, value: vec4<f32>, bend: vec4<f32>, place: vec3<f32>) -> Sums {
    let b = factor * bend;
    return Sums(
        sums.value + factor * value,
        sums.bend + b,
        sums.bend_x + b * place.x,
        sums.bend_y + b * place.y,
        sums.bend_along + b * place.z,
    );
}

// Adds a particle (place relative to the cell, and 1/h²) of some weight, and quantity relative to the
// cell's reference. Returns how many bricks it may reach.
fn add_particle(
    expansion: ptr<function, Expansion>, column: Column, ball: vec4<f32>, weight: f32, q: f32,
) -> u32 {
    let from_axis = ball.xyz - vec3(column.from_axis, 0.0);
    let inverse_radius = sqrt(ball.w);
    let x = from_axis.x - column.depth * column.direction.x;
    let y = from_axis.y - column.depth * column.direction.y;
    let z = from_axis.z - column.depth;
    let rho = sqrt(x * x + y * y + z * z) * inverse_radius;
    let reach = column.reach * inverse_radius;
    let reached = rho < 1.0 + reach + 1e-5;
    let jet = kernel_jet(rho, max(rho - reach, vec4(0.0)));
    // The second part stands for the rounding of ρ².
    let left_out = weight * (0.5 * reach * reach * jet.curvature + 1e-6 * jet.bend);
    let place = vec3(from_axis.xy, dot(from_axis, column.direction));
    let bend = ball.w * jet.bend;
    (*expansion).weight = plus((*expansion).weight, weight, jet.value, bend, place);
    (*expansion).charge = plus((*expansion).charge, weight * q, jet.value, bend, place);
    (*expansion).least += weight * kernel_at(rho + reach + 1e-6);
    (*expansion).rest += left_out;
    (*expansion).rest_q += q * left_out;
    (*expansion).rest_qq += q * q * left_out;
    (*expansion).low = select((*expansion).low, min((*expansion).low, vec4(q)), reached);
    (*expansion).high = select((*expansion).high, max((*expansion).high, vec4(q)), reached);
    return u32(dot(select(vec4(0.0), vec4(1.0), reached), vec4(1.0)));
}

fn less(a: Sums, factor: vec4<f32>, b: Sums) -> Sums {
    return Sums(
        a.value - factor * b.value,
        a.bend - factor * b.bend,
        a.bend_x - factor * b.bend_x,
        a.bend_y - factor * b.bend_y,
        a.bend_along - factor * b.bend_along,
    );
}

// By how much the linear part of the expansion may exceed its value at the middle.
fn swing(sums: Sums, column: Column) -> vec4<f32> {
    let along = dot(column.direction, column.direction);
    let gradient_x = sums.bend_x - column.depth * column.direction.x * sums.bend;
    let gradient_y = sums.bend_y - column.depth * column.direction.y * sums.bend;
    let gradient_along = sums.bend_along - column.depth * along * sums.bend;
    return column.half_width * (abs(gradient_x) + abs(gradient_y)) + column.half_depth * abs(gradient_along);
}

// The upper bound of Σ (q − λ)·w over the bricks where `side` is 1, of Σ (λ − q)·w where it is −1.
fn excess(e: Expansion, column: Column, lambda: vec4<f32>, side: f32) -> vec4<f32> {
    let linear = less(e.charge, lambda, e.weight);
    let rest = e.rest_qq - lambda * (2.0 * e.rest_q - lambda * e.rest);
    return side * linear.value + swing(linear, column) + sqrt(max(e.rest * rest, vec4(0.0)));
}

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

fn values_of(e: Expansion, column: Column, reference: f32) -> ColumnValues {
    let known = e.weight.value * (1.0 - 1e-5) - swing(e.weight, column) - e.rest;
    let expanded = select(known, vec4(0.0), EXTREMES_ONLY);
    let least_weight = max(expanded, e.least * (1.0 - 1e-5));
    let covered = least_weight > 1e-4 * e.weight.value;
    let safe_weight = select(vec4(1.0), least_weight, covered);
    let rounding = 4e-6 * max(abs(e.low), abs(e.high));
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
    return ColumnValues(
        select(least, vec4(EMPTY.x), empty),
        select(greatest + select(vec4(0.0), vec4(COVERED), covered & vec4(!NO_COVERAGE)), vec4(EMPTY.y), empty),
    );
}
