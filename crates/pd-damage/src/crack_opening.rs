//! Critical opening (PD-COD, Zhao Eqs. 20–21): a bond breaks when its extension reaches a length.

use crate::calibration::{BondModel, BondStrength, CrackPlane, FractureEnergy, critical_size};
use pd_core::damage::{DamageCriterion, TestedBond};
use pd_core::{Error, Material, Real, Result};
use std::f64::consts::PI;

/// Critical opening Δ_cr in metres, for any material: a bond breaks when e = |Y| − |ξ| exceeds it.
/// Only tension breaks.
///
/// Δ_cr is a length, so a uniform strain breaks the longest bonds first, and the strain at which
/// an uncracked body fails depends on the horizon: about Δ_cr/δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrackOpening {
    opening: f64,
}

impl CrackOpening {
    /// With this Δ_cr in metres.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn new(opening: f64) -> Result<Self> {
        Ok(Self { opening: Error::positive("critical opening Δ_cr [m]", opening)? })
    }
    /// The Δ_cr at which a crack costs G_c (errata 001-8): for PMB with ω = 1, Δ_cr² = G₀δ/(3K) in
    /// 3D and 2G₀/(hcδ²) in 2D.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a model whose crack costs nothing.
    pub fn from_energy<const D: usize>(
        energy: FractureEnergy,
        model: &BondModel,
        plane: &CrackPlane<D>,
    ) -> Result<Self> {
        Self::new(critical_size(energy, model, plane, |_| 1.0)?)
    }
    /// From a strength: Δ_cr = (σ_c/E)δ, at which the longest bonds along a uniaxial tension of
    /// σ_c break.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless Young's modulus in Pa and δ in metres are positive.
    pub fn from_strength(strength: BondStrength, young: f64, horizon: f64) -> Result<Self> {
        Self::new(strength.stretch(young)? * Error::positive("horizon δ [m]", horizon)?)
    }
    /// The opening at the tip of a crack of half length a under the stress σ in a sheet that yields
    /// at σ_Y (Bilby–Cottrell–Swinden, Dugdale), CTOD = 8σ_Y a/(πE) ln sec(πσ/(2σ_Y)), which the
    /// text of Zhao announces (errata 001-7). Lengths in metres, the rest in Pa.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for values that are not positive, or σ ≥ σ_Y.
    pub fn dugdale(stress: f64, half_crack: f64, young: f64, yield_stress: f64) -> Result<Self> {
        let sheet = Sheet::new(half_crack, young)?;
        let yielding = Error::positive("yield stress σ_Y [Pa]", yield_stress)?;
        let ok = stress > 0.0 && stress < yielding;
        let stress = Error::check(ok, "stress σ [Pa]", stress, "between 0 and the yield stress")?;
        let secant = (0.5 * PI * stress / yielding).cos().recip();
        Self::new(8.0 * yielding * sheet.half_crack / (PI * sheet.young) * secant.ln())
    }
    /// The opening at the centre of an elastic crack, (4a/E)√(σ² + τ²): Zhao Eq. 19 with opening
    /// and sliding combined as the orthogonal components they are (errata 001-6).
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for values that give no opening.
    pub fn at_centre(stress: f64, shear: f64, half_crack: f64, young: f64) -> Result<Self> {
        let sheet = Sheet::new(half_crack, young)?;
        Self::new(4.0 * sheet.half_crack / sheet.young * stress.hypot(shear))
    }
    /// Zhao Eq. 19 as printed, (4a/E)(σ + τ), to repeat the paper's numbers.
    ///
    /// # Errors
    /// As [`at_centre`](Self::at_centre).
    pub fn as_printed(stress: f64, shear: f64, half_crack: f64, young: f64) -> Result<Self> {
        let sheet = Sheet::new(half_crack, young)?;
        Self::new(4.0 * sheet.half_crack / sheet.young * (stress + shear))
    }
    /// Δ_cr in metres.
    pub fn opening(&self) -> f64 {
        self.opening
    }
}

struct Sheet {
    half_crack: f64,
    young: f64,
}

impl Sheet {
    fn new(half_crack: f64, young: f64) -> Result<Self> {
        Ok(Self {
            half_crack: Error::positive("half crack length a [m]", half_crack)?,
            young: Error::positive("Young's modulus E [Pa]", young)?,
        })
    }
}

impl<T: Real, const D: usize, M: Material<T, D>> DamageCriterion<T, D, M> for CrackOpening {
    type NodeConst = ();
    type NodeValue = ();

    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, (), ()>) -> T {
        tested.extension() * T::of(tested.unit / self.opening)
    }
}
