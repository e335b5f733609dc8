//! Criteria on the energy of a bond: Foster's, and Willberg's that tell modes apart.

use crate::calibration::{CrackPlane, FractureEnergy};
use pd_core::bond::Scale;
use pd_core::damage::{DamageCriterion, TestedBond};
use pd_core::influence::Influence;
use pd_core::{EnergySplit, Error, Material, Real, Result};

/// Which bonds count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Sign {
    #[default]
    Both,
    Tension,
}

/// One critical energy for bonds of every length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Uniform;

impl Influence for Uniform {
    #[inline(always)]
    fn weight(&self, _: f64) -> f64 {
        1.0
    }
}

/// A criterion on the energy of a bond whose critical energies can be scaled.
pub trait EnergyCriterion<T: Real, const D: usize, M: Material<T, D>>: Send + Sync + Sized {
    /// Critical energy of a bond of length `ratio` · δ over that of the criterion itself.
    fn shape(&self, ratio: f64) -> f64 {
        let _ = ratio;
        1.0
    }
    /// Failure index with the critical energies times `share`.
    fn index_at(&self, tested: &TestedBond<'_, T, D, M, (), ()>, share: T) -> T;
}

/// Critical energies of a body whose horizon varies by node, see [`BondEnergy::at_horizon`].
///
/// A crack costs G_c ∝ w_C δ^(D+1), so w_C (δ/δ_i)^(D+1) costs the same at every node whose family
/// looks alike in units of δ_i. Of a bond each end that has it in its family carries half the energy
/// and half the critical energy: a bond of both breaks at their mean, one that a single end has at
/// half of that end's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalEnergy<C> {
    criterion: C,
    horizon: f64,
}

impl<C> LocalEnergy<C> {
    fn new(criterion: C, horizon: f64) -> Result<Self> {
        let horizon = Error::positive("horizon δ of the critical bond energy [m]", horizon)?;
        Ok(Self { criterion, horizon })
    }
}

impl<T, const D: usize, M, C> DamageCriterion<T, D, M> for LocalEnergy<C>
where
    T: Real,
    M: Material<T, D>,
    C: EnergyCriterion<T, D, M>,
{
    /// δ_i in units of Δx and (δ/δ_i)^(D+1).
    type NodeConst = (T, T);
    type NodeValue = ();

    fn node_const(&self, _: usize, scale: Scale) -> (T, T) {
        let size = (self.horizon / (scale.horizon * scale.unit)).powi(D as i32 + 1);
        (T::of(scale.horizon), T::of(size))
    }
    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, (T, T), ()>) -> T {
        let length = tested.bond.xi.norm();
        let share = |(horizon, size): (T, T)| {
            size * T::of(self.criterion.shape((length / horizon).to_f64()))
        };
        let ([near, far], [a, b]) = (tested.ends, tested.constants);
        let share = (near.volume * share(*a) + far.volume * share(*b)) * T::of(0.5);
        self.criterion.index_at(&tested.with_constants([&(), &()]), share)
    }
}

/// Foster's critical bond energy, for any material: a bond breaks when w = ½(|t| + |t'|)|e|
/// exceeds w_C (Willberg 3-1, 4-2; errata 002-7, 002-8).
///
/// w_C = 4G₀/(πδ⁴) in 3D and 3G₀/(2hδ³) in 2D, the same for all bonds, or ω⟨ξ⟩ w₀.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondEnergy<W = Uniform> {
    /// w₀ in Pa/m^D.
    critical: f64,
    weight: W,
    horizon: f64,
    factor: f64,
    sign: Sign,
}

impl BondEnergy {
    /// The same w_C for all bonds, at which a crack costs G_c.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a crack that no bond crosses.
    pub fn from_energy<const D: usize>(
        energy: FractureEnergy,
        plane: &CrackPlane<D>,
    ) -> Result<Self> {
        Self::weighted(energy, plane, Uniform)
    }
    /// With this w_C in Pa/m^D (J/m⁶ in 3D; in 2D J/m⁶ times the thickness), the same for all
    /// bonds.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn new(critical: f64) -> Result<Self> {
        let critical = Error::positive("critical bond energy w_C [Pa/m^D]", critical)?;
        Ok(Self { critical, weight: Uniform, horizon: 1.0, factor: 1.0, sign: Sign::Both })
    }
}

impl<W: Influence> BondEnergy<W> {
    /// w_C = ω⟨ξ⟩ w₀ with any influence function, at which a crack costs G_c.
    ///
    /// # Errors
    /// As [`from_energy`](BondEnergy::from_energy).
    pub fn weighted<const D: usize>(
        energy: FractureEnergy,
        plane: &CrackPlane<D>,
        weight: W,
    ) -> Result<Self> {
        let horizon = plane.horizon();
        let critical = critical_energy(energy, plane, |length| weight.weight(length / horizon))?;
        Ok(Self { critical, weight, horizon, factor: 1.0, sign: Sign::Both })
    }
    /// Bonds in compression do not break.
    pub fn tension_only(mut self) -> Self {
        self.sign = Sign::Tension;
        self
    }
    /// w = ¼(|t| + |t'|)|e| as Willberg prints it (4-2), to repeat the paper's numbers: bonds break
    /// at twice the energy and a crack costs 2G_c.
    pub fn with_printed_quarter(mut self) -> Self {
        self.factor = 0.5;
        self
    }
    /// These critical energies where the horizon is `horizon` in metres, and elsewhere those of the
    /// same fracture energy: for bodies with one horizon per node.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn at_horizon(self, horizon: f64) -> Result<LocalEnergy<Self>> {
        LocalEnergy::new(self, horizon)
    }
    /// w₀ in Pa/m^D.
    pub fn critical(&self) -> f64 {
        self.critical
    }
}

/// w₀ = G_c / Σ_{ξ·n>0} shape(|ξ|)(ξ·n)βV.
fn critical_energy<const D: usize>(
    energy: FractureEnergy,
    plane: &CrackPlane<D>,
    shape: impl Fn(f64) -> f64,
) -> Result<f64> {
    let sum = Error::positive("sum over the bonds that cross a crack", plane.crossing(shape))?;
    Ok(energy.value() / sum)
}

/// Δx^D in m^D, for energies in Pa/m^D.
#[inline(always)]
fn cell<const D: usize>(unit: f64) -> f64 {
    unit.powi(D as i32)
}

/// 0 for a bond in compression, if only tension counts.
#[inline(always)]
fn in_tension<T: Real, const D: usize, M: Material<T, D>>(
    tested: &TestedBond<'_, T, D, M, (), ()>,
) -> bool {
    // e > 0 exactly where |Y|² > |ξ|².
    let (xi, eta) = (tested.bond.xi, tested.bond.eta);
    eta.dot(&(xi + xi + eta)) > T::zero()
}

impl<T, const D: usize, M, W> DamageCriterion<T, D, M> for BondEnergy<W>
where
    T: Real,
    M: Material<T, D>,
    W: Influence,
{
    type NodeConst = ();
    type NodeValue = ();

    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, (), ()>) -> T {
        let xi = tested.bond.xi;
        let length = xi.dot(&xi).sqrt().to_f64() * tested.unit;
        self.index_at(tested, T::of(self.weight.weight(length / self.horizon)))
    }
}

impl<T, const D: usize, M, W> EnergyCriterion<T, D, M> for BondEnergy<W>
where
    T: Real,
    M: Material<T, D>,
    W: Influence,
{
    #[inline(always)]
    fn shape(&self, ratio: f64) -> f64 {
        self.weight.weight(ratio)
    }
    #[inline(always)]
    fn index_at(&self, tested: &TestedBond<'_, T, D, M, (), ()>, share: T) -> T {
        let critical = share * T::of(self.critical * cell::<D>(tested.unit) / self.factor);
        let counts = self.sign == Sign::Both || in_tension(tested);
        if counts { tested.energy() / critical } else { T::zero() }
    }
}

/// Critical energies by mode, in Pa/m^D: of volume change in tension and in compression, and of
/// shear. Without a compressive value compression does not break.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeEnergies {
    tension: f64,
    compression: Option<f64>,
    shear: f64,
    factor: f64,
}

impl ModeEnergies {
    /// With these critical energies in Pa/m^D.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn new(tension: f64, compression: Option<f64>, shear: f64) -> Result<Self> {
        let what = "critical bond energy w_C of a mode [Pa/m^D]";
        Ok(Self {
            tension: Error::positive(what, tension)?,
            compression: compression.map(|w| Error::positive(what, w)).transpose()?,
            shear: Error::positive(what, shear)?,
            factor: 1.0,
        })
    }
    /// The w_C at which a crack of each mode costs its fracture energy: G_IC for tension, G_IIC for
    /// shear (errata 002-15).
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a crack that no bond crosses.
    pub fn from_energies<const D: usize>(
        tension: FractureEnergy,
        compression: Option<FractureEnergy>,
        shear: FractureEnergy,
        plane: &CrackPlane<D>,
    ) -> Result<Self> {
        let critical = |energy| critical_energy(energy, plane, |_| 1.0);
        Self::new(critical(tension)?, compression.map(critical).transpose()?, critical(shear)?)
    }
    /// Energies with ¼ in place of ½, as printed (4-3, 4-4; errata 002-8).
    pub fn with_printed_quarter(mut self) -> Self {
        self.factor = 0.5;
        self
    }
    /// (w_iso/w_C of the bond's sign, w_shr/w_C) with the w_C times `share`.
    #[inline(always)]
    fn ratios<T, const D: usize, M>(
        &self,
        tested: &TestedBond<'_, T, D, M, (), ()>,
        share: T,
    ) -> (T, T)
    where
        T: Real,
        M: EnergySplit<T, D>,
    {
        let (iso, shear) = tested.energy_parts();
        let scale = self.factor / cell::<D>(tested.unit);
        let compression = self.compression.map_or(0.0, f64::recip);
        let mode = if in_tension(tested) {
            T::of(scale / self.tension)
        } else {
            T::of(scale * compression)
        };
        (iso * mode / share, shear * T::of(scale / self.shear) / share)
    }
}

/// Willberg's power law: a bond breaks when (w_ten/w_C)² + (w_cmp/w_C)² + (w_shr/w_C)² exceeds 1
/// (Table 1, errata 002-13).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLaw {
    modes: ModeEnergies,
    as_printed: bool,
}

impl PowerLaw {
    /// With these critical energies.
    pub fn new(modes: ModeEnergies) -> Self {
        Self { modes, as_printed: false }
    }
    /// Table 1 as printed: the sum of squares against the sum of the critical squares, so that a
    /// single mode breaks far above its own critical value.
    pub fn as_printed(modes: ModeEnergies) -> Self {
        Self { modes, as_printed: true }
    }
    /// These critical energies where the horizon is `horizon` in metres, and elsewhere those of the
    /// same fracture energies: for bodies with one horizon per node.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn at_horizon(self, horizon: f64) -> Result<LocalEnergy<Self>> {
        LocalEnergy::new(self, horizon)
    }
}

impl<T, const D: usize, M> DamageCriterion<T, D, M> for PowerLaw
where
    T: Real,
    M: EnergySplit<T, D>,
{
    type NodeConst = ();
    type NodeValue = ();

    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, (), ()>) -> T {
        self.index_at(tested, T::one())
    }
}

impl<T: Real, const D: usize, M: EnergySplit<T, D>> EnergyCriterion<T, D, M> for PowerLaw {
    #[inline(always)]
    fn index_at(&self, tested: &TestedBond<'_, T, D, M, (), ()>, share: T) -> T {
        let ModeEnergies { tension, compression, shear, .. } = self.modes;
        let (iso, shr) = self.modes.ratios(tested, share);
        if !self.as_printed {
            return iso * iso + shr * shr;
        }
        let compressive = compression.unwrap_or(0.0);
        let own = if in_tension(tested) { tension } else { compressive };
        let sum = tension * tension + compressive * compressive + shear * shear;
        iso * iso * T::of(own * own / sum) + shr * shr * T::of(shear * shear / sum)
    }
}

/// Willberg's separated criterion: a bond breaks when its volumetric energy in tension, or in
/// compression, **or** its shear energy exceeds its own critical value (Table 1 prints "and", which
/// can never hold; errata 002-14).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separated {
    modes: ModeEnergies,
}

impl Separated {
    /// With these critical energies.
    pub fn new(modes: ModeEnergies) -> Self {
        Self { modes }
    }
    /// These critical energies where the horizon is `horizon` in metres, and elsewhere those of the
    /// same fracture energies: for bodies with one horizon per node.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn at_horizon(self, horizon: f64) -> Result<LocalEnergy<Self>> {
        LocalEnergy::new(self, horizon)
    }
}

impl<T, const D: usize, M> DamageCriterion<T, D, M> for Separated
where
    T: Real,
    M: EnergySplit<T, D>,
{
    type NodeConst = ();
    type NodeValue = ();

    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, (), ()>) -> T {
        self.index_at(tested, T::one())
    }
}

impl<T: Real, const D: usize, M: EnergySplit<T, D>> EnergyCriterion<T, D, M> for Separated {
    #[inline(always)]
    fn index_at(&self, tested: &TestedBond<'_, T, D, M, (), ()>, share: T) -> T {
        let (iso, shear) = self.modes.ratios(tested, share);
        iso.max(shear)
    }
}
