//! Where a criterion holds: regions that cannot fail, and criteria per material and interface.

use pd_core::bond::Scale;
use pd_core::damage::{DamageCriterion, TestedBond};
use pd_core::{Error, Material, NodeSet, Real, Result};

/// Ways to restrict a criterion.
pub trait CriterionExt: Sized {
    /// Bonds with an end in `nodes` never break (grips, loaded layers).
    fn sparing(self, nodes: &NodeSet) -> Sparing<Self> {
        Sparing { criterion: self, nodes: nodes.clone() }
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
    fn validate(&self, nodes: usize) -> Result<()> {
        let last = self.nodes.iter().last().unwrap_or(0);
        let need = "a node of the body (was the set made for another grid?)";
        Error::check(last < nodes, "node that must not fail", last as f64, need)?;
        self.criterion.validate(nodes)
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
    /// The same for all criteria of one type: a stress, say.
    type NodeValue = C::NodeValue;

    fn node_const(&self, node: usize, scale: Scale) -> Self::NodeConst {
        let r = usize::from(self.region[node]);
        (T::of(r as f64), self.table[r][r].node_const(node, scale))
    }
    #[inline(always)]
    fn node_value(&self, material: &M, c: &M::NodeConst, s: &M::NodeState) -> C::NodeValue {
        self.table[0][0].node_value(material, c, s)
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
