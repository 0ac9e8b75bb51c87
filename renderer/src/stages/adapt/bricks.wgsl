// Bounds of the quantity in the bricks of a cell.
//
// In a brick with middle c, let N(x) = Σ (q_j − λ) w_j(x). Taylor's theorem gives
//   N(c + δ) ≤ N(c) + ∇N(c)·δ + ½ |δ|² Σ |q_j − λ| max|w_j''|,
// where the first two terms are sums in which neighbours cancel. Q ≤ λ wherever N ≤ 0. The last sum
// is at most √(Σ m_j · Σ (q_j − λ)² m_j), m_j = max|w_j''| (Cauchy and Schwarz): a parabola in λ from
// three sums. So one pass over the particles bounds Q from both sides, more tightly than intervals of
// the weights (their error falls with the brick's width, this one's with its square), and the lower
// bound of Σ w_j proves coverage.

// The brick, lengths and place as in the cell.
struct Brick {
    middle: vec3<f32>,
    // Of the column's axis, per unit of depth.
    direction: vec3<f32>,
    // How far samples lie from the middle: across, along depth, and in all.
    half_width: f32,
    half_depth: f32,
    reach: f32,
}

fn place_brick(lane: u32, axis: vec2<f32>) -> Brick {
    let from_axis = column_from_axis(lane % COLUMNS);
    let depths = frame.sample_offset[lane / COLUMNS];
    let direction = vec3(axis + from_axis, 1.0);
    let depth = 0.5 * (depths.x + depths.w);
    let half_depth = 0.5 * (depths.w - depths.x) * SLACK;
    let half_width = 0.5 * frame.pitch * (1.0 + depths.w) * SLACK;
    let across = sqrt(2.0) * half_width + half_depth * length(direction.xy);
    let reach = sqrt(across * across + half_depth * half_depth) * SLACK;
    return Brick(vec3(from_axis, 0.0) + depth * direction, direction, half_width, half_depth, reach);
}

const SLACK: f32 = 1.0001;

// Position relative to the cell, and 1/h².
var<workgroup> balls: array<vec4<f32>, LANES>;
// Weight, quantity relative to the cell's reference, 1/h.
var<workgroup> charges: array<vec3<f32>, LANES>;

fn load_particle(place: u32, lane: u32, middle: vec3<f32>, depth: f32, reference: f32) {
    let particle = pairs[place];
    let ball = projected[particle];
    let inverse_radius = depth / ball.w;
    balls[lane] = vec4((ball.xyz - middle) / depth, inverse_radius * inverse_radius);
    let quantity = quantities[particle];
    let rejected = quantity > REJECTED;
    charges[lane] = vec3(weights[particle], quantity - reference, inverse_radius);
    if rejected {
        // Touches no brick.
        balls[lane] = vec4(1e18, 0.0, 0.0, 1.0);
    }
}

// A kernel at distance ρ (in radii): its value, −W'/ρ, and an upper bound of the norm of its second
// derivative at ρ_near and beyond. All kernels here have a second derivative, at the edge too.
fn kernel_jet(rho: f32, rho_near: f32) -> vec3<f32> {
    let x = max(1.0 - rho * rho, 0.0);
    let inside = max(1.0 - rho, 0.0);
    let near = max(1.0 - rho_near, 0.0);
    if KERNEL == 0u {
        let s = rho_near * rho_near;
        let y = max(1.0 - s, 0.0);
        let radial = select(6.0 * y * (5.0 * s - 1.0), 4.8, s < 0.6);
        return vec3(x * x * x, 6.0 * x * x, max(6.0 * y * y, radial));
    }
    if KERNEL == 1u {
        let inner = rho <= 0.5;
        return vec3(
            select(2.0 * inside * inside * inside, 1.0 - 6.0 * rho * rho * inside, inner),
            select(6.0 * inside * inside / max(rho, 0.5), 12.0 - 18.0 * rho, inner),
            select(12.0 * near, max(12.0 - 18.0 * rho_near, 6.0), rho_near <= 0.5),
        );
    }
    let cube = inside * inside * inside;
    let radial = select(20.0 * near * near * (4.0 * rho_near - 1.0), 5.0, rho_near < 0.5);
    return vec3(inside * cube * (1.0 + 4.0 * rho), 20.0 * cube, max(20.0 * near * near * near, radial));
}

// Sums over the particles that may reach a brick.
struct Expansion {
    touching: u32,
    // Extremes of their quantities.
    low: f32,
    high: f32,
    // Gradient and value of Σ w, and of Σ q·w.
    weight: vec4<f32>,
    charge: vec4<f32>,
    // Σ m, Σ q·m, Σ q²·m, where m is the particle's bound of what the expansion leaves out.
    rest: vec3<f32>,
}

fn add_particle(sums: ptr<function, Expansion>, brick: Brick, ball: vec4<f32>, charge: vec3<f32>) {
    let offset = ball.xyz - brick.middle;
    let reach = brick.reach * charge.z;
    let rho = sqrt(dot(offset, offset) * ball.w);
    if rho >= 1.0 + reach + 1e-5 {
        return;
    }
    let jet = kernel_jet(rho, max(rho - reach, 0.0));
    let weighted = charge.x * vec4(jet.y * ball.w * offset, jet.x);
    // The second part stands for the rounding of ρ².
    let rest = charge.x * (0.5 * reach * reach * jet.z + 1e-6 * jet.y);
    let q = charge.y;
    (*sums).touching += 1u;
    (*sums).low = min((*sums).low, q);
    (*sums).high = max((*sums).high, q);
    (*sums).weight += weighted;
    (*sums).charge += q * weighted;
    (*sums).rest += rest * vec3(1.0, q, q * q);
}

// By how much a linear function with this gradient may exceed its value at the brick's middle.
fn swing(gradient: vec3<f32>, brick: Brick) -> f32 {
    return brick.half_width * (abs(gradient.x) + abs(gradient.y))
        + brick.half_depth * abs(dot(gradient, brick.direction));
}

// The upper bound of Σ (q − λ)·w over the brick; falls with λ, and is convex in it.
fn excess(sums: Expansion, brick: Brick, lambda: f32) -> f32 {
    let linear = sums.charge - lambda * sums.weight;
    let rest = sums.rest.z - lambda * (2.0 * sums.rest.y - lambda * sums.rest.x);
    return linear.w + swing(linear.xyz, brick) + sqrt(max(sums.rest.x * rest, 0.0));
}

// An upper bound of Q over the brick, where Σ w is at least `least_weight` > 0.
fn upper_bound(sums: Expansion, brick: Brick, least_weight: f32) -> f32 {
    let mean = sums.charge.w / sums.weight.w;
    let above = max(excess(sums, brick, mean), 0.0);
    // The excess falls at least as fast as −least_weight, so it is not positive here; and as it is
    // convex, its chord crosses zero no earlier than itself.
    let far = above / least_weight;
    let below = min(excess(sums, brick, mean + far), 0.0);
    return mean + far * select(1.0, above / (above - below), above > below);
}

fn values_of(sums: Expansion, brick: Brick, reference: f32) -> u32 {
    if sums.touching == 0u {
        return EMPTY;
    }
    var low = sums.low;
    var high = sums.high;
    let least_weight = sums.weight.w * (1.0 - 1e-5) - swing(sums.weight.xyz, brick) - sums.rest.x;
    let covered = least_weight > 1e-4 * sums.weight.w;
    if covered {
        let mirrored = Expansion(
            sums.touching, 0.0, 0.0, sums.weight, -sums.charge, sums.rest * vec3(1.0, -1.0, 1.0));
        let rounding = 4e-6 * max(abs(low), abs(high));
        let upper = upper_bound(sums, brick, least_weight) + rounding;
        let lower = -upper_bound(mirrored, brick, least_weight) - rounding;
        // Where one of them is no number, the extremes stay.
        if lower <= upper {
            high = min(high, max(upper, low));
            low = max(low, min(lower, high));
        }
    }
    // Rounded outward by as much as the sum may be off.
    low = clamp(reference + low - 1e-6, 0.0, 1.0);
    high = clamp(reference + high + 1e-6, 0.0, 1.0);
    return pack_values(low, high, covered);
}
