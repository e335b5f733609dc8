//! Influence functions ω: how much a bond counts, by its length.

use crate::gauss;

/// Influence ω of a bond of relative length r = |ξ|/δ, dimensionless.
///
/// Any `Fn(f64) -> f64` is one, so a function of your own is a closure:
/// ```
/// use pd_core::influence::{Influence, moment};
/// let quartic = |r: f64| (1.0 - r * r).powi(2).max(0.0);
/// assert_eq!(quartic.weight(0.5), 0.5625);
/// assert!((moment(&quartic, 0) - 8.0 / 15.0).abs() < 1e-14);
/// ```
pub trait Influence: Send + Sync {
    /// ω(r) for r = |ξ|/δ > 0.
    ///
    /// With [`Quadrature::Exact`](crate::Quadrature::Exact) and
    /// [`Quadrature::ExtendedRamp`](crate::Quadrature::ExtendedRamp) a neighbour whose centre lies
    /// outside the horizon can count, so r may exceed 1 by up to half a cell diagonal.
    fn weight(&self, r: f64) -> f64;
}

impl<F: Fn(f64) -> f64 + Send + Sync> Influence for F {
    fn weight(&self, r: f64) -> f64 {
        self(r)
    }
}

/// The influence functions of the literature. For r > 1 each is evaluated as it stands: zero for
/// the linear function and the spline, not zero for the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InfluenceFunction {
    /// ω = 1.
    #[default]
    Constant,
    /// ω = 1 − r, zero from r = 1 on (Hattori et al. 2018, Eq. 16). A bond as long as the horizon
    /// carries nothing: with δ = Δx there is no active bond at all.
    Linear,
    /// ω = exp(−r²) (Scabbia et al. 2024).
    Gaussian,
    /// Cubic B-spline of support 1 with ω(0) = 1: 1 − 6r² + 6r³ up to r = ½, then 2(1 − r)³.
    CubicSpline,
    /// ω = 1/r (the Madenci–Oterkus dilatation of Zhao et al. 2017, and the LPS of LAMMPS).
    Inverse,
}

impl Influence for InfluenceFunction {
    fn weight(&self, r: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Linear => (1.0 - r).max(0.0),
            Self::Gaussian => (-r * r).exp(),
            Self::CubicSpline if r < 0.5 => 1.0 - 6.0 * r * r * (1.0 - r),
            Self::CubicSpline => 2.0 * (1.0 - r).max(0.0).powi(3),
            Self::Inverse => r.recip(),
        }
    }
}

/// Moment ∫₀¹ ω(r) rᵏ dr, from which the constants of the models follow (c, w_C, s_c of any ω).
///
/// 64 Gauss–Legendre points on either side of r = ½: exact to rounding for every
/// [`InfluenceFunction`]. The integral must exist: [`InfluenceFunction::Inverse`] needs k ≥ 1.
pub fn moment<W: Influence + ?Sized>(influence: &W, k: i32) -> f64 {
    let integrand = |r: f64| influence.weight(r) * r.powi(k);
    gauss::integrate(0.0, 0.5, integrand) + gauss::integrate(0.5, 1.0, integrand)
}
