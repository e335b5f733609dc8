//! Critical stretch: a bond breaks when s = e/|ξ| exceeds s_c.

use crate::calibration::{BondModel, BondStrength, CrackPlane, FractureEnergy, critical_size};
use pd_core::bond::Scale;
use pd_core::damage::{DamageCriterion, TestedBond};
use pd_core::{Error, Material, Real, Result};
use std::f64::consts::PI;

/// Critical stretch s_c, for any material. Only tension breaks.
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
    /// The s_c at which a crack costs G_c. In the continuum with ω = 1 the classical values: PMB
    /// s_c² = 5G₀/(9Kδ) in 3D, 4πG₀/(9Eδ) in plane stress, 5πG₀/(12Eδ) in plane strain.
    ///
    /// ```
    /// use pd_core::InfluenceFunction;
    /// use pd_damage::{BondModel, CrackPlane, CriticalStretch, FractureEnergy};
    /// let (bulk, horizon, g) = (40e9, 3e-3, 100.0);
    /// let stretch = CriticalStretch::from_energy(
    ///     FractureEnergy::new(g)?,
    ///     &BondModel::pmb(bulk, InfluenceFunction::Constant)?,
    ///     &CrackPlane::<3>::continuum(horizon)?,
    /// )?;
    /// let square: f64 = 5.0 * g / (9.0 * bulk * horizon);
    /// assert!((stretch.stretch() / square.sqrt() - 1.0).abs() < 1e-12);
    /// # Ok::<(), pd_core::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a model whose crack costs nothing.
    pub fn from_energy<const D: usize>(
        energy: FractureEnergy,
        model: &BondModel,
        plane: &CrackPlane<D>,
    ) -> Result<Self> {
        Self::new(critical_size(energy, model, plane, |length| length)?)
    }
    /// s_c = σ_c/E.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless Young's modulus in Pa is positive.
    pub fn from_strength(strength: BondStrength, young: f64) -> Result<Self> {
        Self::new(strength.stretch(young)?)
    }
    /// Willberg Eq. 5-4, 3D, as printed: s_c² = G₀/((3G + (3/4)⁴(K − 5G/3))δ), of the
    /// Madenci–Oterkus form with the square of the mean dilatation in place of the mean square
    /// (errata 002-18; exact for ν = ¼).
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for values that are not positive.
    pub fn willberg_solid(
        energy: FractureEnergy,
        bulk: f64,
        shear: f64,
        horizon: f64,
    ) -> Result<Self> {
        let stiffness = 3.0 * shear + 0.75_f64.powi(4) * (bulk - 5.0 * shear / 3.0);
        Self::from_stiffness(energy, stiffness, horizon)
    }
    /// The same in 2D (errata 002-18): s_c² = G₀/((6G/π + 16(κ − 2G)/(9π²))δ), bulk modulus κ of
    /// the plane.
    ///
    /// # Errors
    /// As [`willberg_solid`](Self::willberg_solid).
    pub fn willberg_plane(
        energy: FractureEnergy,
        bulk: f64,
        shear: f64,
        horizon: f64,
    ) -> Result<Self> {
        let stiffness = 6.0 * shear / PI + 16.0 / (9.0 * PI * PI) * (bulk - 2.0 * shear);
        Self::from_stiffness(energy, stiffness, horizon)
    }
    fn from_stiffness(energy: FractureEnergy, stiffness: f64, horizon: f64) -> Result<Self> {
        Error::positive("horizon δ [m]", horizon)?;
        Error::positive("stiffness of crossing bonds [Pa]", stiffness)?;
        Self::new((energy.value() / (stiffness * horizon)).sqrt())
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
    /// This s_c where the horizon is `horizon` in metres, and elsewhere the one of the same fracture
    /// energy: for bodies with one horizon per node.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn at_horizon(self, horizon: f64) -> Result<LocalStretch> {
        let horizon = Error::positive("horizon δ of the critical stretch [m]", horizon)?;
        Ok(LocalStretch { stretch: self.stretch, horizon })
    }
}

/// Critical stretch of a body whose horizon varies by node, see [`CriticalStretch::at_horizon`].
///
/// A crack costs G_c ∝ s_c²δ whatever the material, so s_i = s_c √(δ/δ_i) costs the same at every
/// node whose family looks alike in units of δ_i. A bond that both ends have in their family carries
/// the energy of both and breaks at the mean of their t_c = (1 + s_i)² − 1; one that a single end
/// has in its family breaks at that end's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalStretch {
    stretch: f64,
    horizon: f64,
}

impl LocalStretch {
    /// s_i of a node with this horizon in metres.
    pub fn stretch(&self, horizon: f64) -> f64 {
        self.stretch * (self.horizon / horizon).sqrt()
    }
}

impl<T: Real, const D: usize, M: Material<T, D>> DamageCriterion<T, D, M> for LocalStretch {
    /// t_c.
    type NodeConst = T;
    type NodeValue = ();

    fn node_const(&self, _: usize, scale: Scale) -> T {
        let stretch = self.stretch(scale.horizon * scale.unit);
        T::of(stretch * (2.0 + stretch))
    }
    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, T, ()>) -> T {
        let ([near, far], [a, b]) = (tested.ends, tested.constants);
        let critical = near.volume * *a + far.volume * *b;
        tested.bond.square_strain() * (near.volume + far.volume) / critical
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
