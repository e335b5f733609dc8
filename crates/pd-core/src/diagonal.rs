//! The diagonal blocks −∂f_i/∂u_i of the stiffness operator, exactly and in 2D sweeps.
//!
//! Displace node i alone, by a: all its bonds have η = −a, so its own state is a family sum with
//! that η; and each neighbour has exactly one bond with an extension, the one back to i, so its
//! state is made from that bond alone. Both are known while the bonds of i are swept: no colouring
//! of nodes is needed, and the blocks of all nodes come at once.

use crate::Real;
use crate::bond::{Bond, End};
use crate::family::{BondKernel, Family, Pair, Visit};
use crate::field::{Field, map_sites};
use crate::material::Material;
use crate::record::Record;
use nalgebra::{SMatrix, SVector};

/// State of each node displaced by `a` alone.
struct AloneState<'a, M, T, const D: usize> {
    material: &'a M,
    a: SVector<T, D>,
}

impl<T: Real, const D: usize, M: Material<T, D>> BondKernel<T, D> for AloneState<'_, M, T, D> {
    type Const = M::BondConst;
    type Node = M::NodeConst;
    type Own = M::FamilyConst;
    type Sum = M::FamilySum;
    type Out = M::NodeState;
    // The displacement is the probe's, not the body's: nothing is known of its size.
    const STRETCH: bool = false;

    #[inline(always)]
    fn add(
        &self,
        sum: &mut M::FamilySum,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, M::BondConst>,
        nodes: [&M::NodeConst; 2],
    ) {
        let [bond_const, _] = pair.constants;
        let end = End { bond: bond_const, node: nodes[0], state: &(), volume: pair.volumes[0] };
        self.material.add_bond(sum, &Bond::new(bond.xi, -self.a), end);
    }
    #[inline(always)]
    fn close(
        &self,
        sum: &M::FamilySum,
        node: &M::NodeConst,
        own: &M::FamilyConst,
        _: M::NodeState,
    ) -> M::NodeState {
        self.material.node_state(sum, node, own, &Record::zero())
    }
}

/// Force on each node displaced by `a` alone.
struct AloneForce<'a, M, T, const D: usize> {
    material: &'a M,
    a: SVector<T, D>,
}

impl<T: Real, const D: usize, M: Material<T, D>> BondKernel<T, D> for AloneForce<'_, M, T, D> {
    type Const = M::BondConst;
    /// Constants, state and volume of a node.
    type Node = (((M::NodeConst, M::FamilyConst), M::NodeState), T);
    type Own = ();
    type Sum = SVector<T, D>;
    type Out = SVector<T, D>;
    const STRETCH: bool = false;

    #[inline(always)]
    fn add(
        &self,
        sum: &mut SVector<T, D>,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, M::BondConst>,
        nodes: [&Self::Node; 2],
    ) {
        let [(((c0, _), state0), volume0), (((c1, f1), _), volume1)] = nodes;
        let ([k0, k1], [v0, v1]) = (pair.constants, pair.volumes);
        let bond = Bond::new(bond.xi, -self.a);
        let mut back = M::FamilySum::zero();
        // Forces are weighed with the volume of the other node, strains with that of this one.
        let seen = End { bond: k1, node: c1, state: &(), volume: v1 * *volume0 / *volume1 };
        self.material.add_bond(&mut back, &bond.reversed(), seen);
        let state1 = self.material.node_state(&back, c1, f1, &Record::zero());
        let ends = [
            End { bond: k0, node: c0, state: state0, volume: v0 },
            End { bond: k1, node: c1, state: &state1, volume: v1 },
        ];
        *sum += self.material.pair_force(&bond, ends);
    }
    #[inline(always)]
    fn close(
        &self,
        sum: &SVector<T, D>,
        _: &Self::Node,
        (): &(),
        _: SVector<T, D>,
    ) -> SVector<T, D> {
        *sum
    }
}

/// −∂f_i/∂u_i at every site, by one force each way and axis (one way for a linear material).
pub(crate) fn blocks<T, const D: usize, F, M>(
    family: &F,
    material: &M,
    table: &F::PerBond<M::BondConst>,
    bits: Option<&F::Bits>,
    constants: (&Field<T, M::NodeConst>, &Field<T, M::FamilyConst>),
) -> Field<T, SMatrix<T, D, D>>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
{
    let sites = family.sites();
    let mut volumes = Field::zeros(sites);
    volumes.as_mut_slice().fill(T::one());
    for node in 0..family.nodes() {
        let relative = family.volume(node) / family.volume(0);
        volumes.set(family.site(node), T::of(relative));
    }
    let mut blocks = Field::zeros(sites);
    let rest = Field::zeros(sites);
    let mut state: Field<T, M::NodeState> = Field::zeros(sites);
    let mut force: Field<T, SVector<T, D>> = Field::zeros(sites);
    let (steps, size): (&[f64], f64) =
        if M::LINEAR { (&[1.0], 1.0) } else { (&[1.0, -1.0], T::EPSILON.cbrt()) };
    for axis in 0..D {
        for sign in steps {
            let mut a = SVector::zeros();
            a[axis] = T::of(sign * size);
            if M::NodeState::LEN > 0 {
                let kernel = AloneState { material, a };
                family.sweep(&kernel, table, bits, Visit::All, &rest, constants, &mut state);
            }
            let kernel = AloneForce { material, a };
            let input = (((constants, &state), &volumes), ());
            family.sweep(&kernel, table, bits, Visit::All, &rest, input, &mut force);
            let weight = T::of(-sign / (size * steps.len() as f64));
            map_sites(&force, &mut blocks, |f, mut block: SMatrix<T, D, D>| {
                block.set_column(axis, &(block.column(axis) + f * weight));
                block
            });
        }
    }
    blocks
}
