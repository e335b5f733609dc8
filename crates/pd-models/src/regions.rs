//! Several materials of one kind in a body.

use crate::Result;
use nalgebra::{SMatrix, SVector};
use pd_core::bond::{Bond, End, Member, Neighbourhood, Scale};
use pd_core::material::{Material, StrainEnergy, StressState};
use pd_core::{Real, Result as CoreResult};

/// R materials of one type, chosen per node: plies, inclusions, fibre and matrix. Each end of a
/// bond has the force state of its own material.
pub struct Regions<M, const R: usize> {
    materials: [M; R],
    region: Vec<u8>,
}

impl<M, const R: usize> Regions<M, R> {
    /// From the materials and the region of every node (see
    /// [`Grid::regions`](pd_core::Grid::regions)).
    ///
    /// # Errors
    /// A region without a material.
    pub fn new(materials: [M; R], region: Vec<u8>) -> Result<Self> {
        for &r in &region {
            let need = "below the number of materials";
            pd_core::Error::check(usize::from(r) < R, "material region", f64::from(r), need)?;
        }
        Ok(Self { materials, region })
    }
    /// The materials.
    pub fn materials(&self) -> &[M; R] {
        &self.materials
    }
    fn of_node(&self, node: usize) -> usize {
        // Checked when the body is made: `density` is asked for every node first.
        self.region.get(node).map_or(0, |&r| usize::from(r))
    }
    /// The node's region, kept with its constants as a scalar.
    #[inline(always)]
    fn material<T: Real>(&self, tag: T) -> (usize, &M) {
        let r = tag.to_f64() as usize;
        (r, &self.materials[r])
    }
}

impl<T, const D: usize, M, const R: usize> Material<T, D> for Regions<M, R>
where
    T: Real,
    M: Material<T, D>,
{
    type BondConst = [M::BondConst; R];
    /// The region and the constants of the node's material.
    type NodeConst = (T, M::NodeConst);
    type FamilyConst = M::FamilyConst;
    type FamilySum = M::FamilySum;
    type NodeState = M::NodeState;
    const FOLLOWS_DAMAGE: bool = M::FOLLOWS_DAMAGE;
    const CAN_FAULT: bool = M::CAN_FAULT;
    const STRETCH: bool = M::STRETCH;

    fn density(&self, node: usize) -> f64 {
        if node >= self.region.len() {
            return f64::NAN;
        }
        self.materials[self.of_node(node)].density(node)
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::BondConst {
        std::array::from_fn(|r| self.materials[r].bond_const(xi, scale))
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, Self::BondConst, D>,
    ) -> CoreResult<(Self::NodeConst, M::FamilyConst)> {
        let r = self.of_node(family.node);
        let members: Vec<Member<M::BondConst, D>> = family
            .members
            .iter()
            .map(|m| Member { xi: m.xi, volume: m.volume, bond: m.bond[r] })
            .collect();
        let own = Neighbourhood { node: family.node, scale: family.scale, members: &members };
        let (constants, of_family) = self.materials[r].node_const(&own)?;
        Ok(((T::of(r as f64), constants), of_family))
    }
    #[inline(always)]
    fn add_bond(
        &self,
        sum: &mut M::FamilySum,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, ()>,
    ) {
        let (r, material) = self.material(end.node.0);
        let End { state, volume, .. } = end;
        material.add_bond(sum, bond, End { bond: &end.bond[r], node: &end.node.1, state, volume });
    }
    #[inline(always)]
    fn node_state(
        &self,
        sum: &M::FamilySum,
        (tag, constants): &Self::NodeConst,
        family: &M::FamilyConst,
        previous: &M::NodeState,
    ) -> M::NodeState {
        self.material(*tag).1.node_state(sum, constants, family, previous)
    }
    #[inline(always)]
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, M::NodeState>,
    ) -> SVector<T, D> {
        let (r, material) = self.material(end.node.0);
        let End { state, volume, .. } = end;
        material.force_state(bond, End { bond: &end.bond[r], node: &end.node.1, state, volume })
    }
    #[inline(always)]
    fn detached(&self, family: &M::FamilyConst) -> bool {
        self.materials[0].detached(family)
    }
    fn fault(&self, state: &M::NodeState) -> Option<f64> {
        self.materials[0].fault(state)
    }
}

impl<T, const D: usize, M, const R: usize> StressState<T, D> for Regions<M, R>
where
    T: Real,
    M: StressState<T, D>,
{
    #[inline(always)]
    fn stress(&self, (tag, constants): &Self::NodeConst, state: &M::NodeState) -> SMatrix<T, D, D> {
        self.material(*tag).1.stress(constants, state)
    }
}

impl<T, const D: usize, M, const R: usize> StrainEnergy<T, D> for Regions<M, R>
where
    T: Real,
    M: StrainEnergy<T, D>,
{
    #[inline(always)]
    fn node_energy(&self, (tag, constants): &Self::NodeConst, state: &M::NodeState) -> T {
        self.material(*tag).1.node_energy(constants, state)
    }
    #[inline(always)]
    fn bond_energy(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, M::NodeState>,
    ) -> T {
        let (r, material) = self.material(end.node.0);
        let End { state, volume, .. } = end;
        material.bond_energy(bond, End { bond: &end.bond[r], node: &end.node.1, state, volume })
    }
}
