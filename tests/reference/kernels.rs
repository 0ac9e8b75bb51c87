//! Smoothing kernels W(r, h): compact support h, unit integral over space (contract, section 1).

use std::f64::consts::PI;

/// The kernels of the contract's table, with ρ = r/h.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// 315/(64π h³)·(1 − ρ²)³
    Poly6,
    /// 8/(π h³)·{6(ρ³ − ρ²) + 1 for ρ ≤ ½; 2(1 − ρ)³ for ρ > ½}
    Cubic,
    /// 21/(2π h³)·(1 − ρ)⁴(1 + 4ρ)
    WendlandC2,
}

impl From<renderer::Kernel> for Kernel {
    fn from(kernel: renderer::Kernel) -> Kernel {
        match kernel {
            renderer::Kernel::Poly6 => Kernel::Poly6,
            renderer::Kernel::Cubic => Kernel::Cubic,
            renderer::Kernel::WendlandC2 => Kernel::WendlandC2,
        }
    }
}

impl Kernel {
    pub const ALL: [Kernel; 3] = [Kernel::Poly6, Kernel::Cubic, Kernel::WendlandC2];

    /// W(r, h) in 1/length³; zero for r ≥ h.
    pub fn weight(self, r: f64, h: f64) -> f64 {
        let rho = r / h;
        if rho >= 1.0 {
            return 0.0;
        }
        let h3 = h.powi(3);
        match self {
            Kernel::Poly6 => 315.0 / (64.0 * PI * h3) * (1.0 - rho * rho).powi(3),
            Kernel::Cubic if rho <= 0.5 => 8.0 / (PI * h3) * (6.0 * (rho.powi(3) - rho * rho) + 1.0),
            Kernel::Cubic => 8.0 / (PI * h3) * 2.0 * (1.0 - rho).powi(3),
            Kernel::WendlandC2 => 21.0 / (2.0 * PI * h3) * (1.0 - rho).powi(4) * (1.0 + 4.0 * rho),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ W 4πr² dr over the support by Simpson's rule, which is exact enough for these polynomials.
    fn integral(kernel: Kernel, h: f64) -> f64 {
        const STEPS: usize = 2_000;
        let f = |i: usize| {
            let r = h * i as f64 / STEPS as f64;
            kernel.weight(r, h) * 4.0 * PI * r * r
        };
        let inner: f64 = (1..STEPS).map(|i| if i % 2 == 1 { 4.0 * f(i) } else { 2.0 * f(i) }).sum();
        (f(0) + inner + f(STEPS)) * h / (3.0 * STEPS as f64)
    }

    #[test]
    fn kernels_integrate_to_one() {
        for kernel in Kernel::ALL {
            for h in [1e-12, 0.05, 1.0, 1e12] {
                let integral = integral(kernel, h);
                assert!((integral - 1.0).abs() < 1e-10, "{kernel:?}, h = {h}: {integral}");
            }
        }
    }

    #[test]
    fn kernels_fall_and_end_at_the_support() {
        for kernel in Kernel::ALL {
            let weights: Vec<f64> = (0..=1000).map(|i| kernel.weight(0.002 * f64::from(i), 2.0)).collect();
            assert!(weights.is_sorted_by(|a, b| a > b), "{kernel:?} does not fall");
            assert_eq!(kernel.weight(2.0, 2.0), 0.0);
            assert_eq!(kernel.weight(3.0, 2.0), 0.0);
            assert!(kernel.weight(2.0_f64.next_down(), 2.0) > 0.0);
        }
    }

    #[test]
    fn the_spline_has_no_jump_at_half_its_support() {
        let (below, above) = (Kernel::Cubic.weight(0.5, 1.0), Kernel::Cubic.weight(0.5_f64.next_up(), 1.0));
        assert!((below - above).abs() < 1e-14, "{below} and {above}");
    }
}
