//! Bond-associated correspondence: every bond has a displacement gradient of its own.

use crate::Result;
use crate::elasticity::Stiffness;
use crate::elasticity::voigt::{small_strain, voigt_axes, voigt_components, voigt_index};
use nalgebra::{SMatrix, SVector};
use pd_core::bond::{Bond, End, Neighbourhood, Scale};
use pd_core::influence::Influence;
use pd_core::material::{Material, StrainEnergy, StressState};
use pd_core::shape::{ShapePolicy, shape_tensor};
use pd_core::{Real, Result as CoreResult};
use std::sync::Arc;

/// Bond-associated correspondence with any stiffness C, for small strains: the node's gradient H
/// is corrected along each bond by what it does not explain, z = η − Hξ, so that the bond's own
/// gradient H + z⊗n/|ξ| carries its two ends exactly where they are.
///
/// The energy is the mean of C over the bonds, weighted by ω|ξ|². As Σ ω z⊗ξ βV = 0 it falls into
/// two parts,
///
/// W = ½ H:C:H + (g/2m) Σ μ ω z·Q⟨n⟩z βV, Q_ik⟨n⟩ = C_ijkl n_j n_l, m = Σ μ ω|ξ|²βV,
///
/// the classical one and a control of zero-energy modes by the acoustic tensor Q of the bond's own
/// direction: stiff along the fibres and soft across them, where [`WanControl`] is equally stiff in
/// all directions and hinders the sliding along the fibres that a split is made of. Its force
/// state is
///
/// T = ω[(C:H − R) B ξ + (g/m) Q z], R = (g/m) Σ μ ω Q z⊗ξ βV.
///
/// [`WanControl`]: crate::correspondence::WanControl
#[derive(Clone)]
pub struct BondAssociated<const D: usize, const V: usize> {
    stiffness: Stiffness<D>,
    strength: f64,
    density: f64,
    influence: Arc<dyn Influence>,
    shape: ShapePolicy,
}

impl<const D: usize, const V: usize> BondAssociated<D, V> {
    /// With the strength g = 1: every bond has the whole stiffness of its own gradient.
    /// V = D(D + 1)/2.
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn new(
        stiffness: &Stiffness<D>,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        const { assert!(V == voigt_components(D), "V must be 3 in 2D and 6 in 3D") };
        let density = pd_core::Error::positive("density ρ [kg/m³]", density)?;
        let (influence, shape) = (Arc::new(influence), ShapePolicy::default());
        Ok(Self { stiffness: *stiffness, strength: 1.0, density, influence, shape })
    }
    /// With another strength g of the bonds' own part; 0 is [`Correspondence`] without control.
    ///
    /// # Errors
    /// A strength that is negative.
    ///
    /// [`Correspondence`]: crate::Correspondence
    pub fn with_strength(mut self, g: f64) -> Result<Self> {
        self.strength = crate::correspondence::checked_strength(g)?;
        Ok(self)
    }
    /// With a policy for singular shape tensors.
    pub fn with_shape_policy(mut self, shape: ShapePolicy) -> Self {
        self.shape = shape;
        self
    }
}

/// Constants of a bond of [`BondAssociated`].
#[derive(Debug, Clone, Copy)]
pub struct AssociatedBond<T, const D: usize> {
    omega: T,
    /// g ω Q⟨n⟩.
    acoustic: SMatrix<T, D, D>,
}

impl<T: Real, const D: usize, const V: usize> Material<T, D> for BondAssociated<D, V> {
    type BondConst = AssociatedBond<T, D>;
    /// 1/m.
    type NodeConst = T;
    /// B, and g Σ ω Q_ik ξ_a ξ_b βV by the pairs (ik), (ab).
    type FamilyConst = (SMatrix<T, D, D>, SMatrix<T, V, V>);
    /// Σ ω η⊗ξ βV and g Σ ω Q η⊗ξ βV.
    type FamilySum = (SMatrix<T, D, D>, SMatrix<T, D, D>);
    /// (C:H − R) B and H.
    type NodeState = (SMatrix<T, D, D>, SMatrix<T, D, D>);
    const FOLLOWS_DAMAGE: bool = true;
    const LINEAR: bool = true;
    const STRETCH: bool = false;

    fn density(&self, _: usize) -> f64 {
        self.density
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::BondConst {
        let (n, omega) = (xi.normalize(), self.influence.weight(xi.norm() / scale.horizon));
        let acoustic = self.stiffness.acoustic(&n) * (self.strength * omega);
        AssociatedBond { omega: T::of(omega), acoustic: acoustic.map(T::of) }
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, Self::BondConst, D>,
    ) -> CoreResult<(T, Self::FamilyConst)> {
        let k = shape_tensor(family, |bond| bond.omega.to_f64());
        let weighted = family.members.iter().filter(|m| m.bond.omega > T::zero()).count();
        let b = self.shape.invert(&k, family.node, weighted)?;
        let mut moment = SMatrix::<f64, V, V>::zeros();
        for member in family.members {
            let q = member.bond.acoustic.map(Real::to_f64);
            moment += SMatrix::<f64, V, V>::from_fn(|r, s| {
                let ((i, k), (a, c)) = (voigt_axes(D, r), voigt_axes(D, s));
                q[(i, k)] * member.xi[a] * member.xi[c] * member.volume
            });
        }
        let detached = b.iter().all(|&x| x == 0.0);
        let inverse_m = if detached { 0.0 } else { 1.0 / k.trace() };
        Ok((T::of(inverse_m), (b.map(T::of), moment.map(T::of))))
    }
    #[inline(always)]
    fn add_bond(
        &self,
        sum: &mut Self::FamilySum,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, T, ()>,
    ) {
        let weighted = bond.xi.transpose() * end.volume;
        sum.0 += bond.eta * end.bond.omega * weighted;
        sum.1 += end.bond.acoustic * bond.eta * weighted;
    }
    #[inline(always)]
    fn node_state(
        &self,
        sum: &Self::FamilySum,
        inverse_m: &T,
        (b, moment): &Self::FamilyConst,
        _: &Self::NodeState,
    ) -> Self::NodeState {
        let h = sum.0 * b;
        let explained = SMatrix::<T, D, D>::from_fn(|i, a| {
            let mut value = T::zero();
            for k in 0..D {
                for c in 0..D {
                    value += moment[(voigt_index(D, i, k), voigt_index(D, a, c))] * h[(k, c)];
                }
            }
            value
        });
        let r = (sum.1 - explained) * *inverse_m;
        ((self.stiffness.contract(&small_strain(&h)) - r) * b, h)
    }
    #[inline(always)]
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, T, Self::NodeState>,
    ) -> SVector<T, D> {
        let (a, h) = end.state;
        let z = bond.eta - h * bond.xi;
        a * bond.xi * end.bond.omega + end.bond.acoustic * z * *end.node
    }
    #[inline(always)]
    fn detached(&self, (b, _): &Self::FamilyConst) -> bool {
        b.trace() == T::zero()
    }
}

impl<T: Real, const D: usize, const V: usize> StressState<T, D> for BondAssociated<D, V> {
    #[inline(always)]
    fn stress(&self, _: &T, (_, h): &Self::NodeState) -> SMatrix<T, D, D> {
        self.stiffness.contract(&small_strain(h))
    }
    /// σ of the bond's own gradient, C:(H + z⊗n/|ξ|).
    #[inline(always)]
    fn bond_stress(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, T, Self::NodeState>,
        stress: &SMatrix<T, D, D>,
    ) -> SMatrix<T, D, D> {
        let z = bond.eta - end.state.1 * bond.xi;
        let own = z * (bond.xi.transpose() / bond.xi.dot(&bond.xi));
        stress + self.stiffness.contract(&small_strain(&own))
    }
}

impl<T: Real, const D: usize, const V: usize> StrainEnergy<T, D> for BondAssociated<D, V> {
    #[inline(always)]
    fn node_energy(&self, constants: &T, state: &Self::NodeState) -> T {
        self.stress(constants, state).component_mul(&state.1).sum() * T::of(0.5)
    }
    #[inline(always)]
    fn bond_energy(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, T, Self::NodeState>,
    ) -> T {
        let z = bond.eta - end.state.1 * bond.xi;
        T::of(0.5) * *end.node * (end.bond.acoustic * z).dot(&z)
    }
}
