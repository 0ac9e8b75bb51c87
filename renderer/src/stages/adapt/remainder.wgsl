// What expansions leave out, in a sum of quantities.

// Relative error of a sum of some hundred terms of f32, to the sum of their magnitudes.
const SUM_ROUNDING: f32 = 4e-6;

// The upper bound of Σ |q − λ|·m from Σ m, Σ q·m and Σ q²·m, m ≥ 0 (Cauchy and Schwarz). Where all q are close to λ
// its parts cancel, and what is left may be less than their rounding.
fn remainder(rest: vec4<f32>, rest_q: vec4<f32>, rest_qq: vec4<f32>, lambda: vec4<f32>) -> vec4<f32> {
    let squares = rest_qq - lambda * (2.0 * rest_q - lambda * rest);
    let rounding = SUM_ROUNDING * (rest_qq + abs(lambda) * (2.0 * abs(rest_q) + abs(lambda) * rest));
    return sqrt(rest) * sqrt(max(squares, vec4(0.0)) + rounding);
}
