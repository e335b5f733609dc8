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
    fn add(&self, sum: &mut Self::FamilySum, e: T, k: &Self::BondConst, volume: T) {
        let _ = (sum, e, k, volume);
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
    /// Scalar force state t of a bond with extension `e`.
    fn scalar_force(
        &self,
        e: T,
        k: &Self::BondConst,
        constants: &Self::NodeConst,
        state: &Self::NodeState,
    ) -> T;
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
        let (e, _) = K::extension_and_direction(bond, end.bond.0);
        self.model.add(sum, e, &end.bond.1, end.volume);
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
        let (e, m) = K::extension_and_direction(bond, end.bond.0);
        m * self.model.scalar_force(e, &end.bond.1, end.node, end.state)
    }
    /// (t βV + t' β'V) M: both ends share e and M.
    #[inline(always)]
    fn pair_force(
        &self,
        bond: &Bond<T, D>,
        ends: [End<'_, T, Self::BondConst, S::NodeConst, S::NodeState>; 2],
    ) -> SVector<T, D> {
        let (e, m) = K::extension_and_direction(bond, ends[0].bond.0);
        let t = |end: &End<'_, T, Self::BondConst, S::NodeConst, S::NodeState>| {
            self.model.scalar_force(e, &end.bond.1, end.node, end.state) * end.volume
        };
        m * (t(&ends[0]) + t(&ends[1]))
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
        let (e, _) = K::extension_and_direction(bond, end.bond.0);
        T::of(0.5) * e * self.model.scalar_force(e, &end.bond.1, end.node, end.state)
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
        let (e, _) = K::extension_and_direction(bond, end.bond.0);
        self.model.energy_parts(e, end.bond.0.length, &end.bond.1, end.node, end.state)
    }
}
