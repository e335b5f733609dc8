//! Families: who interacts with whom, and the loops over bonds.
//!
//! A [`Family`] owns its storage and its loop order. Everything that is computed bond by bond
//! (node states, forces, energies, broken bonds) goes through [`Family::sweep`] or
//! [`Family::break_bonds`], so there is one loop per layout and one definition per material.

use crate::bond::{Bond, Member, Scale};
use crate::field::{Field, Inputs};
use crate::record::Record;
use crate::{Real, Result};
use nalgebra::SVector;

/// A bond as both ends see it: index 0 is the node being summed for, 1 its neighbour.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a, T, K> {
    /// Constants of the bond at each end.
    pub constants: [&'a K; 2],
    /// β V of the neighbour with β as each end sees it: 0 outside that end's horizon. In a
    /// [`BondTest`] 1 or 0.
    pub volumes: [T; 2],
}

/// Work done over the families of all nodes: from a zero sum add every intact bond, then close.
pub trait BondKernel<T: Real, const D: usize>: Sync {
    /// Constants per bond.
    type Const: Copy + Send + Sync;
    /// What is read at both nodes of a bond.
    type Node: Record<T>;
    /// What is read once per node, to close its sum.
    type Own: Record<T>;
    /// The running sum of one node.
    type Sum: Record<T>;
    /// The result of one node.
    type Out: Record<T>;
    /// True if something depends on the stretch of a bond.
    const STRETCH: bool;
    /// True if the sweep is to find the largest t.
    const TRACK: bool = Self::STRETCH;
    /// Adds one bond.
    fn add(
        &self,
        sum: &mut Self::Sum,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, Self::Const>,
        nodes: [&Self::Node; 2],
    );
    /// Turns the sum into the result; `previous` is what the output held before.
    fn close(
        &self,
        sum: &Self::Sum,
        node: &Self::Node,
        own: &Self::Own,
        previous: Self::Out,
    ) -> Self::Out;
}

/// A test of every undirected bond: it breaks where the failure index exceeds 1.
pub trait BondTest<T: Real, const D: usize>: Sync {
    /// Constants per bond.
    type Const: Copy + Send + Sync;
    /// What is read at both nodes of a bond.
    type Node: Record<T>;
    /// Failure index: value / critical value.
    fn index(
        &self,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, Self::Const>,
        nodes: [&Self::Node; 2],
    ) -> T;
}

/// Outcome of one test of all bonds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tally {
    /// Undirected bonds broken by this test.
    pub broken: usize,
    /// Largest failure index met (0 if no bond is left).
    pub worst: f64,
}

impl Tally {
    /// Both outcomes together.
    pub fn merge(self, other: Self) -> Self {
        Self { broken: self.broken + other.broken, worst: self.worst.max(other.worst) }
    }
}

/// Which nodes a sweep visits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Visit {
    /// Every node.
    All,
    /// Nodes that lost a bond since the marks were last cleared, and possibly their neighbours
    /// in memory (whose result is the same when computed again).
    Marked,
}

/// A neighbour of a node, for setup, reports and criteria that walk the families.
#[derive(Debug, Clone, Copy)]
pub struct Neighbour<const D: usize> {
    /// Index of the neighbour.
    pub node: usize,
    /// Reference bond ξ in units of Δx.
    pub xi: SVector<f64, D>,
    /// Quadrature volume β V in Δx^D; 0 for a neighbour in the dual family only.
    pub volume: f64,
    /// False once the bond is broken or cut.
    pub intact: bool,
}

/// The nodes of a body, their neighbours, and the loops over bonds.
///
/// Nodes are what users count; sites are places in the node arrays ([`Family::site`]): a lattice
/// has more sites than nodes because it pads its rows.
pub trait Family<T: Real, const D: usize>: Send + Sync + Sized {
    /// Storage of one constant per bond: one table for a lattice, one entry per bond in a cloud.
    type PerBond<K: Copy + Send + Sync>: Send + Sync;
    /// Storage of the intact bonds.
    type Bits: Send + Sync;

    /// Number of nodes.
    fn nodes(&self) -> usize;
    /// Length of the node arrays.
    fn sites(&self) -> usize;
    /// Where node `node` is stored.
    fn site(&self, node: usize) -> usize;
    /// Reference position x of a node, in metres.
    fn position(&self, node: usize) -> SVector<f64, D>;
    /// Volume of a node (area in 2D), in m^D.
    fn volume(&self, node: usize) -> f64;
    /// Horizon of a node and the unit of length.
    fn scale(&self, node: usize) -> Scale;
    /// The unit of length Δx in metres.
    fn unit(&self) -> f64;
    /// Number of undirected bonds.
    fn bonds(&self) -> usize;
    /// Bytes held by the family itself.
    fn bytes(&self) -> usize;

    /// Evaluates `constant(ξ, scale)` for every bond.
    fn per_bond<K: Copy + Send + Sync>(
        &self,
        constant: &(dyn Fn(&SVector<f64, D>, Scale) -> K + Sync),
    ) -> Self::PerBond<K>;
    /// Bytes held by such a table.
    fn per_bond_bytes<K: Copy + Send + Sync>(table: &Self::PerBond<K>) -> usize;

    /// All bonds intact. Bonds with an end that is not `breakable` are never tested; a family may hold
    /// the bits of others alone, and of these once they are cut.
    fn intact(&self, breakable: &(dyn Fn(usize) -> bool + Sync)) -> Self::Bits;
    /// Bytes held by the bits.
    fn bits_bytes(bits: &Self::Bits) -> usize;
    /// Cuts every bond for which `cuts(node, neighbour)` (node < neighbour) holds; returns how many.
    fn cut(&self, bits: &mut Self::Bits, cuts: &(dyn Fn(usize, usize) -> bool + Sync)) -> usize;
    /// Cuts every bond of `node`; returns how many were intact.
    fn isolate(&self, bits: &mut Self::Bits, node: usize) -> usize;
    /// Takes the marks of nodes that lost a bond since the last call: calls `visit` with each node
    /// in ascending order. The marks stay until [`Family::clear_marks`].
    fn marked(&self, bits: &Self::Bits, visit: &mut dyn FnMut(usize));
    /// Clears the marks.
    fn clear_marks(bits: &mut Self::Bits);
    /// A copy of the bits, to compare with what is left later.
    fn copy_bits(bits: &Self::Bits) -> Self::Bits;
    /// Marks in `bits` the nodes that are marked in `other`, and no others.
    fn copy_marks(bits: &mut Self::Bits, other: &Self::Bits);
    /// The bits as bytes, to be kept.
    fn bits_as_bytes(bits: &Self::Bits) -> Vec<u8>;
    /// The bits that were kept; none if they are not a part of this family's bonds.
    fn bits_from_bytes(&self, bytes: &[u8]) -> Option<Self::Bits>;
    /// Visits the neighbours of `node` in the order of their bonds, broken ones too.
    fn neighbours(
        &self,
        node: usize,
        bits: Option<&Self::Bits>,
        visit: &mut dyn FnMut(Neighbour<D>),
    );
    /// Fills `into` with the members of the family of `node` (intact ones only if bits are given).
    fn members<K: Copy + Send + Sync>(
        &self,
        node: usize,
        table: &Self::PerBond<K>,
        bits: Option<&Self::Bits>,
        into: &mut Vec<Member<K, D>>,
    );

    /// Runs `kernel` over the families of all nodes. Each node's bonds are added in the order of ξ,
    /// the last component first, whatever the number of threads. Where the kernel asks for it
    /// ([`BondKernel::TRACK`]), returns the largest t met at a visited node
    /// ([`Bond::square_strain`]; 0 if all are smaller).
    #[allow(clippy::too_many_arguments)]
    fn sweep<Kn, I, J>(
        &self,
        kernel: &Kn,
        table: &Self::PerBond<Kn::Const>,
        bits: Option<&Self::Bits>,
        visit: Visit,
        u: &Field<T, SVector<T, D>>,
        input: (I, J),
        out: &mut Field<T, Kn::Out>,
    ) -> T
    where
        Kn: BondKernel<T, D>,
        I: Inputs<T, Value = Kn::Node>,
        J: Inputs<T, Value = Kn::Own>;

    /// Tests every intact undirected bond once, from its lower to its higher node, breaks those
    /// whose index exceeds 1, and marks their ends.
    fn break_bonds<B, I>(
        &self,
        test: &B,
        table: &Self::PerBond<B::Const>,
        bits: &mut Self::Bits,
        u: &Field<T, SVector<T, D>>,
        input: I,
    ) -> Tally
    where
        B: BondTest<T, D>,
        I: Inputs<T, Value = B::Node>;
}

/// Horizon δ of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizon {
    /// δ = m Δx.
    Cells(f64),
    /// δ in metres.
    Metres(f64),
}

impl Horizon {
    /// δ in units of `unit`.
    ///
    /// # Errors
    /// [`crate::Error::InvalidValue`] unless finite and positive.
    pub fn in_units(self, unit: f64) -> Result<f64> {
        match self {
            Self::Cells(m) => crate::Error::positive("horizon ratio m = δ/Δx", m),
            Self::Metres(delta) => Ok(crate::Error::positive("horizon δ [m]", delta)? / unit),
        }
    }
}
