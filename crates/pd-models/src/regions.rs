//! Several materials in a body: of one type ([`Regions`]), of two types ([`Mixed`]).

use crate::Result;
use nalgebra::{SMatrix, SVector};
use pd_core::bond::{Bond, End, Member, Neighbourhood, Scale};
use pd_core::material::{EnergySplit, Material, StrainEnergy, StressState};
use pd_core::record::Record;
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
}

/// What the material of the node's region gives, the region being kept with the node's constants as
/// a scalar. All materials are asked and one answer is taken: a blend, where a choice before would
/// keep the loop over nodes from becoming vector code, as would a closure that is not inlined.
macro_rules! of_region {
    ($regions:expr, $tag:expr, |$r:pat_param, $material:ident| $answer:expr) => {{
        let ask = |r: usize| (r, &$regions.materials[r]);
        let ($r, $material) = ask(0);
        let mut found = $answer;
        for r in 1..R {
            let ($r, $material) = ask(r);
            found = Record::<T>::select($tag == T::of(r as f64), $answer, found);
        }
        found
    }};
}

/// The end of a bond as the material of region `r` sees it.
#[inline(always)]
fn seen_by<'a, T, K, N, S, const R: usize>(
    end: End<'a, T, [K; R], (T, N), S>,
    r: usize,
) -> End<'a, T, K, N, S> {
    let End { bond, node, state, volume } = end;
    End { bond: &bond[r], node: &node.1, state, volume }
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
    const LINEAR: bool = M::LINEAR;
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
        let members = seen_as(family.members, |k| k[r]);
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
        *sum = of_region!(self, end.node.0, |r, material| {
            let mut sum = *sum;
            material.add_bond(&mut sum, bond, seen_by(end, r));
            sum
        });
    }
    #[inline(always)]
    fn node_state(
        &self,
        sum: &M::FamilySum,
        (tag, constants): &Self::NodeConst,
        family: &M::FamilyConst,
        previous: &M::NodeState,
    ) -> M::NodeState {
        of_region!(self, *tag, |_, m| m.node_state(sum, constants, family, previous))
    }
    #[inline(always)]
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, M::NodeState>,
    ) -> SVector<T, D> {
        of_region!(self, end.node.0, |r, material| material.force_state(bond, seen_by(end, r)))
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
        of_region!(self, *tag, |_, material| material.stress(constants, state))
    }
    #[inline(always)]
    fn bond_stress(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, M::NodeState>,
        stress: &SMatrix<T, D, D>,
    ) -> SMatrix<T, D, D> {
        of_region!(self, end.node.0, |r, m| m.bond_stress(bond, seen_by(end, r), stress))
    }
}

impl<T, const D: usize, M, const R: usize> StrainEnergy<T, D> for Regions<M, R>
where
    T: Real,
    M: StrainEnergy<T, D>,
{
    #[inline(always)]
    fn node_energy(&self, (tag, constants): &Self::NodeConst, state: &M::NodeState) -> T {
        of_region!(self, *tag, |_, material| material.node_energy(constants, state))
    }
    #[inline(always)]
    fn bond_energy(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, M::NodeState>,
    ) -> T {
        of_region!(self, end.node.0, |r, material| material.bond_energy(bond, seen_by(end, r)))
    }
}

impl<T, const D: usize, M, const R: usize> EnergySplit<T, D> for Regions<M, R>
where
    T: Real,
    M: EnergySplit<T, D>,
{
    #[inline(always)]
    fn energy_parts(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, M::NodeState>,
    ) -> (T, T) {
        of_region!(self, end.node.0, |r, material| material.energy_parts(bond, seen_by(end, r)))
    }
}

/// Two materials of different types in a body: a stiff inclusion of correspondence material in a
/// bond-based matrix. Each end of a bond has the force state of its own material; more than two
/// types nest.
///
/// A node carries the arrays of both. Materials of one type are cheaper in [`Regions`], which may
/// be one of the two.
pub struct Mixed<A, B> {
    first: A,
    second: B,
    is_second: Vec<bool>,
}

impl<A, B> Mixed<A, B> {
    /// From the two materials and, for every node, whether it is of the second one.
    pub fn new(first: A, second: B, is_second: Vec<bool>) -> Self {
        Self { first, second, is_second }
    }
    /// The materials.
    pub fn materials(&self) -> (&A, &B) {
        (&self.first, &self.second)
    }
}

/// Whether a tag is that of the second material.
#[inline(always)]
fn second<T: Real>(tag: T) -> bool {
    tag > T::zero()
}

/// An end as the first and as the second material sees it.
macro_rules! ends {
    ($end:expr) => {{
        let End { bond: (k, l), node: (_, (c, d)), state: (s, t), volume } = $end;
        let first = End { bond: k, node: c, state: s, volume };
        (first, End { bond: l, node: d, state: t, volume })
    }};
}

impl<T, const D: usize, A, B> Material<T, D> for Mixed<A, B>
where
    T: Real,
    A: Material<T, D>,
    B: Material<T, D>,
{
    type BondConst = (A::BondConst, B::BondConst);
    /// A tag, 1 for nodes of the second material, and the constants of both.
    type NodeConst = (T, (A::NodeConst, B::NodeConst));
    /// The tag, and the constants of both.
    type FamilyConst = (T, (A::FamilyConst, B::FamilyConst));
    type FamilySum = (A::FamilySum, B::FamilySum);
    type NodeState = (A::NodeState, B::NodeState);
    const FOLLOWS_DAMAGE: bool = A::FOLLOWS_DAMAGE || B::FOLLOWS_DAMAGE;
    const LINEAR: bool = A::LINEAR && B::LINEAR;
    const STRETCH: bool = A::STRETCH || B::STRETCH;
    const CAN_FAULT: bool = A::CAN_FAULT || B::CAN_FAULT;

    fn density(&self, node: usize) -> f64 {
        match self.is_second.get(node) {
            Some(true) => self.second.density(node),
            Some(false) => self.first.density(node),
            // The body refuses it: the list is for another one.
            None => f64::NAN,
        }
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::BondConst {
        (self.first.bond_const(xi, scale), self.second.bond_const(xi, scale))
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, Self::BondConst, D>,
    ) -> CoreResult<(Self::NodeConst, Self::FamilyConst)> {
        let Neighbourhood { node, scale, members } = *family;
        let (zero, one) = (T::zero(), T::one());
        if self.is_second.get(node).is_some_and(|&second| second) {
            let members = seen_as(members, |k| k.1);
            let own = Neighbourhood { node, scale, members: &members };
            let (c, f) = self.second.node_const(&own)?;
            Ok(((one, (Record::zero(), c)), (one, (Record::zero(), f))))
        } else {
            let members = seen_as(members, |k| k.0);
            let own = Neighbourhood { node, scale, members: &members };
            let (c, f) = self.first.node_const(&own)?;
            Ok(((zero, (c, Record::zero())), (zero, (f, Record::zero()))))
        }
    }
    #[inline(always)]
    fn add_bond(
        &self,
        sum: &mut Self::FamilySum,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, ()>,
    ) {
        let End { bond: (k, l), node: (tag, (c, d)), state, volume } = end;
        if second(*tag) {
            self.second.add_bond(&mut sum.1, bond, End { bond: l, node: d, state, volume });
        } else {
            self.first.add_bond(&mut sum.0, bond, End { bond: k, node: c, state, volume });
        }
    }
    #[inline(always)]
    fn node_state(
        &self,
        sum: &Self::FamilySum,
        (tag, (c, d)): &Self::NodeConst,
        (_, (f, g)): &Self::FamilyConst,
        previous: &Self::NodeState,
    ) -> Self::NodeState {
        if second(*tag) {
            (Record::zero(), self.second.node_state(&sum.1, d, g, &previous.1))
        } else {
            (self.first.node_state(&sum.0, c, f, &previous.0), Record::zero())
        }
    }
    #[inline(always)]
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
    ) -> SVector<T, D> {
        let tag = end.node.0;
        let (a, b) = ends!(end);
        if second(tag) { self.second.force_state(bond, b) } else { self.first.force_state(bond, a) }
    }
    #[inline(always)]
    fn detached(&self, (tag, (f, g)): &Self::FamilyConst) -> bool {
        if second(*tag) { self.second.detached(g) } else { self.first.detached(f) }
    }
    /// The state of the material that a node is not of is zero, in which no material has a fault.
    fn fault(&self, (s, t): &Self::NodeState) -> Option<f64> {
        let first = A::CAN_FAULT.then(|| self.first.fault(s)).flatten();
        first.or_else(|| B::CAN_FAULT.then(|| self.second.fault(t)).flatten())
    }
}

/// The members of a family with the constants of one of two materials.
fn seen_as<K: Copy, L, const D: usize>(
    members: &[Member<K, D>],
    of: impl Fn(K) -> L,
) -> Vec<Member<L, D>> {
    members.iter().map(|m| Member { xi: m.xi, volume: m.volume, bond: of(m.bond) }).collect()
}

impl<T, const D: usize, A, B> StressState<T, D> for Mixed<A, B>
where
    T: Real,
    A: StressState<T, D>,
    B: StressState<T, D>,
{
    #[inline(always)]
    fn stress(
        &self,
        (tag, (c, d)): &Self::NodeConst,
        (s, t): &Self::NodeState,
    ) -> SMatrix<T, D, D> {
        if second(*tag) { self.second.stress(d, t) } else { self.first.stress(c, s) }
    }
    #[inline(always)]
    fn bond_stress(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
        stress: &SMatrix<T, D, D>,
    ) -> SMatrix<T, D, D> {
        let tag = end.node.0;
        let (a, b) = ends!(end);
        if second(tag) {
            self.second.bond_stress(bond, b, stress)
        } else {
            self.first.bond_stress(bond, a, stress)
        }
    }
}

impl<T, const D: usize, A, B> StrainEnergy<T, D> for Mixed<A, B>
where
    T: Real,
    A: StrainEnergy<T, D>,
    B: StrainEnergy<T, D>,
{
    #[inline(always)]
    fn node_energy(&self, (tag, (c, d)): &Self::NodeConst, (s, t): &Self::NodeState) -> T {
        if second(*tag) { self.second.node_energy(d, t) } else { self.first.node_energy(c, s) }
    }
    #[inline(always)]
    fn bond_energy(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, Self::BondConst, Self::NodeConst, Self::NodeState>,
    ) -> T {
        let tag = end.node.0;
        let (a, b) = ends!(end);
        if second(tag) { self.second.bond_energy(bond, b) } else { self.first.bond_energy(bond, a) }
    }
}
