//! The linear peridynamic solid (LPS): ordinary, isotropic, any Poisson's ratio.

use crate::Result;
use crate::elasticity::{Isotropic, PlaneMode};
use crate::kinematics::BondLength;
use crate::ordinary::ScalarState;
use nalgebra::SVector;
use pd_core::bond::{Bond, Neighbourhood, Scale};
use pd_core::influence::Influence;
use pd_core::{Real, Result as CoreResult};
use std::f64::consts::PI;
use std::sync::Arc;

/// Linear peridynamic solid (Silling; Willberg §2, Scabbia §3) in the form that is regular for
/// every ν (errata 004-18):
///
/// t = (ω/m)[D κ θ|ξ| + α(e − θ|ξ|/D)], θ = (D/m) Σ μ ω|ξ| e βV (the trace of the strain),
///
/// with m = Σ ω|ξ|²βV, α = 15G in 3D and 8G in 2D, κ the bulk modulus of space or plane.
/// Its energy is W = ½κθ² + ½(α/m) Σ ω(e − θ|ξ|/D)²βV. Use it as `Ordinary::new(LinearSolid::…)`.
#[derive(Clone)]
pub struct LinearSolid {
    kappa: f64,
    alpha: f64,
    dimension: usize,
    density: f64,
    influence: Arc<dyn Influence>,
}

impl LinearSolid {
    /// A solid (3D): κ = K, α = 15G.
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn solid(
        moduli: &Isotropic,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        Self::new(moduli.bulk(), 15.0 * moduli.shear(), 3, density, influence)
    }
    /// A plate: α = 8G, κ = E/(2(1−ν)) in plane stress and E/(2(1+ν)(1−2ν)) in plane strain.
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn plane(
        moduli: &Isotropic,
        mode: PlaneMode,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        Self::new(moduli.plane_bulk(mode), 8.0 * moduli.shear(), 2, density, influence)
    }
    fn new(
        kappa: f64,
        alpha: f64,
        dimension: usize,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        let density = pd_core::Error::positive("density ρ [kg/m³]", density)?;
        Ok(Self { kappa, alpha, dimension, density, influence: Arc::new(influence) })
    }
    /// Trace of the strain θ from a node's constants and state.
    pub fn dilatation<T: Real>(&self, inverse_m: T, state: T) -> T {
        state / inverse_m
    }
}

/// Constants of a bond of [`LinearSolid`].
#[derive(Debug, Clone, Copy)]
pub struct LinearBond<T> {
    /// ω|ξ|.
    sum: T,
    /// (Dκ − α/D) ω|ξ|, which the dilatation multiplies.
    volumetric: T,
    /// α ω, which the extension multiplies.
    deviatoric: T,
}

impl<T: Real, const D: usize> ScalarState<T, D> for LinearSolid {
    type BondConst = LinearBond<T>;
    /// 1/m.
    type NodeConst = T;
    type FamilyConst = ();
    /// Σ ω|ξ| e βV.
    type FamilySum = T;
    /// θ/m.
    type NodeState = T;

    fn density(&self, _: usize) -> f64 {
        self.density
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> LinearBond<T> {
        let omega = self.influence.weight(xi.norm() / scale.horizon);
        let sum = omega * xi.norm();
        LinearBond {
            sum: T::of(sum),
            volumetric: T::of((D as f64 * self.kappa - self.alpha / D as f64) * sum),
            deviatoric: T::of(self.alpha * omega),
        }
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, (BondLength<T>, LinearBond<T>), D>,
    ) -> CoreResult<(T, ())> {
        let m = family.sum(|m| m.bond.1.sum.to_f64() * m.xi.norm());
        weighted_volume(m, family.node, self.dimension == D).map(|m| (T::of(1.0 / m), ()))
    }
    #[inline(always)]
    fn add(&self, sum: &mut T, bond: &Bond<T, D>, e: T, k: &LinearBond<T>, volume: T) {
        *sum = bond.fma(e, k.sum * volume, *sum);
    }
    #[inline(always)]
    fn close(&self, sum: &T, inverse_m: &T, (): &()) -> T {
        T::of(D as f64) * *inverse_m * *inverse_m * *sum
    }
    #[inline(always)]
    fn line(
        &self,
        _: &Bond<T, D>,
        weight: T,
        k: &LinearBond<T>,
        inverse_m: &T,
        state: &T,
    ) -> (Option<T>, T) {
        (Some(*state * (k.volumetric * weight)), *inverse_m * (k.deviatoric * weight))
    }
}

/// m, if it is positive and the model was made for the body's dimension.
pub(crate) fn weighted_volume(m: f64, node: usize, fits: bool) -> CoreResult<f64> {
    pd_core::Error::check(
        fits,
        "dimension of the material",
        if fits { 0.0 } else { 1.0 },
        "that of the body: `solid` is for 3D, `plane` for 2D",
    )?;
    if m > 0.0 {
        Ok(m)
    } else {
        Err(pd_core::Error::SingularShapeTensor {
            node,
            condition: f64::INFINITY,
            limit: f64::INFINITY,
            neighbours: 0,
        })
    }
}

/// The Madenci–Oterkus form used by Zhao Eq. 4, with Λ = 1 (Λ as printed is not objective, errata
/// 001-3): W = a θ² + b Σ (δ/|ξ|) e² βV, θ = d δ Σ (e/|ξ|) βV, t = 2δ(a d θ + b e)/|ξ|.
///
/// Not an LPS with one influence function: its dilatation weighs e/|ξ|, its energy e²/|ξ|
/// (errata 001-4). Use it as `Ordinary::new(MadenciOterkus::…)`.
#[derive(Debug, Clone)]
pub struct MadenciOterkus {
    kappa: f64,
    shear: f64,
    dimension: usize,
    density: f64,
}

impl MadenciOterkus {
    /// A solid (3D): a = ½(K − 5G/3), b = 15G/(2πδ⁵), d = 9/(4πδ⁴).
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn solid(moduli: &Isotropic, density: f64) -> Result<Self> {
        let density = pd_core::Error::positive("density ρ [kg/m³]", density)?;
        Ok(Self { kappa: moduli.bulk(), shear: moduli.shear(), dimension: 3, density })
    }
    /// A plate: a = ½(κ − 2G), b = 6G/(πhδ⁴), d = 2/(πhδ³).
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn plane(moduli: &Isotropic, mode: PlaneMode, density: f64) -> Result<Self> {
        let density = pd_core::Error::positive("density ρ [kg/m³]", density)?;
        Ok(Self { kappa: moduli.plane_bulk(mode), shear: moduli.shear(), dimension: 2, density })
    }
    /// a in Pa.
    #[inline(always)]
    fn a(&self) -> f64 {
        0.5 * (self.kappa - if self.dimension == 3 { 5.0 / 3.0 } else { 2.0 } * self.shear)
    }
    /// (b, d) for a horizon δ.
    fn b_and_d(&self, delta: f64) -> (f64, f64) {
        let g = self.shear;
        if self.dimension == 3 {
            (15.0 * g / (2.0 * PI * delta.powi(5)), 9.0 / (4.0 * PI * delta.powi(4)))
        } else {
            (6.0 * g / (PI * delta.powi(4)), 2.0 / (PI * delta.powi(3)))
        }
    }
}

impl<T: Real, const D: usize> ScalarState<T, D> for MadenciOterkus {
    /// (d δ/|ξ|, 2 b δ/|ξ|).
    type BondConst = (T, T);
    type NodeConst = ();
    type FamilyConst = ();
    /// θ.
    type FamilySum = T;
    /// 2aθ.
    type NodeState = T;

    fn density(&self, _: usize) -> f64 {
        self.density
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> (T, T) {
        let (b, d) = self.b_and_d(scale.horizon);
        let r = scale.horizon / xi.norm();
        (T::of(d * r), T::of(2.0 * b * r))
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, (BondLength<T>, (T, T)), D>,
    ) -> CoreResult<((), ())> {
        weighted_volume(1.0, family.node, self.dimension == D).map(|_| ((), ()))
    }
    #[inline(always)]
    fn add(&self, sum: &mut T, bond: &Bond<T, D>, e: T, k: &(T, T), volume: T) {
        *sum = bond.fma(e, k.0 * volume, *sum);
    }
    #[inline(always)]
    fn close(&self, sum: &T, (): &(), (): &()) -> T {
        T::of(2.0 * self.a()) * *sum
    }
    #[inline(always)]
    fn line(&self, _: &Bond<T, D>, weight: T, k: &(T, T), (): &(), state: &T) -> (Option<T>, T) {
        (Some(k.0 * weight * *state), k.1 * weight)
    }
}
