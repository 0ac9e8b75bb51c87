// A kernel around the middles of bricks: its derivatives, and what is left out after the second ones.

// A kernel W at distances ρ, in radii. Its second derivatives at p, |p| = ρ, are −bend·1 + stretch·p pᵀ:
// bend = −W'/ρ, stretch = (W'' + bend)/ρ². All kernels here have them, at the edge too.
struct Jet {
    value: vec4<f32>,
    bend: vec4<f32>,
    stretch: vec4<f32>,
}

fn kernel_jet(rho: vec4<f32>) -> Jet {
    let inside = max(1.0 - rho, vec4(0.0));
    if KERNEL == 0u {
        let x = inside * (1.0 + rho);
        return Jet(x * x * x, 6.0 * x * x, 24.0 * x);
    }
    // Where W'' has a cusp, p pᵀ outweighs what is infinite.
    let safe = max(rho, vec4(1e-6));
    let square = inside * inside;
    if KERNEL == 1u {
        let inner = rho <= vec4(0.5);
        return Jet(
            select(2.0 * inside * square, 1.0 - 6.0 * rho * rho * inside, inner),
            select(6.0 * square / safe, 12.0 - 18.0 * rho, inner),
            select(6.0 * inside * (1.0 + rho) / (safe * safe), vec4(18.0), inner) / safe,
        );
    }
    return Jet(square * square * (1.0 + 4.0 * rho), 20.0 * square * inside, 60.0 * square / safe);
}

// Upper bound of what a kernel's expansion at distance ρ leaves out, at places δ from there, |δ| ≤ `reach`:
// the way p to the particle has |p·δ| ≤ `product`.
fn kernel_rest(rho: vec4<f32>, reach: vec4<f32>, product: vec4<f32>) -> vec4<f32> {
    if KERNEL == 0u {
        return poly6_rest((1.0 - rho) * (1.0 + rho), reach * reach, product);
    }
    // From without, the kernel begins at the edge of the support.
    let span = clamp(1.0 + reach - rho, vec4(0.0), reach);
    return span * span * span / 6.0 * kernel_third(max(rho - reach, vec4(0.0)), rho + reach);
}

// At δ, 1 − ρ² is x + 2β − γ, β = p·δ, γ = δ². From without (x < 0) nothing is expanded, and the kernel is at most
// (x + 2β)³. From within its cube leaves out 8β³ − 12xβγ + 3xγ² − 12β²γ + 6βγ² − γ³; and outside the
// support, where the kernel is 0 and not that cube, its expansion is no more than this, and no less than −6xγ².
fn poly6_rest(x: vec4<f32>, square: vec4<f32>, product: vec4<f32>) -> vec4<f32> {
    let product_square = product * product;
    let inner = product * max(8.0 * product_square, 12.0 * x * square)
        + square * (max(12.0 * product_square, 6.0 * x * square) + square * (6.0 * product + square));
    let outer = max(x + 2.0 * product, vec4(0.0));
    return select(outer * outer * outer, inner, x > vec4(0.0));
}

// Upper bound of the third derivative of the other kernels in any direction, at distances from `near` to `far`.
//
// With c = cos of the angle to p it is W'''c³ + 3(W'' + bend)/ρ·(c − c³), and c − c³ ≤ 0.385.
fn kernel_third(near: vec4<f32>, far: vec4<f32>) -> vec4<f32> {
    let inside = max(1.0 - near, vec4(0.0));
    let last = min(far, vec4(1.0));
    if KERNEL == 1u {
        // 54c − 18c³ in the inner half; 18(1/ρ² − 1)(c − c³) − 12c³ in the outer one.
        let square = max(near * near, vec4(0.25));
        let outer = max(vec4(12.0), 6.93 * (1.0 / square - 1.0));
        return select(select(outer, vec4(36.0), near < vec4(0.5)), vec4(0.0), near >= vec4(1.0));
    }
    // 180(1 − ρ)²c − 60(1 − ρ²)c³: least at c = 1, where it is 120(1 − ρ)(1 − 2ρ), and that at ρ = ¾.
    let falling = 120.0 * inside * inside * sqrt(inside / (1.0 + near));
    let turn = clamp(vec4(0.75), near, max(near, last));
    return max(falling, 120.0 * (1.0 - turn) * (2.0 * turn - 1.0));
}

// A kernel of radius h around the middles of bricks: (x, y, ·) is the way from there to the particle, `along` its
// product with the direction.
fn taylor_of(
    jet: Jet, inverse_square: f32, x: vec4<f32>, y: vec4<f32>, along: vec4<f32>, direction: vec3<f32>,
) -> Taylor {
    let bend = inverse_square * jet.bend;
    let stretch = inverse_square * inverse_square * jet.stretch;
    let by_x = stretch * x;
    let by_y = stretch * y;
    return Taylor(
        jet.value,
        bend * x,
        bend * y,
        bend * along,
        by_x * x - bend,
        by_y * y - bend,
        stretch * along * along - dot(direction, direction) * bend,
        by_x * y,
        by_x * along - direction.x * bend,
        by_y * along - direction.y * bend,
    );
}
