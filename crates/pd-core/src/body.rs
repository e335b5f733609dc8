//! A body: a family, a material, a damage policy, and the node arrays they need.

use crate::bond::{Bond, End, Member, Neighbourhood};
use crate::damage::{Check, DamagePolicy};
use crate::family::{BondKernel, Family, Pair, Tally, Visit};
use crate::field::Field;
use crate::material::{Material, StrainEnergy, StressState};
use crate::parallel::{axpy, axpy_weighted, map_pieces, sum_in_order};
use crate::record::Record;
use crate::state::{StateReader, StateWriter, unlike};
use crate::{Error, Real, Result};
use nalgebra::{SMatrix, SVector};

/// Nodes whose constants one task finds.
const CHUNK: usize = 256;

/// A body of nodes. Reads and writes SI units; inside, lengths are in units of Δx.
///
/// In 2D everything is per unit thickness unless [`with_thickness`](Self::with_thickness) says
/// otherwise; only totals (energies, forces on node sets) depend on it.
pub struct Body<T, const D: usize, F, M, P>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    family: F,
    material: M,
    policy: P,
    table: F::PerBond<M::BondConst>,
    bits: Option<F::Bits>,
    node_const: Field<T, M::NodeConst>,
    family_const: Field<T, M::FamilyConst>,
    node_state: Field<T, M::NodeState>,
    criterion_const: Field<T, P::NodeConst>,
    criterion_value: Field<T, P::NodeValue>,
    u: Field<T, SVector<T, D>>,
    v: Field<T, SVector<T, D>>,
    force: Field<T, SVector<T, D>>,
    inverse_mass: InverseMass<T>,
    /// Volume of the reference families, where cut bonds have left them.
    reference_volume: Option<Vec<f64>>,
    /// Members of one node: kept so that a step that breaks bonds does not allocate.
    members: Vec<Member<M::BondConst, D>>,
    thickness: f64,
    broken: usize,
    worst: f64,
}

/// 1/(ρ Δx²), which turns a force density into an acceleration in units of Δx.
enum InverseMass<T> {
    Uniform(T),
    PerSite(Vec<T>),
}

impl<T: Real> InverseMass<T> {
    fn new<const D: usize>(
        family: &impl Family<T, D>,
        density: &dyn Fn(usize) -> f64,
    ) -> Result<Self> {
        let unit2 = family.unit().powi(2);
        let inverse = |node: usize| -> Result<T> {
            let rho = Error::positive("density ρ [kg/m³]", density(node))?;
            Ok(T::of(1.0 / (rho * unit2)))
        };
        let first = inverse(0)?;
        let mut per_site = vec![first; family.sites()];
        let mut uniform = true;
        for node in 1..family.nodes() {
            let value = inverse(node)?;
            uniform &= value == first;
            per_site[family.site(node)] = value;
        }
        Ok(if uniform { Self::Uniform(first) } else { Self::PerSite(per_site) })
    }
}

/// The strain pass: family sums into node states. It finds the largest t where the material looks at
/// stretches anyway, or if it is to TRACK it.
struct StrainKernel<'a, M, const TRACK: bool>(&'a M);

impl<T: Real, const D: usize, M: Material<T, D>, const TRACK: bool> BondKernel<T, D>
    for StrainKernel<'_, M, TRACK>
{
    type Const = M::BondConst;
    type Node = M::NodeConst;
    type Own = M::FamilyConst;
    type Sum = M::FamilySum;
    type Out = M::NodeState;
    const STRETCH: bool = M::STRETCH;
    const TRACK: bool = M::STRETCH || TRACK;

    #[inline(always)]
    fn add(
        &self,
        sum: &mut M::FamilySum,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, M::BondConst>,
        nodes: [&M::NodeConst; 2],
    ) {
        let end =
            End { bond: pair.constants[0], node: nodes[0], state: &(), volume: pair.volumes[0] };
        self.0.add_bond(sum, bond, end);
    }
    #[inline(always)]
    fn close(
        &self,
        sum: &M::FamilySum,
        node: &M::NodeConst,
        own: &M::FamilyConst,
        previous: M::NodeState,
    ) -> M::NodeState {
        self.0.node_state(sum, node, own, &previous)
    }
}

/// The force pass: pair forces into force densities.
struct ForceKernel<'a, M, const TRACK: bool>(&'a M);

#[inline(always)]
fn ends<'a, T: Real, const D: usize, M: Material<T, D>>(
    pair: Pair<'a, T, M::BondConst>,
    nodes: [&'a (M::NodeConst, M::NodeState); 2],
) -> [End<'a, T, M::BondConst, M::NodeConst, M::NodeState>; 2] {
    let [k0, k1] = pair.constants;
    let [v0, v1] = pair.volumes;
    [
        End { bond: k0, node: &nodes[0].0, state: &nodes[0].1, volume: v0 },
        End { bond: k1, node: &nodes[1].0, state: &nodes[1].1, volume: v1 },
    ]
}

impl<T: Real, const D: usize, M: Material<T, D>, const TRACK: bool> BondKernel<T, D>
    for ForceKernel<'_, M, TRACK>
{
    type Const = M::BondConst;
    type Node = (M::NodeConst, M::NodeState);
    type Own = ();
    type Sum = SVector<T, D>;
    type Out = SVector<T, D>;
    const STRETCH: bool = M::STRETCH;
    const TRACK: bool = M::STRETCH || TRACK;

    #[inline(always)]
    fn add(
        &self,
        sum: &mut SVector<T, D>,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, M::BondConst>,
        nodes: [&Self::Node; 2],
    ) {
        self.0.add_pair_force(sum, bond, ends::<T, D, M>(pair, nodes));
    }
    #[inline(always)]
    fn close(
        &self,
        sum: &SVector<T, D>,
        (constants, state): &Self::Node,
        (): &(),
        _: SVector<T, D>,
    ) -> SVector<T, D> {
        sum + self.0.node_force(constants, state)
    }
}

/// The energy pass: W at every node.
struct EnergyKernel<'a, M>(&'a M);

impl<T: Real, const D: usize, M: StrainEnergy<T, D>> BondKernel<T, D> for EnergyKernel<'_, M> {
    type Const = M::BondConst;
    type Node = (M::NodeConst, M::NodeState);
    type Own = ();
    type Sum = T;
    type Out = T;
    const STRETCH: bool = M::STRETCH;

    #[inline(always)]
    fn add(
        &self,
        sum: &mut T,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, M::BondConst>,
        nodes: [&Self::Node; 2],
    ) {
        let [end, _] = ends::<T, D, M>(pair, nodes);
        *sum += self.0.bond_energy(bond, end) * end.volume;
    }
    #[inline(always)]
    fn close(&self, sum: &T, (constants, state): &Self::Node, (): &(), _: T) -> T {
        *sum + self.0.node_energy(constants, state)
    }
}

impl<T, const D: usize, F, M, P> Body<T, D, F, M, P>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    /// A body at rest in its reference configuration.
    ///
    /// # Errors
    /// [`Error::EmptyFamily`] for a node without neighbours, [`Error::InvalidValue`] for a density
    /// that is not positive, and what the material, the cracks and the policy refuse.
    pub fn new(family: F, material: M, policy: P) -> Result<Self> {
        let (nodes, sites) = (family.nodes(), family.sites());
        policy.validate(nodes)?;
        let table = family.per_bond(&|xi, scale| material.bond_const(xi, scale));
        let cracks = policy.cracks();
        let mut bits = P::BITS.then(|| family.intact(&|node| policy.can_break(node)));
        let mut reference_volume = None;
        if let Some(bits) = &mut bits {
            for crack in &cracks.surfaces {
                check_clear_of(&family, crack.as_ref())?;
                let cuts =
                    |a: usize, b: usize| crack.cuts(&family.position(a), &family.position(b));
                family.cut(bits, &cuts);
            }
            if cracks.leave_family {
                let volume = |node| family_volume(&family, node, Some(bits)).1;
                reference_volume = Some((0..nodes).map(volume).collect());
            }
        }

        let mut criterion_const = Field::zeros(if P::ACTIVE { sites } else { 0 });
        if P::NodeConst::LEN > 0 {
            for node in 0..nodes {
                criterion_const.set(family.site(node), policy.node_const(node, family.scale(node)));
            }
        }
        let inverse_mass = InverseMass::new(&family, &|node| material.density(node))?;

        let mut body = Self {
            node_const: Field::zeros(sites),
            family_const: Field::zeros(sites),
            node_state: Field::zeros(sites),
            criterion_const,
            criterion_value: Field::zeros(if P::ACTIVE { sites } else { 0 }),
            u: Field::zeros(sites),
            v: Field::zeros(sites),
            force: Field::zeros(sites),
            family,
            material,
            policy,
            table,
            bits,
            inverse_mass,
            reference_volume,
            members: Vec::new(),
            thickness: 1.0,
            broken: 0,
            worst: 0.0,
        };
        body.set_node_constants()?;
        if P::ACTIVE {
            body.isolate_detached()?;
        } else if let Some(bits) = &mut body.bits {
            F::clear_marks(bits);
        }
        Ok(body)
    }

    /// Thickness h of a 2D body in metres, for energies and total forces.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive, or in 3D.
    pub fn with_thickness(mut self, thickness: f64) -> Result<Self> {
        Error::check(D == 2, "thickness [m]", thickness, "given for 2D bodies only")?;
        self.thickness = Error::positive("thickness [m]", thickness)?;
        Ok(self)
    }

    fn set_node_constants(&mut self) -> Result<()> {
        let Self { family, material, table, bits, policy, .. } = self;
        // Bonds that have left the family count nowhere; other cut bonds count like bonds that
        // break later: only for a material that follows damage.
        let live =
            if M::FOLLOWS_DAMAGE || policy.cracks().leave_family { bits.as_ref() } else { None };
        let of_node = |node, members: &mut Vec<_>| {
            family.members(node, table, None, members);
            if members.is_empty() {
                let position = family.position(node).iter().copied().collect();
                let horizon = family.scale(node).horizon * family.unit();
                return Err(Error::EmptyFamily { node, position, horizon });
            }
            if live.is_some() {
                family.members(node, table, live, members);
            }
            material.node_const(&Neighbourhood { node, scale: family.scale(node), members })
        };
        let pieces = map_pieces(family.nodes(), CHUNK, &|nodes| -> Result<Vec<_>> {
            let mut members = Vec::new();
            nodes.map(|node| of_node(node, &mut members)).collect()
        });
        let mut node = 0;
        for piece in pieces {
            for (value, own) in piece? {
                let site = self.family.site(node);
                self.node_const.set(site, value);
                self.family_const.set(site, own);
                node += 1;
            }
        }
        Ok(())
    }

    /// Nodes that the cracks, or the outline, leave without a shape tensor lose their bonds.
    fn isolate_detached(&mut self) -> Result<()> {
        if M::FOLLOWS_DAMAGE
            && let Some(mut bits) = self.bits.take()
        {
            self.isolate(&mut bits);
            self.bits = Some(bits);
        }
        self.follow_damage()?;
        self.clear_marks();
        Ok(())
    }

    /// Cuts the bonds of all detached nodes; returns how many were intact.
    fn isolate(&self, bits: &mut F::Bits) -> usize {
        let detached = |&node: &usize| self.material.detached(&self.family_constants(node));
        (0..self.nodes()).filter(detached).map(|node| self.family.isolate(bits, node)).sum()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.family.nodes()
    }
    /// The family.
    pub fn family(&self) -> &F {
        &self.family
    }
    /// The material.
    pub fn material(&self) -> &M {
        &self.material
    }
    /// The damage policy.
    pub fn policy(&self) -> &P {
        &self.policy
    }
    /// Reference position x of a node in metres.
    pub fn position(&self, node: usize) -> SVector<f64, D> {
        self.family.position(node)
    }
    /// Volume of a node in m³ (in 2D area times thickness).
    pub fn volume(&self, node: usize) -> f64 {
        self.family.volume(node) * self.thickness
    }
    /// Mass of a node in kg.
    pub fn mass(&self, node: usize) -> f64 {
        self.material.density(node) * self.volume(node)
    }
    fn metres(&self, field: &Field<T, SVector<T, D>>, node: usize) -> SVector<f64, D> {
        field.get(self.family.site(node)).map(|x| x.to_f64() * self.family.unit())
    }
    /// Displacement u of a node in metres.
    pub fn displacement(&self, node: usize) -> SVector<f64, D> {
        self.metres(&self.u, node)
    }
    /// Velocity v of a node in m/s.
    pub fn velocity(&self, node: usize) -> SVector<f64, D> {
        self.metres(&self.v, node)
    }
    /// Force density f of a node in N/m³, of the last evaluation (loads included).
    pub fn force_density(&self, node: usize) -> SVector<f64, D> {
        self.force.get(self.family.site(node)).map(|x| x.to_f64() / self.family.unit())
    }
    /// Constants of a node, lengths in units of Δx.
    pub fn constants(&self, node: usize) -> M::NodeConst {
        self.node_const.get(self.family.site(node))
    }
    /// What else the state of a node is made from, lengths in units of Δx.
    pub fn family_constants(&self, node: usize) -> M::FamilyConst {
        self.family_const.get(self.family.site(node))
    }
    /// State of a node of the last evaluation, lengths in units of Δx.
    pub fn state(&self, node: usize) -> M::NodeState {
        self.node_state.get(self.family.site(node))
    }
    /// The criterion's value at a node of the last test.
    pub fn criterion_value(&self, node: usize) -> P::NodeValue {
        self.criterion_value.get(self.family.site(node))
    }
    /// Sets the displacement of a node in metres.
    pub fn set_displacement_of(&mut self, node: usize, u: &SVector<f64, D>) {
        self.u.set(self.family.site(node), (u / self.family.unit()).map(T::of));
    }
    /// Sets the velocity of a node in m/s.
    pub fn set_velocity_of(&mut self, node: usize, v: &SVector<f64, D>) {
        self.v.set(self.family.site(node), (v / self.family.unit()).map(T::of));
    }
    /// Sets the displacement of every node from its reference position, both in metres.
    pub fn set_displacement(&mut self, u: impl Fn(&SVector<f64, D>) -> SVector<f64, D>) {
        (0..self.nodes()).for_each(|i| self.set_displacement_of(i, &u(&self.position(i))));
    }
    /// Sets the velocity of every node from its reference position, in m/s and metres.
    pub fn set_velocity(&mut self, v: impl Fn(&SVector<f64, D>) -> SVector<f64, D>) {
        (0..self.nodes()).for_each(|i| self.set_velocity_of(i, &v(&self.position(i))));
    }

    /// Number of undirected bonds broken since the start (pre-cracks do not count).
    pub fn broken_bonds(&self) -> usize {
        self.broken
    }
    /// The largest failure index met so far: "no bond broke; the worst reached 0.83".
    pub fn worst_index(&self) -> f64 {
        self.worst
    }
    /// Damage index φ = 1 − Σ μV / ΣV of a node.
    pub fn damage(&self, node: usize) -> f64 {
        let Some(bits) = &self.bits else { return 0.0 };
        let (all, intact) = family_volume(&self.family, node, Some(bits));
        let reference = self.reference_volume.as_ref().map_or(all, |volumes| volumes[node]);
        if reference > 0.0 { 1.0 - intact / reference } else { 1.0 }
    }
    /// Visits the neighbours of a node, broken ones too.
    pub fn neighbours(&self, node: usize, mut visit: impl FnMut(crate::family::Neighbour<D>)) {
        self.family.neighbours(node, self.bits.as_ref(), &mut visit);
    }
    /// Bytes held per part: what a scene does not need is 0.
    pub fn memory(&self) -> Memory {
        Memory {
            family: self.family.bytes(),
            bond_constants: F::per_bond_bytes(&self.table),
            bond_bits: self.bits.as_ref().map_or(0, F::bits_bytes),
            node_constants: self.node_const.bytes() + self.family_const.bytes(),
            node_states: self.node_state.bytes(),
            criterion: self.criterion_const.bytes() + self.criterion_value.bytes(),
            motion: self.u.bytes() + self.v.bytes() + self.force.bytes(),
            density: match &self.inverse_mass {
                InverseMass::Uniform(_) => 0,
                InverseMass::PerSite(values) => values.capacity() * size_of::<T>(),
            },
        }
    }

    /// Stress Σ T⟨ξ⟩⊗ξ βV in Pa that the intact family of a node has under the homogeneous
    /// displacement gradient `h`, u = H x. It does not depend on the body's displacements, nor
    /// changes them. For an elastic material it is ∂W/∂H.
    pub fn stress_under(&self, node: usize, h: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
        let mut members = Vec::new();
        self.family.members(node, &self.table, self.bits.as_ref(), &mut members);
        let (constants, of_family) = (self.constants(node), self.family_constants(node));
        let bond = |xi: &SVector<f64, D>| Bond::new(xi.map(T::of), (h * xi).map(T::of));
        let mut sum = M::FamilySum::zero();
        for m in &members {
            let volume = T::of(m.volume);
            let end = End { bond: &m.bond, node: &constants, state: &(), volume };
            self.material.add_bond(&mut sum, &bond(&m.xi), end);
        }
        let state = self.material.node_state(&sum, &constants, &of_family, &Record::zero());
        members.iter().fold(SMatrix::zeros(), |stress, m| {
            let volume = T::of(m.volume);
            let end = End { bond: &m.bond, node: &constants, state: &state, volume };
            let force = self.material.force_state(&bond(&m.xi), end).map(Real::to_f64);
            stress + force * m.xi.transpose() * m.volume
        })
    }

    /// Node states from family sums; returns the largest t ([`BondKernel::TRACK`]).
    fn update_states<const TRACK: bool>(&mut self, visit: Visit) -> T {
        if M::NodeState::LEN == 0 {
            return T::zero();
        }
        self.family.sweep(
            &StrainKernel::<M, TRACK>(&self.material),
            &self.table,
            self.bits.as_ref(),
            visit,
            &self.u,
            (&self.node_const, &self.family_const),
            &mut self.node_state,
        )
    }
    /// Force densities from node states; returns the largest t ([`BondKernel::TRACK`]).
    fn update_forces<const TRACK: bool>(&mut self, visit: Visit) -> T {
        self.family.sweep(
            &ForceKernel::<M, TRACK>(&self.material),
            &self.table,
            self.bits.as_ref(),
            visit,
            &self.u,
            ((&self.node_const, &self.node_state), ()),
            &mut self.force,
        )
    }
    /// As [`update_states`](Self::update_states), also with stretches a linear material ignores.
    fn update_states_and(&mut self, track: bool) -> T {
        if Self::CAN_TRACK && track {
            return self.update_states::<true>(Visit::All);
        }
        self.update_states::<false>(Visit::All)
    }
    /// As [`update_forces`](Self::update_forces), also with stretches a linear material ignores.
    fn update_forces_and(&mut self, track: bool) -> T {
        if Self::CAN_TRACK && track {
            return self.update_forces::<true>(Visit::All);
        }
        self.update_forces::<false>(Visit::All)
    }
    fn find_fault(&self) -> Result<()> {
        if M::CAN_FAULT {
            for node in 0..self.nodes() {
                if let Some(det) = self.material.fault(&self.state(node)) {
                    return Err(Error::Inverted { node, det });
                }
            }
        }
        Ok(())
    }
    /// True if the force of a bond depends on nothing but the bond: then forces come before the
    /// test, which they may spare, and again at the nodes that lost a bond.
    const FORCES_FIRST: bool = <M::NodeState as Record<T>>::LEN == 0 && !M::FOLLOWS_DAMAGE;

    /// True if stretches are to be found for the test of bonds that the material does not look at
    /// (a constant of its own, so that kernels nobody needs are not compiled).
    const CAN_TRACK: bool = P::ACTIVE && !M::STRETCH;

    /// Tests all bonds, breaks those that fail and follows the damage.
    fn break_bonds(&mut self, events: &mut dyn BreakEvents<Self>) -> Result<Tally> {
        events.before(self);
        let mut tally = Tally::default();
        if let Some(bits) = &mut self.bits {
            tally = self.policy.check(Check {
                family: &self.family,
                material: &self.material,
                table: &self.table,
                bits,
                u: &self.u,
                node_const: &self.node_const,
                node_state: &self.node_state,
                constants: &self.criterion_const,
                values: &mut self.criterion_value,
            });
        }
        self.worst = self.worst.max(tally.worst);
        if tally.broken > 0 {
            events.broke(self);
            tally.broken += self.follow_damage()?;
            self.broken += tally.broken;
            events.after(self, tally);
            self.clear_marks();
        }
        Ok(tally)
    }
    /// Node constants and states of the nodes that lost a bond, which stay marked. Nodes that are
    /// detached by it lose their other bonds too; returns how many.
    fn follow_damage(&mut self) -> Result<usize> {
        let Some(mut bits) = self.bits.take() else { return Ok(0) };
        let lost = if M::FOLLOWS_DAMAGE { self.follow_constants(&mut bits) } else { Ok(0) };
        self.bits = Some(bits);
        let lost = lost?;
        self.update_states::<false>(Visit::Marked);
        if Self::FORCES_FIRST {
            self.update_forces::<false>(Visit::Marked);
        }
        Ok(lost)
    }
    fn clear_marks(&mut self) {
        if let Some(bits) = &mut self.bits {
            F::clear_marks(bits);
        }
    }
    fn follow_constants(&mut self, bits: &mut F::Bits) -> Result<usize> {
        let mut total = 0;
        loop {
            let Self { family, material, table, node_const, family_const, members, .. } = self;
            let (mut detached, mut result) = (false, Ok(()));
            family.marked(bits, &mut |node| {
                family.members(node, table, Some(bits), members);
                let scale = family.scale(node);
                match material.node_const(&Neighbourhood { node, scale, members }) {
                    Ok((value, own)) => {
                        detached |= material.detached(&own);
                        node_const.set(family.site(node), value);
                        family_const.set(family.site(node), own);
                    }
                    Err(error) => result = Err(error),
                }
            });
            result?;
            let lost = if detached { self.isolate(bits) } else { 0 };
            if lost == 0 {
                return Ok(total);
            }
            total += lost;
        }
    }
    /// Cuts every bond that crosses `crack`, now; returns how many were intact.
    ///
    /// # Errors
    /// [`Error::NoBits`] for a body without damage, and a crack through a node.
    pub fn cut(&mut self, crack: &dyn crate::crack::CrackSurface<D>) -> Result<usize> {
        let Self { family, bits, .. } = self;
        let bits = bits.as_mut().ok_or(Error::NoBits)?;
        check_clear_of(family, crack)?;
        let count = family.cut(bits, &|a, b| crack.cuts(&family.position(a), &family.position(b)));
        let lost = self.follow_damage()?;
        self.clear_marks();
        Ok(count + lost)
    }
}

fn check_clear_of<T: Real, const D: usize>(
    family: &impl Family<T, D>,
    crack: &dyn crate::crack::CrackSurface<D>,
) -> Result<()> {
    let positions = (0..family.nodes()).map(|node| family.position(node));
    crate::crack::check_clear(crack, positions, family.unit())
}

/// Σ βV over the family of a node: all bonds, and the intact ones.
fn family_volume<T: Real, const D: usize, F: Family<T, D>>(
    family: &F,
    node: usize,
    bits: Option<&F::Bits>,
) -> (f64, f64) {
    let (mut all, mut intact) = (0.0, 0.0);
    family.neighbours(node, bits, &mut |n| {
        all += n.volume;
        intact += if n.intact { n.volume } else { 0.0 };
    });
    (all, intact)
}

impl<T, const D: usize, F, M, P> Body<T, D, F, M, P>
where
    T: Real,
    F: Family<T, D>,
    M: StrainEnergy<T, D>,
    P: DamagePolicy<T, D, M>,
{
    /// Strain energy density W of every node in Pa, for the current displacements and the states
    /// of the last evaluation.
    pub fn energy_densities(&self) -> Vec<f64> {
        let mut out: Field<T, T> = Field::zeros(self.family.sites());
        self.family.sweep(
            &EnergyKernel(&self.material),
            &self.table,
            self.bits.as_ref(),
            Visit::All,
            &self.u,
            ((&self.node_const, &self.node_state), ()),
            &mut out,
        );
        (0..self.nodes()).map(|node| out.get(self.family.site(node)).to_f64()).collect()
    }
    /// Strain energy in J (per metre of thickness in 2D unless a thickness is given).
    pub fn strain_energy(&self) -> f64 {
        let densities = self.energy_densities();
        sum_in_order(densities.len(), |i| densities[i] * self.volume(i))
    }
}

impl<T, const D: usize, F, M, P> Body<T, D, F, M, P>
where
    T: Real,
    F: Family<T, D>,
    M: StressState<T, D>,
    P: DamagePolicy<T, D, M>,
{
    /// Cauchy stress σ of a node in Pa, of the last evaluation.
    pub fn stress(&self, node: usize) -> SMatrix<f64, D, D> {
        self.material.stress(&self.constants(node), &self.state(node)).map(Real::to_f64)
    }
}

/// Bytes held by the parts of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    /// Neighbours, positions, volumes.
    pub family: usize,
    /// Constants per offset or bond.
    pub bond_constants: usize,
    /// Intact bits (0 without damage).
    pub bond_bits: usize,
    /// Constants per node (0 for bond-based materials).
    pub node_constants: usize,
    /// States per node (0 for bond-based materials).
    pub node_states: usize,
    /// Constants and values of the criterion.
    pub criterion: usize,
    /// Displacement, velocity and force.
    pub motion: usize,
    /// Densities (0 if they are all the same).
    pub density: usize,
}

impl Memory {
    /// All parts together.
    pub fn total(&self) -> usize {
        self.family
            + self.bond_constants
            + self.bond_bits
            + self.node_constants
            + self.node_states
            + self.criterion
            + self.motion
            + self.density
    }
}

/// What time integrators and observers need of a body, whatever it is made of.
pub trait Dynamics<T: Real, const D: usize> {
    /// Number of nodes.
    fn nodes(&self) -> usize;
    /// Place of a node in the arrays.
    fn site(&self, node: usize) -> usize;
    /// The unit of length Δx in metres: arrays hold lengths divided by it.
    fn unit(&self) -> f64;
    /// Largest horizon in units of Δx.
    fn horizon(&self) -> f64;
    /// Reference position of a node in metres.
    fn position(&self, node: usize) -> SVector<f64, D>;
    /// Volume of a node in m³.
    fn volume(&self, node: usize) -> f64;
    /// Mass of a node in kg.
    fn mass(&self, node: usize) -> f64;
    /// Damage index φ of a node.
    fn damage(&self, node: usize) -> f64;
    /// Bonds broken since the start.
    fn broken_bonds(&self) -> usize;
    /// Largest failure index so far.
    fn worst_index(&self) -> f64;
    /// Visits the neighbours of a node, broken ones too.
    fn visit_neighbours(&self, node: usize, visit: &mut dyn FnMut(crate::family::Neighbour<D>));
    /// Displacements in units of Δx.
    fn u(&self) -> &Field<T, SVector<T, D>>;
    /// Displacements in units of Δx.
    fn u_mut(&mut self) -> &mut Field<T, SVector<T, D>>;
    /// Velocities in Δx/s.
    fn v(&self) -> &Field<T, SVector<T, D>>;
    /// Velocities in Δx/s.
    fn v_mut(&mut self) -> &mut Field<T, SVector<T, D>>;
    /// Force densities in Pa/Δx.
    fn force(&self) -> &Field<T, SVector<T, D>>;
    /// Force densities in Pa/Δx.
    fn force_mut(&mut self) -> &mut Field<T, SVector<T, D>>;
    /// v += dt f/ρ.
    fn kick(&mut self, dt: f64);
    /// u += dt v.
    fn drift(&mut self, dt: f64);
    /// Node states and force densities of the current displacements; no bond is tested.
    ///
    /// # Errors
    /// [`Error::Inverted`].
    fn evaluate(&mut self) -> Result<()>;
    /// As [`evaluate`](Self::evaluate), with a test of all bonds between states and forces if
    /// `step` is a multiple of the policy's cadence; nodes that lost a bond are folded again, so
    /// that forces never lag behind damage.
    ///
    /// # Errors
    /// [`Error::Inverted`], and what the material refuses about a damaged family.
    fn evaluate_and_break(
        &mut self,
        step: usize,
        events: &mut dyn BreakEvents<Self>,
    ) -> Result<Tally>;
    /// True if bonds can break.
    fn can_break(&self) -> bool;
    /// Acceleration of force density 1 at a site, 1/(ρ Δx²).
    fn inverse_mass(&self, site: usize) -> T;
    /// True if forces are exactly linear in the displacements ([`Material::LINEAR`]).
    fn is_linear(&self) -> bool;
    /// −∂f_i/∂u_i of every site i about the reference configuration, in Pa/Δx².
    fn diagonal_blocks(&self) -> Field<T, SMatrix<T, D, D>>;
    /// Writes all that changes during a run.
    ///
    /// # Errors
    /// What the writer reports.
    fn save(&self, state: &mut StateWriter<'_>) -> std::io::Result<()>;
    /// Takes back what [`save`](Self::save) wrote; on an error the body is as before.
    ///
    /// # Errors
    /// [`Error::State`] for a state of another body.
    fn restore(&mut self, state: &mut StateReader<'_>) -> Result<()>;
}

/// What breaking bonds costs: the strain energy that the nodes which lost bonds had before, less
/// the one they have after. Works only where and when bonds break.
///
/// A bond is found broken at the end of a step, at u₁, and does not pull in the half kick that
/// follows. With D(u) the energy that goes with the bonds, the motion misses the work ½D'(u₁)Δu of
/// that half kick, so breaking took D(u₁) − ½D'(u₁)Δu; for a quadratic D that is
/// 2D(u₀ + ½Δu) − ½D(u₀) − ½D(u₁). Counting D(u₁) would be wrong by the order of Δt (8 % of the
/// work in `tests/fracture/energy_of_fracture.rs`).
pub(crate) struct Dissipation<T, const D: usize, F, M>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
{
    /// Bits as they were before the last bond broke.
    bits: Option<F::Bits>,
    node_const: Field<T, M::NodeConst>,
    family_const: Field<T, M::FamilyConst>,
    node_state: Field<T, M::NodeState>,
    u: Field<T, SVector<T, D>>,
    density: Field<T, T>,
    /// Δt in seconds.
    dt: f64,
    /// Energy dissipated so far, in J.
    total: f64,
}

impl<T, const D: usize, F, M> Default for Dissipation<T, D, F, M>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
{
    fn default() -> Self {
        Self {
            bits: None,
            node_const: Field::zeros(0),
            family_const: Field::zeros(0),
            node_state: Field::zeros(0),
            u: Field::zeros(0),
            density: Field::zeros(0),
            dt: 0.0,
            total: 0.0,
        }
    }
}

/// A [`BreakEvents`] that knows what was dissipated.
pub(crate) trait Dissipated<B>: BreakEvents<B> {
    /// The step that comes takes Δt.
    fn start(&mut self, dt: f64);
    /// In J since the start.
    fn total(&self) -> f64;
    /// Goes on from a total in J.
    fn resume(&mut self, total: f64);
}

impl<T, const D: usize, F, M, P> Dissipated<Body<T, D, F, M, P>> for Dissipation<T, D, F, M>
where
    T: Real,
    F: Family<T, D>,
    M: StrainEnergy<T, D>,
    P: DamagePolicy<T, D, M>,
{
    fn start(&mut self, dt: f64) {
        self.dt = dt;
    }
    fn total(&self) -> f64 {
        self.total
    }
    fn resume(&mut self, total: f64) {
        self.total = total;
    }
}

impl<T, const D: usize, F, M> Dissipation<T, D, F, M>
where
    T: Real,
    F: Family<T, D>,
    M: StrainEnergy<T, D>,
{
    /// Energy in J of the nodes marked in `bits`, at the displacements `self.u`.
    fn energy<P: DamagePolicy<T, D, M>>(
        &mut self,
        body: &Body<T, D, F, M, P>,
        bits: &F::Bits,
        constants: (&Field<T, M::NodeConst>, &Field<T, M::FamilyConst>),
    ) -> f64 {
        let (family, table) = (&body.family, &body.table);
        let kernel = StrainKernel::<M, false>(&body.material);
        let bits = Some(bits);
        if M::NodeState::LEN > 0 {
            let out = &mut self.node_state;
            family.sweep(&kernel, table, bits, Visit::Marked, &self.u, constants, out);
        }
        let kernel = EnergyKernel(&body.material);
        let input = ((constants.0, &self.node_state), ());
        family.sweep(&kernel, table, bits, Visit::Marked, &self.u, input, &mut self.density);
        let mut sum = 0.0;
        if let Some(bits) = bits {
            family.marked(bits, &mut |node| {
                sum += self.density.get(family.site(node)).to_f64() * body.volume(node);
            });
        }
        sum
    }
}

impl<T, const D: usize, F, M, P> BreakEvents<Body<T, D, F, M, P>> for Dissipation<T, D, F, M>
where
    T: Real,
    F: Family<T, D>,
    M: StrainEnergy<T, D>,
    P: DamagePolicy<T, D, M>,
{
    fn before(&mut self, body: &Body<T, D, F, M, P>) {
        if self.bits.is_none() {
            self.bits = body.bits.as_ref().map(F::copy_bits);
        }
    }
    fn broke(&mut self, body: &Body<T, D, F, M, P>) {
        self.node_state.clone_from(&body.node_state);
        if M::FOLLOWS_DAMAGE {
            self.node_const.clone_from(&body.node_const);
            self.family_const.clone_from(&body.family_const);
        }
    }
    fn after(&mut self, body: &Body<T, D, F, M, P>, _: Tally) {
        let (Some(mut before), Some(bits)) = (self.bits.take(), &body.bits) else { return };
        F::copy_marks(&mut before, bits);
        if self.density.is_empty() {
            self.density = Field::zeros(body.family.sites());
        }
        let constants = std::mem::replace(&mut self.node_const, Field::zeros(0));
        let of_family = std::mem::replace(&mut self.family_const, Field::zeros(0));
        let now = (&body.node_const, &body.family_const);
        let then = if M::FOLLOWS_DAMAGE { (&constants, &of_family) } else { now };
        for (back, weight) in [(0.0, -0.5), (0.5, 2.0), (1.0, -0.5)] {
            self.u.clone_from(&body.u);
            axpy(self.u.as_mut_slice(), T::of(-back * self.dt), body.v.as_slice());
            let held = self.energy(body, &before, then) - self.energy(body, bits, now);
            self.total += weight * held;
        }
    }
}

/// Called around the breaking of bonds, to account for what it dissipates.
pub trait BreakEvents<B: ?Sized> {
    /// Bonds are about to be tested.
    fn before(&mut self, body: &B);
    /// Bonds broke; constants and states of nodes are still those of before.
    fn broke(&mut self, body: &B);
    /// Constants and states are those of the damaged body. Nodes that lost a bond are marked.
    fn after(&mut self, body: &B, tally: Tally);
}

impl<B: ?Sized> BreakEvents<B> for () {
    fn before(&mut self, _: &B) {}
    fn broke(&mut self, _: &B) {}
    fn after(&mut self, _: &B, _: Tally) {}
}

impl<T, const D: usize, F, M, P> Dynamics<T, D> for Body<T, D, F, M, P>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    fn nodes(&self) -> usize {
        self.family.nodes()
    }
    fn site(&self, node: usize) -> usize {
        self.family.site(node)
    }
    fn unit(&self) -> f64 {
        self.family.unit()
    }
    fn horizon(&self) -> f64 {
        (0..self.nodes()).map(|node| self.family.scale(node).horizon).fold(0.0, f64::max)
    }
    fn position(&self, node: usize) -> SVector<f64, D> {
        self.family.position(node)
    }
    fn volume(&self, node: usize) -> f64 {
        Body::volume(self, node)
    }
    fn mass(&self, node: usize) -> f64 {
        Body::mass(self, node)
    }
    fn damage(&self, node: usize) -> f64 {
        Body::damage(self, node)
    }
    fn broken_bonds(&self) -> usize {
        self.broken
    }
    fn worst_index(&self) -> f64 {
        self.worst
    }
    fn visit_neighbours(&self, node: usize, visit: &mut dyn FnMut(crate::family::Neighbour<D>)) {
        self.family.neighbours(node, self.bits.as_ref(), visit);
    }
    fn u(&self) -> &Field<T, SVector<T, D>> {
        &self.u
    }
    fn u_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        &mut self.u
    }
    fn v(&self) -> &Field<T, SVector<T, D>> {
        &self.v
    }
    fn v_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        &mut self.v
    }
    fn force(&self) -> &Field<T, SVector<T, D>> {
        &self.force
    }
    fn force_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        &mut self.force
    }
    fn kick(&mut self, dt: f64) {
        let dt = T::of(dt);
        match &self.inverse_mass {
            InverseMass::Uniform(w) => {
                axpy(self.v.as_mut_slice(), dt * *w, self.force.as_slice());
            }
            InverseMass::PerSite(w) => {
                axpy_weighted(self.v.as_mut_slice(), dt, w, self.force.as_slice());
            }
        }
    }
    fn drift(&mut self, dt: f64) {
        axpy(self.u.as_mut_slice(), T::of(dt), self.v.as_slice());
    }
    fn evaluate(&mut self) -> Result<()> {
        self.update_states::<false>(Visit::All);
        self.find_fault()?;
        self.update_forces::<false>(Visit::All);
        Ok(())
    }
    fn evaluate_and_break(
        &mut self,
        step: usize,
        events: &mut dyn BreakEvents<Self>,
    ) -> Result<Tally> {
        let test = P::ACTIVE && step.is_multiple_of(self.policy.every());
        let per_t = if test { self.policy.per_square_strain() } else { None };
        let track = per_t.is_some();
        let mut t = self.update_states_and(track);
        self.find_fault()?;
        if Self::FORCES_FIRST {
            t = self.update_forces_and(track);
        }
        let mut tally = Tally::default();
        if test {
            // The largest index, if the sweep so far tells it.
            let known = per_t.map(|per_t| t * per_t);
            if let Some(worst) = known.filter(|worst| *worst <= T::one()) {
                self.worst = self.worst.max(worst.to_f64());
                tally.worst = worst.to_f64();
            } else {
                tally = self.break_bonds(events)?;
            }
        }
        if !Self::FORCES_FIRST {
            self.update_forces::<false>(Visit::All);
        }
        Ok(tally)
    }
    fn can_break(&self) -> bool {
        P::ACTIVE
    }
    fn inverse_mass(&self, site: usize) -> T {
        match &self.inverse_mass {
            InverseMass::Uniform(w) => *w,
            InverseMass::PerSite(w) => w[site],
        }
    }
    fn is_linear(&self) -> bool {
        M::LINEAR
    }
    fn diagonal_blocks(&self) -> Field<T, SMatrix<T, D, D>> {
        let constants = (&self.node_const, &self.family_const);
        let bits = self.bits.as_ref();
        crate::diagonal::blocks(&self.family, &self.material, &self.table, bits, constants)
    }
    fn save(&self, state: &mut StateWriter<'_>) -> std::io::Result<()> {
        state.counts("body", &[self.nodes(), self.family.bonds(), size_of::<T>()])?;
        state.numbers("displacements", self.u.as_slice())?;
        state.numbers("velocities", self.v.as_slice())?;
        state.numbers("forces", self.force.as_slice())?;
        state.numbers("node states", self.node_state.as_slice())?;
        state.numbers("values of the criterion", self.criterion_value.as_slice())?;
        if M::FOLLOWS_DAMAGE {
            state.numbers("node constants", self.node_const.as_slice())?;
            state.numbers("family constants", self.family_const.as_slice())?;
        }
        state.bytes("bonds", &self.bits.as_ref().map_or_else(Vec::new, F::bits_as_bytes))?;
        state.counts("broken bonds", &[self.broken])?;
        state.numbers("worst index", &[self.worst])
    }
    fn restore(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let here = [self.nodes(), self.family.bonds(), size_of::<T>()];
        let there: [usize; 3] = state.counts("body")?;
        if there != here {
            let told = |[nodes, bonds, bytes]: [usize; 3]| {
                format!("{nodes} nodes, {bonds} bonds and numbers of {bytes} bytes")
            };
            let reason = format!("has {}, the body here {}", told(there), told(here));
            return Err(unlike("body", reason));
        }
        let u = state.field("displacements", &self.u)?;
        let v = state.field("velocities", &self.v)?;
        let force = state.field("forces", &self.force)?;
        let node_state = state.field("node states", &self.node_state)?;
        let criterion_value = state.field("values of the criterion", &self.criterion_value)?;
        let constants = if M::FOLLOWS_DAMAGE {
            let node = state.field("node constants", &self.node_const)?;
            Some((node, state.field("family constants", &self.family_const)?))
        } else {
            None
        };
        let bytes = state.bytes("bonds")?;
        let bits = match &self.bits {
            Some(_) => self.family.bits_from_bytes(bytes).map(Some),
            None => bytes.is_empty().then_some(None),
        };
        let bits = bits.ok_or_else(|| unlike("bonds", "are not those of this body".to_owned()))?;
        let [broken] = state.counts("broken bonds")?;
        let worst: Vec<f64> = state.numbers("worst index", 1)?;
        if let Some((node, family)) = constants {
            (self.node_const, self.family_const) = (node, family);
        }
        (self.u, self.v, self.force) = (u, v, force);
        (self.node_state, self.criterion_value) = (node_state, criterion_value);
        (self.bits, self.broken, self.worst) = (bits, broken, worst[0]);
        Ok(())
    }
}
