//! `remainder.wgsl`, on the device: it is never below the true sum, nor much above what the inequality allows.

use super::REMAINDER_WGSL;
use crate::gpu::{Gpu, GpuOptions};
use crate::random::Random;
use crate::stages::found::Function;

/// A sum of |q − λ|·m, and what the device is told of it.
struct Case {
    what: String,
    /// Σ m, Σ q·m and Σ q²·m as the device adds them up; λ.
    given: [f32; 4],
    sum: f64,
    /// The square of what the inequality makes of it, without rounding, and with as much as sums of f32 need.
    squares: [f64; 2],
}

impl Case {
    /// Of some particles whose quantities are all about as far from one another as `spread` says, and a λ among
    /// them.
    fn new(random: &mut Random, count: usize, spread: f32) -> Case {
        let base = 2.0 * random.unit() - 1.0;
        let two_values = random.unit() < 0.5;
        let lambda = base + spread * (random.unit() - 0.5);
        let (mut given, mut sum, mut mass, mut square, mut magnitude) =
            ([0.0, 0.0, 0.0, lambda], 0.0, 0.0, 0.0, 0.0);
        for _ in 0..count {
            let m = 10.0_f32.powf(-4.0 * random.unit());
            let share = random.unit();
            // All as far from λ as one another: the inequality is an equation.
            let q = if two_values {
                lambda + spread * (share - 0.5).signum()
            } else {
                base + spread * (share - 0.5)
            };
            given[0] += m;
            given[1] += q * m;
            given[2] += q * q * m;
            let [q, m, lambda] = [q, m, lambda].map(f64::from);
            sum += (q - lambda).abs() * m;
            mass += m;
            square += (q - lambda).powi(2) * m;
            magnitude += (q.abs() + lambda.abs()).powi(2) * m;
        }
        let what = format!("{count} particles, spread {spread:e}, λ {lambda}, two values: {two_values}");
        Case { what, given, sum, squares: [mass * square, mass * (square + 2e-5 * magnitude)] }
    }
}

fn cases() -> Vec<Case> {
    let mut random = Random(1);
    let spreads = [0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1, 1.0];
    let kinds = [1, 2, 5, 20, 100, 500].into_iter().flat_map(|count| spreads.map(|spread| (count, spread)));
    kinds.flat_map(|kind| [kind; 40]).map(|(count, spread)| Case::new(&mut random, count, spread)).collect()
}

fn found(source: &str, cases: &[Case]) -> Vec<f64> {
    let gpu = Gpu::new(&GpuOptions::default()).expect("an adapter");
    let given: Vec<[f32; 4]> = cases.iter().map(|case| case.given).collect();
    let call = "remainder(given.xxxx, given.yyyy, given.zzzz, given.wwww).x";
    let function = Function { sources: &[source], resources: &[], types: ["vec4<f32>", "f32"], call };
    function.of::<_, f32>(&gpu, &given).into_iter().map(f64::from).collect()
}

#[test]
fn it_is_no_less_than_the_sum_and_hardly_more_than_cauchy_and_schwarz_say() {
    let cases = cases();
    for (case, found) in cases.iter().zip(found(REMAINDER_WGSL, &cases)) {
        let Case { what, sum, squares: [least, most], .. } = case;
        assert!(found >= *sum, "{what}: {found:e} is less than {sum:e}");
        assert!(found * found <= 1.00001 * most, "{what}: {found:e}, where {:e} would do", least.sqrt());
    }
}

#[test]
fn without_what_stands_for_rounding_it_would_be_less() {
    let careless = REMAINDER_WGSL.replace(" + rounding)", ")");
    assert_ne!(careless, REMAINDER_WGSL);
    let cases = cases();
    let found = found(&careless, &cases);
    assert!(cases.iter().zip(found).any(|(case, found)| found < case.sum));
}
