// A kernel around the middles of bricks: its derivatives, and what its expansion leaves out.

// A kernel W at distances ρ, in radii. Its second derivatives at p, |p| = ρ, are −bend·1 + stretch·p pᵀ:
// bend = −W'/ρ, stretch = (W'' + bend)/ρ². All kernels here have them, at the edge too.
struct Jet {
    value: vec4<f32>,
    bend: vec4<f32>,
    stretch: vec4<f32>,
    // Of poly6: inside its support, the factor of (p·δ)³ at δ.
    cube: vec4<f32>,
}

fn kernel_jet(rho: vec4<f32>) -> Jet {
    let inside = max(1.0 - rho, vec4(0.0));
    if KERNEL == 0u {
        let x = inside * (1.0 + rho);
        return Jet(x * x * x, 6.0 * x * x, 24.0 * x, select(vec4(0.0), vec4(8.0), x > vec4(0.0)));
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
            vec4(0.0),
        );
    }
    return Jet(square * square * (1.0 + 4.0 * rho), 20.0 * square * inside, 60.0 * square / safe, vec4(0.0));
}

fn weighted_jet(weight: f32, rho: vec4<f32>) -> Jet {
    let jet = kernel_jet(rho);
    return Jet(weight * jet.value, weight * jet.bend, weight * jet.stretch, weight * jet.cube);
}

// Upper bound of what a kernel's expansion leaves out at any sample.
fn kernel_rest(ways: Ways) -> vec4<f32> {
    if KERNEL == 0u {
        return poly6_rest((1.0 - ways.rho) * (1.0 + ways.rho), ways);
    }
    // From without, the kernel begins at the edge of the support.
    let span = clamp(1.0 + ways.reach - ways.rho, vec4(0.0), ways.reach);
    let near = max(ways.rho - ways.reach, vec4(0.0));
    return span * span * span / 6.0 * kernel_third(near, ways.rho + ways.reach);
}

// At δ, 1 − ρ² is x + 2β − γ, β = p·δ, γ = δ², and the kernel its cube. The expansion of that, up to the third order,
// leaves out 3xγ² − 12β²γ + 6βγ² − γ³; where 1 − ρ² is below 0, and the kernel 0, the cube besides. From without
// (x < 0) nothing is expanded, and the kernel itself is left out.
fn poly6_rest(x: vec4<f32>, ways: Ways) -> vec4<f32> {
    let square = ways.reach * ways.reach;
    let product = ways.product;
    let rest = square * (max(12.0 * product * product, 3.0 * x * square) + square * (6.0 * product + square));
    let below = max(2.0 * product + square - x, vec4(0.0));
    let above = max(ways.nearing + x, vec4(0.0));
    return select(above * above * above, rest + below * below * below, x > vec4(0.0));
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

// A kernel around the middles of bricks.
fn taylor_of(jet: Jet, inverse_radius: f32, ways: Ways, direction: vec3<f32>) -> Taylor {
    let inverse_square = inverse_radius * inverse_radius;
    let slope = inverse_radius * jet.bend;
    let bend = inverse_square * jet.bend;
    let by_x = inverse_square * jet.stretch * ways.x;
    let by_y = inverse_square * jet.stretch * ways.y;
    let by_along = inverse_square * jet.stretch * ways.along;
    return Taylor(
        jet.value,
        slope * ways.x,
        slope * ways.y,
        slope * ways.along,
        by_x * ways.x - bend,
        by_y * ways.y - bend,
        by_along * ways.along - dot(direction, direction) * bend,
        by_x * ways.y,
        by_x * ways.along - direction.x * bend,
        by_y * ways.along - direction.y * bend,
        cubic_of(jet, inverse_radius, ways, direction),
    );
}
