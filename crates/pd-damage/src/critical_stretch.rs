//! Critical stretch: a bond breaks when s = e/|ξ| exceeds s_c.

use pd_core::damage::{DamageCriterion, TestedBond};
use pd_core::{Error, Material, Real, Result};
use std::f64::consts::PI;

/// Critical stretch s_c, for any material.
///
/// With λ = 1 + s the failure index is (λ² − 1)/(λ_c² − 1): it is 1 exactly where s = s_c, close
/// to s/s_c for small stretches, and needs no square root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticalStretch {
    stretch: f64,
}

impl CriticalStretch {
    /// With this s_c.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn new(stretch: f64) -> Result<Self> {
        Ok(Self { stretch: Error::positive("critical stretch s_c", stretch)? })
    }
    fn from_square(square: f64, fracture_energy: f64, horizon: f64) -> Result<Self> {
        Error::positive("fracture energy G₀ [N/m]", fracture_energy)?;
        Error::positive("horizon δ [m]", horizon)?;
        Self::new(square.sqrt())
    }
    /// PMB (ω = 1) in 3D: s_c² = 5G₀/(9Kδ), bulk modulus K in Pa.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for values that are not positive.
    pub fn pmb_solid(fracture_energy: f64, bulk: f64, horizon: f64) -> Result<Self> {
        let square = 5.0 * fracture_energy / (9.0 * bulk * horizon);
        Self::from_square(square, fracture_energy, horizon)
    }
    /// PMB (ω = 1) in plane stress: s_c² = 4πG₀/(9Eδ), Young's modulus E in Pa.
    ///
    /// # Errors
    /// As [`pmb_solid`](Self::pmb_solid).
    pub fn pmb_plane_stress(fracture_energy: f64, young: f64, horizon: f64) -> Result<Self> {
        let square = 4.0 * PI * fracture_energy / (9.0 * young * horizon);
        Self::from_square(square, fracture_energy, horizon)
    }
    /// PMB (ω = 1) in plane strain: s_c² = 5πG₀/(12Eδ), Young's modulus E in Pa.
    ///
    /// # Errors
    /// As [`pmb_solid`](Self::pmb_solid).
    pub fn pmb_plane_strain(fracture_energy: f64, young: f64, horizon: f64) -> Result<Self> {
        let square = 5.0 * PI * fracture_energy / (12.0 * young * horizon);
        Self::from_square(square, fracture_energy, horizon)
    }
    /// Linear solid in 3D (Willberg Eq. 5-4): s_c² = G₀/((3G + (3/4)⁴(K − 5G/3))δ).
    ///
    /// # Errors
    /// As [`pmb_solid`](Self::pmb_solid).
    pub fn lps_solid(fracture_energy: f64, bulk: f64, shear: f64, horizon: f64) -> Result<Self> {
        let stiffness = 3.0 * shear + 0.75_f64.powi(4) * (bulk - 5.0 * shear / 3.0);
        Self::from_square(fracture_energy / (stiffness * horizon), fracture_energy, horizon)
    }
    /// Linear solid in 2D (errata 002-18): s_c² = G₀/((6G/π + 16(κ − 2G)/(9π²))δ), bulk modulus κ of
    /// the plane.
    ///
    /// # Errors
    /// As [`pmb_solid`](Self::pmb_solid).
    pub fn lps_plane(fracture_energy: f64, bulk: f64, shear: f64, horizon: f64) -> Result<Self> {
        let stiffness = 6.0 * shear / PI + 16.0 / (9.0 * PI * PI) * (bulk - 2.0 * shear);
        Self::from_square(fracture_energy / (stiffness * horizon), fracture_energy, horizon)
    }
    /// 1/(λ_c² − 1).
    #[inline(always)]
    fn per_t<T: Real>(&self) -> T {
        T::of(1.0 / (self.stretch * (2.0 + self.stretch)))
    }
    /// s_c.
    pub fn stretch(&self) -> f64 {
        self.stretch
    }
}

impl<T: Real, const D: usize, M: Material<T, D>> DamageCriterion<T, D, M> for CriticalStretch {
    type NodeConst = ();
    type NodeValue = ();

    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, (), ()>) -> T {
        tested.bond.square_strain() * self.per_t()
    }
    fn per_square_strain(&self) -> Option<T> {
        Some(self.per_t())
    }
}
