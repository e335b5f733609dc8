//! Ordinary materials: the force state lies along the deformed bond, T = t M.
//!
//! A model gives only its scalars, [`ScalarState`]; [`Ordinary`] adds the kinematics, the pair
//! force and the energy, which for models whose t is linear in the extensions of the family is
//! W = ½ Σ t e βV.

use crate::kinematics::{BondLength, Finite, Kinematics, Linearised};
use nalgebra::SVector;
use pd_core::bond::{Bond, End, Neighbourhood, Scale};
use pd_core::material::{EnergySplit, Material, StrainEnergy};
use pd_core::record::Record;
use pd_core::{Real, Result};

/// The scalar force state t of an ordinary material, linear in the extensions e of the family.
pub trait ScalarState<T: Real, const D: usize>: Send + Sync {
    /// Constants of a bond besides its length.
    type BondConst: Copy + Send + Sync;
    /// Constants of a node that the force knows.
    type NodeConst: Record<T>;
    /// Constants of a node that only its state is made from.
    type FamilyConst: Record<T>;
    /// Running sum over the family.
    type FamilySum: Record<T>;
    /// State of a node.
    type NodeState: Record<T>;

    /// Mass density ρ in kg/m³.
    fn density(&self, node: usize) -> f64;
    /// Constants of a bond.
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::BondConst;
    /// Constants of a node.
    ///
    /// # Errors
    /// What makes the family unusable.
    fn node_const(
        &self,
        family: &Neighbourhood<'_, (BondLength<T>, Self::BondConst), D>,
    ) -> Result<(Self::NodeConst, Self::FamilyConst)> {
        let _ = family;
        Ok(Record::zero())
    }
    /// Adds the extension `e` of a bond to the family sum.
    #[inline(always)]
    fn add(
        &self,
        sum: &mut Self::FamilySum,
        bond: &Bond<T, D>,
        e: T,
        k: &Self::BondConst,
        volume: T,
    ) {
        let _ = (sum, bond, e, k, volume);
    }
    /// State of a node.
    #[inline(always)]
    fn close(
        &self,
        sum: &Self::FamilySum,
        constants: &Self::NodeConst,
        family: &Self::FamilyConst,
    ) -> Self::NodeState {
        let _ = (sum, constants, family);
        Record::zero()
    }
    /// The scalar force state t = a + b e, times `weight`, as (a, b); `None` for a = 0. Constants of
    /// the bond times the weight are the same for a whole block of a lattice: multiply them first.
    fn line(
        &self,
        bond: &Bond<T, D>,
        weight: T,
        k: &Self::BondConst,
        constants: &Self::NodeConst,
        state: &Self::NodeState,
    ) -> (Option<T>, T);
    /// Scalar force state t of a bond with extension `e`.
    #[inline(always)]
    fn scalar_force(
        &self,
        bond: &Bond<T, D>,
        e: T,
        k: &Self::BondConst,
        constants: &Self::NodeConst,
        state: &Self::NodeState,
    ) -> T {
        let (a, b) = self.line(bond, T::one(), k, constants, state);
        a.map_or(b * e, |a| bond.fma(b, e, a))
    }
}

/// A model whose bond energy splits into that of volume change and that of shape change.
pub trait SplitState<T: Real, const D: usize>: ScalarState<T, D> {
    /// (w_iso, w_shr) that the node stores along a bond of extension `e` and length |ξ|, per βV.
    fn energy_parts(
        &self,
        e: T,
        length: T,
        k: &Self::BondConst,
        constants: &Self::NodeConst,
        state: &Self::NodeState,
    ) -> (T, T);
}

/// A material from a [`ScalarState`] and [`Kinematics`].
#[derive(Debug, Clone, Copy)]
pub struct Ordinary<S, K = Finite> {
    /// The model.
    pub model: S,
    kinematics: std::marker::PhantomData<K>,
}

impl<S> Ordinary<S, Finite> {
    /// With finite kinematics.
    pub fn new(model: S) -> Self {
        Self { model, kinematics: std::marker::PhantomData }
    }
}

impl<S> Ordinary<S, Linearised> {
    /// With linearised kinematics.
    pub fn linearised(model: S) -> Self {
        Self { model, kinematics: std::marker::PhantomData }
    }
}

impl<T, const D: usize, S, K> Material<T, D> for Ordinary<S, K>
where
    T: Real,
    S: ScalarState<T, D>,
    K: Kinematics,
{
    type BondConst = (BondLength<T>, S::BondConst);
    type NodeConst = S::NodeConst;
    type FamilyConst = S::FamilyConst;
    type FamilySum = S::FamilySum;
    type NodeState = S::NodeState;
    const LINEAR: bool = K::LINEAR;
    const STRETCH: bool = K::STRETCH;

    fn density(&self, node: usize) -> f64 {
        self.model.density(node)
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::BondConst {
        (BondLength::new(xi), self.model.bond_const(xi, scale))
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, Self::BondConst, D>,
    ) -> Result<(Self::NodeConst, Self::FamilyConst)> {
        self.model.node_const(family)
    }
    #[inline(always)]
    fn add_bond(
        &self,
        sum: &mut S::FamilySum,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, S::NodeConst, ()>,
    ) {
        let e = K::extension(bond, end.bond.0);
        self.model.add(sum, bond, e, &end.bond.1, end.volume);
    }
    #[inline(always)]
    fn node_state(
        &self,
        sum: &S::FamilySum,
        constants: &S::NodeConst,
        family: &S::FamilyConst,
        _: &S::NodeState,
    ) -> S::NodeState {
        self.model.close(sum, constants, family)
    }
    #[inline(always)]
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, S::NodeConst, S::NodeState>,
    ) -> SVector<T, D> {
        let (a, b) = self.model.line(bond, T::one(), &end.bond.1, end.node, end.state);
        let (t, m) = K::force(bond, end.bond.0, a, b);
        m * t
    }
    #[inline(always)]
    fn pair_force(
        &self,
        bond: &Bond<T, D>,
        ends: [End<'_, T, Self::BondConst, S::NodeConst, S::NodeState>; 2],
    ) -> SVector<T, D> {
        let mut sum = SVector::zeros();
        self.add_pair_force(&mut sum, bond, ends);
        sum
    }
    /// (t βV + t' β'V) M: both ends share e and M, and t is a line in e at both.
    #[inline(always)]
    fn add_pair_force(
        &self,
        sum: &mut SVector<T, D>,
        bond: &Bond<T, D>,
        [near, far]: [End<'_, T, Self::BondConst, S::NodeConst, S::NodeState>; 2],
    ) {
        let line = |end: &End<'_, T, Self::BondConst, S::NodeConst, S::NodeState>| {
            self.model.line(bond, end.volume, &end.bond.1, end.node, end.state)
        };
        let ((a0, b0), (a1, b1)) = (line(&near), line(&far));
        let a = match (a0, a1) {
            (Some(a0), Some(a1)) => Some(a0 + a1),
            (a0, a1) => a0.or(a1),
        };
        let (t, m) = K::force(bond, near.bond.0, a, b0 + b1);
        bond.add_scaled(sum, t, &m);
    }
}

impl<T, const D: usize, S, K> StrainEnergy<T, D> for Ordinary<S, K>
where
    T: Real,
    S: ScalarState<T, D>,
    K: Kinematics,
{
    #[inline(always)]
    fn bond_energy(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, S::NodeConst, S::NodeState>,
    ) -> T {
        let e = K::extension(bond, end.bond.0);
        T::of(0.5) * e * self.model.scalar_force(bond, e, &end.bond.1, end.node, end.state)
    }
}

impl<T, const D: usize, S, K> EnergySplit<T, D> for Ordinary<S, K>
where
    T: Real,
    S: SplitState<T, D>,
    K: Kinematics,
{
    #[inline(always)]
    fn energy_parts(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, S::NodeConst, S::NodeState>,
    ) -> (T, T) {
        let e = K::extension(bond, end.bond.0);
        self.model.energy_parts(e, end.bond.0.length, &end.bond.1, end.node, end.state)
    }
}
