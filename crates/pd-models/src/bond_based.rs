//! Bond-based materials: a bond's force depends on that bond only; no node carries anything.

use crate::elasticity::{Isotropic, PlaneMode};
use crate::kinematics::BondLength;
use crate::ordinary::ScalarState;
use crate::{Error, Result};
use nalgebra::SVector;
use pd_core::bond::{Bond, End, Neighbourhood, Scale};
use pd_core::influence::{Influence, moment};
use pd_core::material::Material;
use pd_core::{Real, Result as CoreResult};
use std::f64::consts::PI;
use std::sync::Arc;

/// Prototype microelastic brittle material (PMB): T = ½ c ω s M with the stretch s = e/|ξ|.
///
/// For any influence function the micromodulus c matches the energy of a dilation,
/// c = 2D²κ / ∫ω|ξ|dV: with ω = 1, 18K/(πδ⁴) in 3D, 9E/(πhδ³) in plane stress and 48E/(5πhδ³)
/// in plane strain. Use it as `Ordinary::new(Pmb::…)`.
#[derive(Clone)]
pub struct Pmb {
    /// 2D²κ in Pa.
    modulus: f64,
    density: f64,
    dimension: usize,
    influence: Arc<dyn Influence>,
}

impl Pmb {
    /// A solid (3D); Poisson's ratio must be the model's own, 1/4.
    ///
    /// # Errors
    /// [`Error::PoissonRatio`], and a density that is not positive.
    pub fn solid(
        moduli: &Isotropic,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        Self::checked(moduli, 0.25, "3D", 18.0 * moduli.bulk(), 3, density, influence)
    }
    /// A plate; Poisson's ratio must be the model's own, 1/3 in plane stress and 1/4 in plane
    /// strain.
    ///
    /// # Errors
    /// [`Error::PoissonRatio`], and a density that is not positive.
    pub fn plane(
        moduli: &Isotropic,
        mode: PlaneMode,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        let (nu, what) = match mode {
            PlaneMode::PlaneStress => (1.0 / 3.0, "plane stress"),
            PlaneMode::PlaneStrain => (0.25, "plane strain"),
        };
        Self::checked(moduli, nu, what, 8.0 * moduli.plane_bulk(mode), 2, density, influence)
    }
    fn checked(
        moduli: &Isotropic,
        own: f64,
        mode: &'static str,
        modulus: f64,
        dimension: usize,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        let given = moduli.poisson();
        if (given - own).abs() > 1e-3 {
            return Err(Error::PoissonRatio { given, own, mode });
        }
        let density = pd_core::Error::positive("density ρ [kg/m³]", density)?;
        Ok(Self { modulus, density, dimension, influence: Arc::new(influence) })
    }
    /// Micromodulus c in Pa/m^(D+1) for a horizon in metres (per unit thickness in 2D).
    pub fn micromodulus(&self, horizon: f64) -> f64 {
        let sphere = if self.dimension == 3 { 4.0 * PI } else { 2.0 * PI };
        let d = self.dimension as i32;
        self.modulus / (sphere * horizon.powi(d + 1) * moment(&*self.influence, d))
    }
    /// The same material with c matched on every node's own discrete family: a dilation has the
    /// exact energy at every node, whatever the lattice and the surface.
    pub fn on_family(self) -> PmbOnFamily {
        PmbOnFamily(self)
    }
}

impl<T: Real, const D: usize> ScalarState<T, D> for Pmb {
    /// ½ c ω / |ξ|.
    type BondConst = T;
    type NodeConst = ();
    type FamilyConst = ();
    type FamilySum = ();
    type NodeState = ();

    fn density(&self, _: usize) -> f64 {
        self.density
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> T {
        let omega = self.influence.weight(xi.norm() / scale.horizon);
        T::of(0.5 * self.micromodulus(scale.horizon) * omega / xi.norm())
    }
    #[inline(always)]
    fn line(&self, _: &Bond<T, D>, weight: T, k: &T, (): &(), (): &()) -> (Option<T>, T) {
        (None, *k * weight)
    }
}

/// PMB with the micromodulus of each node's own family, c = 2D²κ / Σω|ξ|βV.
#[derive(Clone)]
pub struct PmbOnFamily(Pmb);

impl<T: Real, const D: usize> ScalarState<T, D> for PmbOnFamily {
    /// ω / |ξ|.
    type BondConst = T;
    /// ½ c.
    type NodeConst = T;
    type FamilyConst = ();
    type FamilySum = ();
    type NodeState = ();

    fn density(&self, _: usize) -> f64 {
        self.0.density
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> T {
        T::of(self.0.influence.weight(xi.norm() / scale.horizon) / xi.norm())
    }
    fn node_const(&self, family: &Neighbourhood<'_, (BondLength<T>, T), D>) -> CoreResult<(T, ())> {
        let sum = family.sum(|m| m.bond.1.to_f64() * m.xi.norm_squared());
        Ok((T::of(if sum > 0.0 { 0.5 * self.0.modulus / sum } else { 0.0 }), ()))
    }
    #[inline(always)]
    fn line(&self, _: &Bond<T, D>, weight: T, k: &T, half_c: &T, (): &()) -> (Option<T>, T) {
        (None, *half_c * (*k * weight))
    }
}

/// A bond law of your own: the force along the deformed bond.
///
/// ```
/// use pd_core::bond::{Bond, Scale};
/// use pd_models::bond_based::{BondBased, BondLaw};
/// use nalgebra::SVector;
///
/// /// A spring that hardens: t = c s (1 + b s²).
/// struct Hardening { c: f64, b: f64 }
/// impl<const D: usize> BondLaw<f64, D> for Hardening {
///     type Const = f64;
///     fn density(&self) -> f64 { 1000.0 }
///     fn bond_const(&self, xi: &SVector<f64, D>, _: Scale) -> f64 { xi.norm() }
///     fn force(&self, bond: &Bond<f64, D>, length: &f64) -> f64 {
///         let s = bond.extension(*length) / length;
///         self.c * s * (1.0 + self.b * s * s)
///     }
/// }
/// let material = BondBased(Hardening { c: 1e9, b: 10.0 });
/// # let _ = material;
/// ```
pub trait BondLaw<T: Real, const D: usize>: Send + Sync {
    /// Constants of a bond.
    type Const: Copy + Send + Sync;
    /// Mass density ρ in kg/m³.
    fn density(&self) -> f64;
    /// Constants of the bond ξ.
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::Const;
    /// Scalar force state t: half of the pair force density along the deformed bond, in
    /// Pa/Δx^(D+1).
    fn force(&self, bond: &Bond<T, D>, k: &Self::Const) -> T;
}

/// A material from a [`BondLaw`].
#[derive(Debug, Clone, Copy)]
pub struct BondBased<L>(pub L);

impl<T: Real, const D: usize, L: BondLaw<T, D>> Material<T, D> for BondBased<L> {
    type BondConst = L::Const;
    type NodeConst = ();
    type FamilyConst = ();
    type FamilySum = ();
    type NodeState = ();

    fn density(&self, _: usize) -> f64 {
        self.0.density()
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> L::Const {
        self.0.bond_const(xi, scale)
    }
    #[inline(always)]
    fn force_state(&self, bond: &Bond<T, D>, end: End<'_, T, L::Const, (), ()>) -> SVector<T, D> {
        let inverse = bond.stretch().inverse * bond.inverse_square().sqrt();
        bond.deformed() * (self.0.force(bond, end.bond) * inverse)
    }
    #[inline(always)]
    fn pair_force(
        &self,
        bond: &Bond<T, D>,
        ends: [End<'_, T, L::Const, (), ()>; 2],
    ) -> SVector<T, D> {
        // The force of a bond law sees no difference between the ends unless their horizons do.
        self.force_state(bond, ends[0]) * ends[0].volume
            + self.force_state(bond, ends[1]) * ends[1].volume
    }
}
