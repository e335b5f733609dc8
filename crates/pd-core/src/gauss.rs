//! Gauss–Legendre quadrature.

use std::sync::LazyLock;

const POINTS: usize = 64;

/// Nodes in (−1, 1) and weights.
static RULE: LazyLock<[(f64, f64); POINTS]> = LazyLock::new(|| {
    std::array::from_fn(|i| {
        let n = POINTS as f64;
        // Tricomi's estimate is close enough for Newton's method to square the error from the start.
        let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..6 {
            let (mut p, mut previous) = (x, 1.0);
            for k in 2..=POINTS {
                let k = k as f64;
                (p, previous) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * previous) / k, p);
            }
            slope = n * (x * p - previous) / (x * x - 1.0);
            x -= p / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
});

/// ∫ₐᵇ f(x) dx with 64 points: exact for polynomials up to degree 127.
pub fn integrate(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    half * RULE.iter().map(|(x, w)| w * f(middle + half * x)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_up_to_its_degree_and_no_further() {
        let error = |k: i32| integrate(0.0, 1.0, |x| x.powi(k)) * f64::from(k + 1) - 1.0;
        for k in 0..128 {
            assert!(error(k).abs() < 1e-13, "degree {k}: {:e}", error(k));
        }
        assert!((integrate(0.0, 1.0, |x| 1.0 / (x + 0.01)) - 101f64.ln()).abs() < 1e-4);
        assert!((integrate(-3.0, 5.0, f64::exp) - (5f64.exp() - (-3f64).exp())).abs() < 1e-12);
    }
}
