//! The material plugin: two passes, first a small node state from the family, then pair forces.

use crate::bond::{Bond, End, Neighbourhood, Scale};
use crate::record::Record;
use crate::{Real, Result};
use nalgebra::{SMatrix, SVector};

/// A peridynamic material.
///
/// Lengths (ξ, η, volumes, horizon) are in units of Δx, moduli in Pa, so force states T are in
/// Pa / Δx^(D+1) and need no thickness in 2D. Constants are computed once, in `f64`; the methods
/// with `T` run in the loops over bonds and must not branch on data or fail.
///
/// Only the types, [`density`](Self::density), [`bond_const`](Self::bond_const) and
/// [`force_state`](Self::force_state) are required; a material whose nodes carry nothing costs
/// no array and no node pass.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a peridynamic material for {D}D and scalar `{T}`",
    note = "implement `Material` (or `BondLaw` / `Constitutive` and wrap it)"
)]
pub trait Material<T: Real, const D: usize>: Send + Sync {
    /// What is known from ξ alone: one entry per offset on a lattice, per bond in a cloud.
    type BondConst: Copy + Send + Sync;
    /// What the pair force knows of a node from its reference family: 1/m, the node's own
    /// parameters. Read at both ends of every bond, so it is worth keeping small.
    type NodeConst: Record<T>;
    /// What else the node state is made from, read once per node: B, 𝓜⁻¹.
    type FamilyConst: Record<T>;
    /// The running sum over a family.
    type FamilySum: Record<T>;
    /// What the pair force needs of a node; `()` means no array and no node pass.
    type NodeState: Record<T>;
    /// True if node constants are those of the intact family: recomputed where a bond broke.
    const FOLLOWS_DAMAGE: bool = false;
    /// True if forces are exactly linear in the displacements: the [static
    /// solver](crate::statics) then takes them as they are, else differences of them.
    const LINEAR: bool = false;
    /// False if nothing depends on the stretch of a bond ([`Bond::stretch`]): then kernels do not
    /// look at it.
    const STRETCH: bool = true;

    /// Mass density ρ of a node in kg/m³.
    fn density(&self, node: usize) -> f64;

    /// Constants of the bond ξ for an end with this horizon.
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::BondConst;

    /// Constants of a node.
    ///
    /// # Errors
    /// Whatever makes the node's family unusable, naming the node.
    fn node_const(
        &self,
        family: &Neighbourhood<'_, Self::BondConst, D>,
    ) -> Result<(Self::NodeConst, Self::FamilyConst)> {
        let _ = family;
        Ok(Record::zero())
    }

    /// Adds a bond to the family sum of `end` (whose state is not known yet).
    #[inline(always)]
    fn add_bond(
        &self,
        sum: &mut Self::FamilySum,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, ()>,
    ) {
        let _ = (sum, bond, end);
    }

    /// State of a node from its family sum.
    #[inline(always)]
    fn node_state(
        &self,
        sum: &Self::FamilySum,
        constants: &Self::NodeConst,
        family: &Self::FamilyConst,
        previous: &Self::NodeState,
    ) -> Self::NodeState {
        let _ = (sum, constants, family, previous);
        Record::zero()
    }

    /// Force vector state T⟨ξ⟩ of `end`.
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
    ) -> SVector<T, D>;

    /// What the bond adds to the force density of its first node, T⟨ξ⟩βV − T'⟨−ξ⟩β'V.
    /// Override it where both ends share work.
    #[inline(always)]
    fn pair_force(
        &self,
        bond: &Bond<T, D>,
        ends: [End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>; 2],
    ) -> SVector<T, D> {
        self.force_state(bond, ends[0]) * ends[0].volume
            - self.force_state(&bond.reversed(), ends[1]) * ends[1].volume
    }

    /// Adds [`pair_force`](Self::pair_force) to the force density of the bond's first node, without
    /// the share of it that [`node_force`](Self::node_force) gives. Override it where the
    /// multiplications can take the addition along ([`Bond::fma`]).
    #[inline(always)]
    fn add_pair_force(
        &self,
        sum: &mut SVector<T, D>,
        bond: &Bond<T, D>,
        ends: [End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>; 2],
    ) {
        *sum += self.pair_force(bond, ends);
    }

    /// The share of a node's force density that its state tells, so that it need not be summed bond
    /// by bond: where T is linear in sums over the family, Σ T⟨ξ⟩βV is known with them, and
    /// [`add_pair_force`](Self::add_pair_force) adds only what the neighbours contribute. Nothing by
    /// default.
    #[inline(always)]
    fn node_force(&self, constants: &Self::NodeConst, state: &Self::NodeState) -> SVector<T, D> {
        let _ = (constants, state);
        SVector::zeros()
    }

    /// True if the node has lost its shape tensor: it carries no stress and its bonds break.
    #[inline(always)]
    fn detached(&self, family: &Self::FamilyConst) -> bool {
        let _ = family;
        false
    }

    /// True if [`fault`](Self::fault) can find something; then it is asked after every node pass.
    const CAN_FAULT: bool = false;

    /// det F of a node whose deformation the material cannot follow (J ≤ 0).
    #[inline(always)]
    fn fault(&self, state: &Self::NodeState) -> Option<f64> {
        let _ = state;
        None
    }
}

/// A material with a stress at every node.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no stress at a node, so a stress-based criterion cannot use it",
    label = "this material gives no stress",
    note = "use a criterion on bonds (critical stretch, bond energy), or a correspondence or \
            state-based material whose nodes have a strain"
)]
pub trait StressState<T: Real, const D: usize>: Material<T, D> {
    /// Cauchy stress σ in Pa from the node's constants and state.
    fn stress(&self, constants: &Self::NodeConst, state: &Self::NodeState) -> SMatrix<T, D, D>;
    /// Cauchy stress in Pa that `end` sees along a bond, given the `stress` of its node: that
    /// itself (Hattori et al. 2018) unless the material tells its bonds apart.
    #[inline(always)]
    fn bond_stress(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
        stress: &SMatrix<T, D, D>,
    ) -> SMatrix<T, D, D> {
        let _ = (bond, end);
        *stress
    }
}

/// A material whose forces derive from an energy density W_i = node part + Σ bond part βV, in Pa.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no strain energy, so energies cannot be reported for it",
    note = "implement `StrainEnergy`: a part per node and a part per bond"
)]
pub trait StrainEnergy<T: Real, const D: usize>: Material<T, D> {
    /// The part of W that the node's constants and state give.
    #[inline(always)]
    fn node_energy(&self, constants: &Self::NodeConst, state: &Self::NodeState) -> T {
        let _ = (constants, state);
        T::zero()
    }
    /// The part of W that one bond adds, per β V.
    #[inline(always)]
    fn bond_energy(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
    ) -> T {
        let _ = (bond, end);
        T::zero()
    }
}

/// A material that tells apart what a bond stores by a change of volume and by a change of shape.
///
/// It needs a dilatation θ at the nodes and an energy that is the sum of both parts; summed over a
/// family they are its strain energy, bond by bond they are not the bond's own work (errata
/// 002-12). The bond's own work, [`TestedBond::energy`](crate::TestedBond::energy), every material
/// has.
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not tell volumetric from deviatoric bond energy",
    label = "no dilatation, or no energy that splits by it",
    note = "use a criterion on the whole bond energy (`BondEnergy`) or on stretch or stress, or a \
            linear peridynamic solid (`Ordinary<LinearSolid>`)"
)]
pub trait EnergySplit<T: Real, const D: usize>: Material<T, D> {
    /// The share of `end` in (w_iso, w_shr) of a bond in Pa/Δx^D: the volumetric and the deviatoric
    /// energy that its node stores along the bond, per βV (Willberg 4-3, 4-4; errata
    /// 002-11, 002-22).
    fn energy_parts(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
    ) -> (T, T);
}

/// A material by reference, so that several bodies and a [`Symbol`](crate::Symbol) can share it.
impl<T: Real, const D: usize, M: Material<T, D>> Material<T, D> for &M {
    type BondConst = M::BondConst;
    type NodeConst = M::NodeConst;
    type FamilyConst = M::FamilyConst;
    type FamilySum = M::FamilySum;
    type NodeState = M::NodeState;
    const FOLLOWS_DAMAGE: bool = M::FOLLOWS_DAMAGE;
    const LINEAR: bool = M::LINEAR;
    const CAN_FAULT: bool = M::CAN_FAULT;
    const STRETCH: bool = M::STRETCH;

    fn density(&self, node: usize) -> f64 {
        (**self).density(node)
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::BondConst {
        (**self).bond_const(xi, scale)
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, Self::BondConst, D>,
    ) -> Result<(Self::NodeConst, Self::FamilyConst)> {
        (**self).node_const(family)
    }
    #[inline(always)]
    fn add_bond(
        &self,
        sum: &mut Self::FamilySum,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, ()>,
    ) {
        (**self).add_bond(sum, bond, end);
    }
    #[inline(always)]
    fn node_state(
        &self,
        sum: &Self::FamilySum,
        constants: &Self::NodeConst,
        family: &Self::FamilyConst,
        previous: &Self::NodeState,
    ) -> Self::NodeState {
        (**self).node_state(sum, constants, family, previous)
    }
    #[inline(always)]
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
    ) -> SVector<T, D> {
        (**self).force_state(bond, end)
    }
    #[inline(always)]
    fn pair_force(
        &self,
        bond: &Bond<T, D>,
        ends: [End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>; 2],
    ) -> SVector<T, D> {
        (**self).pair_force(bond, ends)
    }
    #[inline(always)]
    fn add_pair_force(
        &self,
        sum: &mut SVector<T, D>,
        bond: &Bond<T, D>,
        ends: [End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>; 2],
    ) {
        (**self).add_pair_force(sum, bond, ends);
    }
    #[inline(always)]
    fn node_force(&self, constants: &Self::NodeConst, state: &Self::NodeState) -> SVector<T, D> {
        (**self).node_force(constants, state)
    }
    #[inline(always)]
    fn detached(&self, family: &Self::FamilyConst) -> bool {
        (**self).detached(family)
    }
    #[inline(always)]
    fn fault(&self, state: &Self::NodeState) -> Option<f64> {
        (**self).fault(state)
    }
}

impl<T: Real, const D: usize, M: StressState<T, D>> StressState<T, D> for &M {
    #[inline(always)]
    fn stress(&self, constants: &Self::NodeConst, state: &Self::NodeState) -> SMatrix<T, D, D> {
        (**self).stress(constants, state)
    }
    #[inline(always)]
    fn bond_stress(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
        stress: &SMatrix<T, D, D>,
    ) -> SMatrix<T, D, D> {
        (**self).bond_stress(bond, end, stress)
    }
}

impl<T: Real, const D: usize, M: StrainEnergy<T, D>> StrainEnergy<T, D> for &M {
    #[inline(always)]
    fn node_energy(&self, constants: &Self::NodeConst, state: &Self::NodeState) -> T {
        (**self).node_energy(constants, state)
    }
    #[inline(always)]
    fn bond_energy(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
    ) -> T {
        (**self).bond_energy(bond, end)
    }
}

impl<T: Real, const D: usize, M: EnergySplit<T, D>> EnergySplit<T, D> for &M {
    #[inline(always)]
    fn energy_parts(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
    ) -> (T, T) {
        (**self).energy_parts(bond, end)
    }
}
