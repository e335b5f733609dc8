//! Stroh formalism of plane anisotropic elasticity, for cracks: roots p, matrices A and B, and the
//! real matrix L⁻¹ = Re(i A B⁻¹) that joins crack opening and stress intensity.
//!
//! A displacement u = a f(x + p y) needs |Q + p(R + Rᵀ) + p² T| = 0 with Q_ik = C_i1k1,
//! R_ik = C_i1k2, T_ik = C_i2k2; its stress functions are b f with b = (Rᵀ + p T) a. In the plane
//! the condition is a quartic with the compliances s = C⁻¹ (Voigt),
//!
//! s11 p⁴ − 2 s16 p³ + (2 s12 + s66) p² − 2 s26 p + s22 = 0,
//!
//! of whose roots those with Im p > 0 count. For an isotropic material they coincide (p = i) and A
//! and B are singular, but A B⁻¹ depends on their sum and product alone:
//!
//! L⁻¹ = s11 Im [ p₁+p₂, p₁p₂; p₁p₂, −(p₁+p₂)·conj(p₁p₂) ],
//!
//! so that one form serves every material.

use super::Stiffness;
use crate::Result;
use nalgebra::{Complex, Matrix2, Matrix3, Matrix4, Rotation2, Vector2};
use pd_core::Error;
use std::f64::consts::PI;

/// Mode I and mode II stress intensity factors in Pa√m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intensity {
    /// K_I: opening.
    pub i: f64,
    /// K_II: sliding.
    pub ii: f64,
}

/// The Stroh solution of a plane material with a crack, in crack axes: x₁ along the crack, towards
/// the tip, x₂ from the lower to the upper face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroh {
    /// Compliance in crack axes, Voigt, 1/Pa.
    s: Matrix3<f64>,
    roots: [Complex<f64>; 2],
    opening: Matrix2<f64>,
    /// From the axes of the problem to those of the crack.
    turn: Rotation2<f64>,
}

impl Stroh {
    /// For a crack whose tip points at `angle` (radians, counter-clockwise from x): 0 for the right
    /// end of a crack along x, π for its left end. The stiffness, in plane stress or plane strain,
    /// is in the axes of the problem.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for an angle that is not finite.
    pub fn new(stiffness: &Stiffness<2>, angle: f64) -> Result<Self> {
        Error::check(angle.is_finite(), "direction of a crack tip", angle, "finite")?;
        let own = stiffness.rotated(-angle).voigt();
        // Positive definite by construction, so the inverse exists.
        let s = own.try_inverse().unwrap_or_else(Matrix3::zeros);
        let roots = upper_roots(&s);
        let (sum, product) = (roots[0] + roots[1], roots[0] * roots[1]);
        let opening =
            Matrix2::new(sum.im, product.im, product.im, -(sum * product.conj()).im) * s[(0, 0)];
        Ok(Self { s, roots, opening, turn: Rotation2::new(-angle) })
    }

    /// The roots p with Im p > 0.
    pub fn roots(&self) -> [Complex<f64>; 2] {
        self.roots
    }
    /// Columns a of A, with B of [`b`](Self::b): (s11 p² − s16 p + s12, s12 p − s26 + s22/p).
    pub fn a(&self) -> Matrix2<Complex<f64>> {
        let s = |i: usize, j: usize| Complex::from(self.s[(i, j)]);
        let column = |p: Complex<f64>| {
            [s(0, 0) * p * p - s(0, 2) * p + s(0, 1), s(0, 1) * p - s(1, 2) + s(1, 1) / p]
        };
        Matrix2::from_columns(&self.roots.map(|p| Vector2::from(column(p))))
    }
    /// Columns b of B: (−p, 1).
    pub fn b(&self) -> Matrix2<Complex<f64>> {
        Matrix2::from_columns(&self.roots.map(|p| Vector2::new(-p, Complex::from(1.0))))
    }
    /// L⁻¹ = Re(i A B⁻¹) in 1/Pa, symmetric positive definite; 2/E' times the identity for an
    /// isotropic material.
    pub fn opening_compliance(&self) -> Matrix2<f64> {
        self.opening
    }

    /// Stress intensity from the opening Δu = u(upper face) − u(lower face), upper in crack axes (the
    /// face to the left of who walks towards the tip), in metres and in the
    /// axes of the problem, at the distance r in metres behind the tip (Hattori Eq. 33; errata
    /// 000-11): (K_II, K_I) = √(π/8r) L Δu.
    pub fn intensity(&self, r: f64, opening: &Vector2<f64>) -> Intensity {
        let l = self.opening.try_inverse().unwrap_or_else(Matrix2::zeros);
        let k = l * (self.turn * opening) * (PI / (8.0 * r)).sqrt();
        Intensity { i: k.y, ii: k.x }
    }
    /// The opening at the distance r behind the tip, in metres and in the axes of the problem: the
    /// inverse of [`intensity`](Self::intensity).
    pub fn opening(&self, r: f64, k: Intensity) -> Vector2<f64> {
        self.turn.inverse() * (self.opening * Vector2::new(k.ii, k.i)) * (8.0 * r / PI).sqrt()
    }
    /// Energy release rate G = ½ kᵀ L⁻¹ k in J/m², k = (K_II, K_I).
    pub fn energy_release_rate(&self, k: Intensity) -> f64 {
        let k = Vector2::new(k.ii, k.i);
        0.5 * k.dot(&(self.opening * k))
    }
}

/// Reads stress intensity from the openings at several distances r behind a tip.
///
/// One point gives K_app(r) = √(π/8r) L Δu(r) ([`Stroh::intensity`]), which is K + c₁ r near the tip
/// of a classical crack. A peridynamic crack opens as if its tip were further on by a part r₀ of
/// the horizon, Δu ∝ √(r + r₀), so that K_app(r) = K (1 + r₀/2r − …): too large by that, however fine
/// Δx is at a fixed r/δ. Both terms go in a least squares fit
///
/// K_app(r) = K + c₁ r + c₂/r,
///
/// whose K knows neither; r₀ need not be known, and [`tip`](Self::tip) tells it. It holds the same for
/// the openings of finite elements, where c₂/r takes the error of the mesh at the tip. Where there is
/// room for one point only, [`with_tip`](Self::with_tip) takes an r₀ that is known.
#[derive(Debug, Clone, PartialEq)]
pub struct OpeningFit {
    /// r, and weights: K = Σ weight K_app(r), c₂ = Σ weight K_app(r).
    points: Vec<(f64, [f64; 2])>,
    /// r₀ in metres.
    tip: f64,
}

impl OpeningFit {
    /// One point at the distance r in metres: K_app(r) itself.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn at(r: f64) -> Result<Self> {
        let r = Error::positive("distance behind a crack tip r [m]", r)?;
        Ok(Self { points: vec![(r, [1.0, 0.0])], tip: 0.0 })
    }
    /// The fit over `count` equidistant points from `low` to `high` in metres. Nearer than a horizon
    /// the opening is no longer that of a shifted tip.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless 0 < low < high, or for fewer than three points.
    pub fn between(low: f64, high: f64, count: usize) -> Result<Self> {
        Error::positive("distance behind a crack tip r [m]", low)?;
        Error::check(high > low && high.is_finite(), "end of a fit [m]", high, "above its start")?;
        Error::check(count >= 3, "points of a fit", count as f64, "at least 3")?;
        // With x = r/high the sums are of order 1: K is the first of the three coefficients.
        let place = |k: usize| low / high + (1.0 - low / high) * k as f64 / (count - 1) as f64;
        let row = |x: f64| nalgebra::Vector3::new(1.0, x, 1.0 / x);
        let normal: Matrix3<f64> =
            (0..count).map(|k| row(place(k)) * row(place(k)).transpose()).sum();
        let inverse = normal.try_inverse().unwrap_or_else(Matrix3::zeros);
        let weights = |k: usize| {
            let weights = inverse * row(place(k));
            (place(k) * high, [weights[0], weights[2] * high])
        };
        Ok(Self { points: (0..count).map(weights).collect(), tip: 0.0 })
    }
    /// The same with the tip taken r₀ in metres further on than the bonds are cut:
    /// K_app(r) = √(π/8(r + r₀)) L Δu(r). How far depends on the material, its influence function and
    /// its horizon, not on the load: [`tip`](Self::tip) of a fit tells.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for an r₀ that is not finite or negative.
    pub fn with_tip(mut self, tip: f64) -> Result<Self> {
        let ok = tip.is_finite() && tip >= 0.0;
        self.tip = Error::check(ok, "place of a crack's tip r₀ [m]", tip, "finite, not negative")?;
        Ok(self)
    }
    fn sum(&self, stroh: &Stroh, opening: impl Fn(f64) -> Vector2<f64>, part: usize) -> Intensity {
        self.points.iter().fold(Intensity { i: 0.0, ii: 0.0 }, |sum, &(r, weights)| {
            let k = stroh.intensity(r + self.tip, &opening(r));
            Intensity { i: sum.i + weights[part] * k.i, ii: sum.ii + weights[part] * k.ii }
        })
    }
    /// K from the opening Δu(r), as [`Stroh::intensity`] takes it.
    pub fn intensity(&self, stroh: &Stroh, opening: impl Fn(f64) -> Vector2<f64>) -> Intensity {
        self.sum(stroh, opening, 0)
    }
    /// How much further on the tip acts than where [`with_tip`](Self::with_tip) takes it, in metres:
    /// 2 K·c₂/K² by the fit, to first order in it over r. None by one point, nor without opening.
    pub fn tip(&self, stroh: &Stroh, opening: impl Fn(f64) -> Vector2<f64>) -> f64 {
        let k = self.sum(stroh, &opening, 0);
        let c = self.sum(stroh, &opening, 1);
        let square = k.i * k.i + k.ii * k.ii;
        if square > 0.0 { 2.0 * (k.i * c.i + k.ii * c.ii) / square } else { 0.0 }
    }
}

/// The roots of the quartic with Im p > 0, eigenvalues of its companion matrix. Where they
/// coincide each is known to √ε only, their sum and product to ε.
fn upper_roots(s: &Matrix3<f64>) -> [Complex<f64>; 2] {
    let c = [s[(1, 1)], -2.0 * s[(1, 2)], 2.0 * s[(0, 1)] + s[(2, 2)], -2.0 * s[(0, 2)]];
    // p = scale q brings the product of all roots to 1.
    let scale = (s[(1, 1)] / s[(0, 0)]).powf(0.25);
    let companion = Matrix4::from_fn(|i, j| {
        if j == 3 {
            -c[i] / (s[(0, 0)] * scale.powi(4 - i as i32))
        } else {
            f64::from(u8::from(i == j + 1))
        }
    });
    let mut roots: Vec<Complex<f64>> = companion.complex_eigenvalues().iter().copied().collect();
    roots.sort_by(|a, b| b.im.total_cmp(&a.im));
    [roots[0] * scale, roots[1] * scale]
}
