//! Damage by type: none, a pre-crack, or a criterion that breaks bonds.

use crate::bond::{Bond, End, Scale};
use crate::crack::CrackSurface;
use crate::family::{BondTest, Family, Pair, Tally};
use crate::field::{Field, map_sites};
use crate::material::{EnergySplit, Material};
use crate::record::Record;
use crate::{Error, Real, Result};
use nalgebra::SVector;

/// Constants and state of a material at one end of a bond.
pub type MaterialEnd<'a, T, const D: usize, M> = End<
    'a,
    T,
    <M as Material<T, D>>::BondConst,
    <M as Material<T, D>>::NodeConst,
    <M as Material<T, D>>::NodeState,
>;

/// A bond under test, from its lower to its higher node.
pub struct TestedBond<'a, T: Real, const D: usize, M: Material<T, D>, C, V> {
    /// The material.
    pub material: &'a M,
    /// The bond.
    pub bond: &'a Bond<T, D>,
    /// What the material knows at both ends.
    pub ends: [MaterialEnd<'a, T, D, M>; 2],
    /// The criterion's constants at both ends.
    pub constants: [&'a C; 2],
    /// The criterion's values at both ends.
    pub values: [&'a V; 2],
    /// The unit of length Δx in metres, for critical values that have a dimension.
    pub unit: f64,
}

impl<'a, T: Real, const D: usize, M: Material<T, D>, C, V> TestedBond<'a, T, D, M, C, V> {
    /// The same bond with other constants, for criteria that wrap another.
    #[inline(always)]
    pub fn with_constants<'b, N>(&'b self, constants: [&'b N; 2]) -> TestedBond<'b, T, D, M, N, V> {
        let Self { material, bond, ends, values, unit, .. } = *self;
        TestedBond { material, bond, ends, constants, values, unit }
    }
    /// The same bond with other constants and values, for criteria that combine others.
    #[inline(always)]
    pub fn seen_by<'b, N, W>(
        &'b self,
        constants: [&'b N; 2],
        values: [&'b W; 2],
    ) -> TestedBond<'b, T, D, M, N, W> {
        let Self { material, bond, ends, unit, .. } = *self;
        TestedBond { material, bond, ends, constants, values, unit }
    }
    /// Extension e = |Y| − |ξ| in units of Δx.
    #[inline(always)]
    pub fn extension(&self) -> T {
        self.bond.extension(self.bond.xi.dot(&self.bond.xi).sqrt())
    }
    /// Bond energy w = ½(|t| + |t'|)|e| in Pa/Δx^D (Willberg 4-2 with ½, errata 002-8, 002-10).
    ///
    /// t = T·M, the force state along the deformed bond: for an ordinary material the whole of it.
    /// Forces across the bond, which correspondence materials have, do no work on its extension.
    #[inline(always)]
    pub fn energy(&self) -> T {
        let (xi, eta) = (self.bond.xi, self.bond.eta);
        let y = xi + eta;
        let (length, deformed) = (xi.dot(&xi).sqrt(), y.dot(&y).sqrt());
        let extension = (xi + y).dot(&eta) / (deformed + length);
        let [near, far] = self.ends;
        let along = self.material.force_state(self.bond, near).dot(&y).abs() * near.volume
            + self.material.force_state(&self.bond.reversed(), far).dot(&y).abs() * far.volume;
        T::of(0.5) * along * extension.abs() / deformed
    }
    /// (w_iso, w_shr) in Pa/Δx^D, both ends together.
    #[inline(always)]
    pub fn energy_parts(&self) -> (T, T)
    where
        M: EnergySplit<T, D>,
    {
        let [near, far] = self.ends;
        let (iso, shear) = self.material.energy_parts(self.bond, near);
        let (iso_far, shear_far) = self.material.energy_parts(&self.bond.reversed(), far);
        (iso * near.volume + iso_far * far.volume, shear * near.volume + shear_far * far.volume)
    }
}

/// A damage criterion: a bond breaks, for good, when its failure index exceeds 1.
///
/// ```text
/// impl<T: Real, const D: usize, M: Material<T, D>> DamageCriterion<T, D, M> for MyStretch { … }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a damage criterion for the material `{M}`",
    note = "the criterion may need a capability (`StressState`, `EnergySplit`) that this material \
            lacks"
)]
pub trait DamageCriterion<T: Real, const D: usize, M: Material<T, D>>: Send + Sync {
    /// Parameters of a node (fibre angle, strengths); `()` stores nothing.
    type NodeConst: Record<T>;
    /// What the criterion needs of a node, evaluated once per node before the bonds.
    type NodeValue: Record<T>;

    /// Parameters of node `node`.
    fn node_const(&self, node: usize, scale: Scale) -> Self::NodeConst {
        let _ = (node, scale);
        Record::zero()
    }
    /// Value at a node from the material's constants and state there.
    #[inline(always)]
    fn node_value(
        &self,
        material: &M,
        constants: &M::NodeConst,
        state: &M::NodeState,
    ) -> Self::NodeValue {
        let _ = (material, constants, state);
        Record::zero()
    }
    /// Writes [`node_value`](Self::node_value). Criteria of several kinds in one scene each write
    /// their own part and leave the others' alone.
    #[inline(always)]
    fn write_value(
        &self,
        material: &M,
        constants: &M::NodeConst,
        state: &M::NodeState,
        value: &mut Self::NodeValue,
    ) {
        *value = self.node_value(material, constants, state);
    }
    /// Failure index of a bond: value / critical value.
    fn index(&self, bond: &TestedBond<'_, T, D, M, Self::NodeConst, Self::NodeValue>) -> T;

    /// Some(a) if the index of every bond is a t, with t the [`Bond::square_strain`]: then the
    /// largest t of a step, which the forces of many materials need anyway, tells that no bond
    /// fails.
    fn per_square_strain(&self) -> Option<T> {
        None
    }

    /// False if the index of every bond of the node is always 0: such bonds are neither tested nor
    /// need they a bit.
    fn can_break(&self, node: usize) -> bool {
        let _ = node;
        true
    }

    /// Refuses parameters that do not fit a body of `nodes` nodes.
    ///
    /// # Errors
    /// The first parameter that does not fit.
    fn validate(&self, nodes: usize) -> Result<()> {
        let _ = nodes;
        Ok(())
    }
}

/// What a policy's test of all bonds reads and writes.
pub struct Check<'a, T: Real, const D: usize, F: Family<T, D>, M: Material<T, D>, C, V> {
    pub(crate) family: &'a F,
    pub(crate) material: &'a M,
    pub(crate) table: &'a F::PerBond<M::BondConst>,
    pub(crate) bits: &'a mut F::Bits,
    pub(crate) u: &'a Field<T, SVector<T, D>>,
    pub(crate) node_const: &'a Field<T, M::NodeConst>,
    pub(crate) node_state: &'a Field<T, M::NodeState>,
    pub(crate) constants: &'a Field<T, C>,
    pub(crate) values: &'a mut Field<T, V>,
}

/// How a body is damaged: [`NoDamage`], [`Precracked`] or [`Breaking`].
pub trait DamagePolicy<T: Real, const D: usize, M: Material<T, D>>: Send + Sync {
    /// The criterion's parameters of a node.
    type NodeConst: Record<T>;
    /// The criterion's value at a node.
    type NodeValue: Record<T>;
    /// True if bonds can be missing: the body holds one bit per bond.
    const BITS: bool;
    /// True if bonds break during a run.
    const ACTIVE: bool;

    /// The cracks present from the start.
    fn cracks(&self) -> &Cracks<D>;
    /// Bonds are tested every this many steps.
    fn every(&self) -> usize {
        1
    }
    /// The criterion's parameters of a node.
    fn node_const(&self, node: usize, scale: Scale) -> Self::NodeConst {
        let _ = (node, scale);
        Record::zero()
    }
    /// Refuses parameters that do not fit the body.
    ///
    /// # Errors
    /// The first parameter that does not fit.
    fn validate(&self, nodes: usize) -> Result<()> {
        let _ = nodes;
        Ok(())
    }
    /// See [`DamageCriterion::per_square_strain`].
    fn per_square_strain(&self) -> Option<T> {
        None
    }
    /// See [`DamageCriterion::can_break`].
    fn can_break(&self, node: usize) -> bool {
        let _ = node;
        false
    }
    /// Tests all bonds and breaks those that fail.
    fn check<F: Family<T, D>>(
        &self,
        check: Check<'_, T, D, F, M, Self::NodeConst, Self::NodeValue>,
    ) -> Tally {
        let _ = check;
        Tally::default()
    }
}

/// Cracks present from the start, and whether they count as damage.
#[derive(Default)]
pub struct Cracks<const D: usize> {
    pub(crate) surfaces: Vec<Box<dyn CrackSurface<D>>>,
    pub(crate) leave_family: bool,
}

impl<const D: usize> Cracks<D> {
    /// No crack.
    pub const NONE: Self = Self { surfaces: Vec::new(), leave_family: false };
}

/// A body that stays whole: it holds no bits and tests nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoDamage;

impl<T: Real, const D: usize, M: Material<T, D>> DamagePolicy<T, D, M> for NoDamage {
    type NodeConst = ();
    type NodeValue = ();
    const BITS: bool = false;
    const ACTIVE: bool = false;
    fn cracks(&self) -> &Cracks<D> {
        const { &Cracks::NONE }
    }
}

/// A body with cracks that do not grow: it tests nothing, and a lattice holds bits along the cracks
/// only.
#[derive(Default)]
pub struct Precracked<const D: usize> {
    cracks: Cracks<D>,
}

impl<const D: usize> Precracked<D> {
    /// Cuts every bond that crosses `crack`.
    pub fn by(crack: impl CrackSurface<D> + 'static) -> Self {
        Self::default().and(crack)
    }
    /// Cuts the bonds that cross a further crack.
    pub fn and(mut self, crack: impl CrackSurface<D> + 'static) -> Self {
        self.cracks.surfaces.push(Box::new(crack));
        self
    }
    /// Cut bonds leave the reference family: m_V, B and the damage index do not count them.
    /// By default they stay, like bonds that break during the run.
    pub fn leaving_family(mut self) -> Self {
        self.cracks.leave_family = true;
        self
    }
}

impl<T: Real, const D: usize, M: Material<T, D>> DamagePolicy<T, D, M> for Precracked<D> {
    type NodeConst = ();
    type NodeValue = ();
    const BITS: bool = true;
    const ACTIVE: bool = false;
    fn cracks(&self) -> &Cracks<D> {
        &self.cracks
    }
}

/// A body whose bonds break by a criterion.
pub struct Breaking<C, const D: usize> {
    criterion: C,
    cracks: Cracks<D>,
    every: usize,
}

impl<C, const D: usize> Breaking<C, D> {
    /// Bonds break by `criterion`, tested every step.
    pub fn new(criterion: C) -> Self {
        Self { criterion, cracks: Cracks::NONE, every: 1 }
    }
    /// Cuts every bond that crosses `crack` before the start.
    pub fn precracked(mut self, crack: impl CrackSurface<D> + 'static) -> Self {
        self.cracks.surfaces.push(Box::new(crack));
        self
    }
    /// Cut bonds leave the reference family (see [`Precracked::leaving_family`]).
    pub fn leaving_family(mut self) -> Self {
        self.cracks.leave_family = true;
        self
    }
    /// Tests the bonds every `steps` steps only.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for 0.
    pub fn every(mut self, steps: usize) -> Result<Self> {
        Error::check(steps > 0, "steps between damage checks", 0.0, "at least 1")?;
        self.every = steps;
        Ok(self)
    }
}

/// Adapter: a criterion as a test of bonds.
struct CriterionTest<'a, C, M> {
    criterion: &'a C,
    material: &'a M,
    unit: f64,
}

type MaterialNode<T, const D: usize, M> =
    (<M as Material<T, D>>::NodeConst, <M as Material<T, D>>::NodeState);

impl<T, const D: usize, M, C> BondTest<T, D> for CriterionTest<'_, C, M>
where
    T: Real,
    M: Material<T, D>,
    C: DamageCriterion<T, D, M>,
{
    type Const = M::BondConst;
    type Node = (MaterialNode<T, D, M>, (C::NodeConst, C::NodeValue));

    #[inline(always)]
    fn index(
        &self,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, Self::Const>,
        nodes: [&Self::Node; 2],
    ) -> T {
        let [(m0, c0), (m1, c1)] = nodes;
        let tested = TestedBond {
            material: self.material,
            bond,
            ends: [
                End { bond: pair.constants[0], node: &m0.0, state: &m0.1, volume: pair.volumes[0] },
                End { bond: pair.constants[1], node: &m1.0, state: &m1.1, volume: pair.volumes[1] },
            ],
            constants: [&c0.0, &c1.0],
            values: [&c0.1, &c1.1],
            unit: self.unit,
        };
        self.criterion.index(&tested)
    }
}

impl<T, const D: usize, M, C> DamagePolicy<T, D, M> for Breaking<C, D>
where
    T: Real,
    M: Material<T, D>,
    C: DamageCriterion<T, D, M>,
{
    type NodeConst = C::NodeConst;
    type NodeValue = C::NodeValue;
    const BITS: bool = true;
    const ACTIVE: bool = true;

    fn cracks(&self) -> &Cracks<D> {
        &self.cracks
    }
    fn every(&self) -> usize {
        self.every
    }
    fn node_const(&self, node: usize, scale: Scale) -> Self::NodeConst {
        self.criterion.node_const(node, scale)
    }
    fn validate(&self, nodes: usize) -> Result<()> {
        self.criterion.validate(nodes)
    }
    fn per_square_strain(&self) -> Option<T> {
        self.criterion.per_square_strain()
    }
    fn can_break(&self, node: usize) -> bool {
        self.criterion.can_break(node)
    }
    fn check<F: Family<T, D>>(
        &self,
        check: Check<'_, T, D, F, M, Self::NodeConst, Self::NodeValue>,
    ) -> Tally {
        let Check { family, material, table, bits, u, .. } = check;
        let node = (check.node_const, check.node_state);
        if C::NodeValue::LEN > 0 {
            map_sites(node, check.values, |(c, s), _| self.criterion.node_value(material, &c, &s));
        }
        let test = CriterionTest { criterion: &self.criterion, material, unit: family.unit() };
        family.break_bonds(&test, table, bits, u, (node, (check.constants, &*check.values)))
    }
}
