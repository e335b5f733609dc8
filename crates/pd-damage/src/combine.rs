//! Where a criterion holds: regions that cannot fail, and criteria per material and interface.

use pd_core::bond::Scale;
use pd_core::damage::{DamageCriterion, TestedBond};
use pd_core::{Error, Material, NodeSet, Real, Record, Result};

/// Ways to restrict a criterion.
pub trait CriterionExt: Sized {
    /// Bonds with an end in `nodes` never break (grips, loaded layers).
    fn sparing(self, nodes: &NodeSet) -> Sparing<Self> {
        Sparing { criterion: self, nodes: nodes.clone() }
    }
    /// Bonds break where this criterion or `other` breaks them.
    fn or<C>(self, other: C) -> AnyOf<Self, C> {
        AnyOf(self, other)
    }
}
impl<C> CriterionExt for C {}

/// See [`CriterionExt::sparing`].
#[derive(Debug, Clone)]
pub struct Sparing<C> {
    criterion: C,
    nodes: NodeSet,
}

impl<T, const D: usize, M, C> DamageCriterion<T, D, M> for Sparing<C>
where
    T: Real,
    M: Material<T, D>,
    C: DamageCriterion<T, D, M>,
{
    /// 0 for a spared node, 1 for others; the criterion's own constants.
    type NodeConst = (T, C::NodeConst);
    type NodeValue = C::NodeValue;

    fn node_const(&self, node: usize, scale: Scale) -> Self::NodeConst {
        let breakable = if self.nodes.contains(node) { T::zero() } else { T::one() };
        (breakable, self.criterion.node_const(node, scale))
    }
    #[inline(always)]
    fn node_value(&self, material: &M, c: &M::NodeConst, s: &M::NodeState) -> C::NodeValue {
        self.criterion.node_value(material, c, s)
    }
    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, Self::NodeConst, C::NodeValue>) -> T {
        let [(a, ca), (b, cb)] = tested.constants;
        let index = self.criterion.index(&tested.with_constants([ca, cb]));
        if *a * *b > T::zero() { index } else { T::zero() }
    }
    fn can_break(&self, node: usize) -> bool {
        !self.nodes.contains(node) && self.criterion.can_break(node)
    }
    fn validate(&self, nodes: usize) -> Result<()> {
        let last = self.nodes.iter().last().unwrap_or(0);
        let need = "a node of the body (was the set made for another grid?)";
        Error::check(last < nodes, "node that must not fail", last as f64, need)?;
        self.criterion.validate(nodes)
    }
}

/// Two criteria, either of which breaks a bond: the index is the larger of the two. Nest it for
/// more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnyOf<A, B>(pub A, pub B);

impl<T, const D: usize, M, A, B> DamageCriterion<T, D, M> for AnyOf<A, B>
where
    T: Real,
    M: Material<T, D>,
    A: DamageCriterion<T, D, M>,
    B: DamageCriterion<T, D, M>,
{
    type NodeConst = (A::NodeConst, B::NodeConst);
    type NodeValue = (A::NodeValue, B::NodeValue);

    fn node_const(&self, node: usize, scale: Scale) -> Self::NodeConst {
        (self.0.node_const(node, scale), self.1.node_const(node, scale))
    }
    #[inline(always)]
    fn node_value(&self, material: &M, c: &M::NodeConst, s: &M::NodeState) -> Self::NodeValue {
        (self.0.node_value(material, c, s), self.1.node_value(material, c, s))
    }
    #[inline(always)]
    fn write_value(
        &self,
        material: &M,
        c: &M::NodeConst,
        s: &M::NodeState,
        value: &mut Self::NodeValue,
    ) {
        self.0.write_value(material, c, s, &mut value.0);
        self.1.write_value(material, c, s, &mut value.1);
    }
    #[inline(always)]
    fn index(&self, bond: &TestedBond<'_, T, D, M, Self::NodeConst, Self::NodeValue>) -> T {
        let ([c0, c1], [v0, v1]) = (bond.constants, bond.values);
        let first = self.0.index(&bond.seen_by([&c0.0, &c1.0], [&v0.0, &v1.0]));
        let second = self.1.index(&bond.seen_by([&c0.1, &c1.1], [&v0.1, &v1.1]));
        first.max(second)
    }
    fn can_break(&self, node: usize) -> bool {
        self.0.can_break(node) || self.1.can_break(node)
    }
    fn validate(&self, nodes: usize) -> Result<()> {
        self.0.validate(nodes)?;
        self.1.validate(nodes)
    }
}

/// One of two criteria, so that a table of [`Interfaces`] can hold criteria of different kinds.
/// Nest it for more. Put [`CriterionExt::sparing`] around the whole table: constants of a node
/// belong to one kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Either<A, B> {
    /// The first kind.
    First(A),
    /// The second kind.
    Second(B),
}

impl<T, const D: usize, M, A, B> DamageCriterion<T, D, M> for Either<A, B>
where
    T: Real,
    M: Material<T, D>,
    A: DamageCriterion<T, D, M, NodeConst = ()>,
    B: DamageCriterion<T, D, M, NodeConst = ()>,
{
    type NodeConst = ();
    /// Both values: an interface may ask for either at both of its sides.
    type NodeValue = (A::NodeValue, B::NodeValue);

    #[inline(always)]
    fn node_value(&self, material: &M, c: &M::NodeConst, s: &M::NodeState) -> Self::NodeValue {
        let mut value = Record::zero();
        self.write_value(material, c, s, &mut value);
        value
    }
    #[inline(always)]
    fn write_value(
        &self,
        material: &M,
        c: &M::NodeConst,
        s: &M::NodeState,
        value: &mut Self::NodeValue,
    ) {
        match self {
            Self::First(a) => a.write_value(material, c, s, &mut value.0),
            Self::Second(b) => b.write_value(material, c, s, &mut value.1),
        }
    }
    #[inline(always)]
    fn index(&self, bond: &TestedBond<'_, T, D, M, (), Self::NodeValue>) -> T {
        let ([c0, c1], [v0, v1]) = (bond.constants, bond.values);
        match self {
            Self::First(a) => a.index(&bond.seen_by([c0, c1], [&v0.0, &v1.0])),
            Self::Second(b) => b.index(&bond.seen_by([c0, c1], [&v0.1, &v1.1])),
        }
    }
    fn validate(&self, nodes: usize) -> Result<()> {
        match self {
            Self::First(a) => a.validate(nodes),
            Self::Second(b) => b.validate(nodes),
        }
    }
}

/// A criterion per pair of material regions: the diagonal for bonds inside a region, the rest for
/// the interfaces.
#[derive(Debug, Clone)]
pub struct Interfaces<C, const R: usize> {
    table: [[C; R]; R],
    region: Vec<u8>,
}

impl<C, const R: usize> Interfaces<C, R> {
    /// `table[a][b]` is the criterion of bonds between regions a and b (make it symmetric: bonds
    /// are tested from their lower to their higher node); `region` gives the region of every node.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a region without a row.
    pub fn new(table: [[C; R]; R], region: Vec<u8>) -> Result<Self> {
        for &r in &region {
            let need = "below the number of rows of the table";
            Error::check(usize::from(r) < R, "region of a criterion", f64::from(r), need)?;
        }
        Ok(Self { table, region })
    }
}

impl<T, const D: usize, M, C, const R: usize> DamageCriterion<T, D, M> for Interfaces<C, R>
where
    T: Real,
    M: Material<T, D>,
    C: DamageCriterion<T, D, M>,
{
    /// The region, and the constants of the region's own criterion.
    type NodeConst = (T, C::NodeConst);
    /// What the criteria of the table write: a stress, say, the same for all of one kind.
    type NodeValue = C::NodeValue;

    fn node_const(&self, node: usize, scale: Scale) -> Self::NodeConst {
        let r = usize::from(self.region[node]);
        (T::of(r as f64), self.table[r][r].node_const(node, scale))
    }
    #[inline(always)]
    fn node_value(&self, material: &M, c: &M::NodeConst, s: &M::NodeState) -> C::NodeValue {
        let mut value = Record::zero();
        self.table.iter().flatten().for_each(|own| own.write_value(material, c, s, &mut value));
        value
    }
    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, D, M, Self::NodeConst, C::NodeValue>) -> T {
        let [(a, ca), (b, cb)] = tested.constants;
        let criterion = &self.table[a.to_f64() as usize][b.to_f64() as usize];
        criterion.index(&tested.with_constants([ca, cb]))
    }
    fn validate(&self, nodes: usize) -> Result<()> {
        let given = self.region.len();
        Error::check(given == nodes, "number of regions", given as f64, "the number of nodes")?;
        self.table.iter().flatten().try_for_each(|c| c.validate(nodes))
    }
}
