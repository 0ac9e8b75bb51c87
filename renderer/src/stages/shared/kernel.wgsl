// Smoothing kernels up to their constant, which drops out of the zero-order consistent sum.

override KERNEL: u32 = 0u; // Kernel::code: 0 poly6, 1 cubic, 2 Wendland C²

// Kernel values at four places, from x = max(1 − ρ², 0) with ρ = r/h. Zero where x is zero, and
// only there.
fn kernel(x: vec4<f32>) -> vec4<f32> {
    if KERNEL == 0u {
        return x * x * x;
    }
    let rho = sqrt(1.0 - x);
    // 1 − ρ without the cancellation near the edge of the support.
    let inside = x / (1.0 + rho);
    if KERNEL == 1u {
        let outer = 2.0 * inside * inside * inside;
        let inner = 1.0 - 6.0 * (rho * rho) * inside;
        return select(outer, inner, rho <= vec4(0.5));
    }
    let squared = inside * inside;
    return squared * squared * (1.0 + 4.0 * rho);
}
