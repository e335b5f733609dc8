//! A body of every material, torn by every criterion that compiles with it, behind one interface:
//! what a test says of one of them it says of all, and the loops over bonds are compiled once.

use nalgebra::{SMatrix, SVector};
use pd_core::body::BreakEvents;
use pd_core::cloud::Cloud;
use pd_core::damage::{Breaking, DamageCriterion, DamagePolicy, TestedBond};
use pd_core::family::{Horizon, Neighbour, Tally};
use pd_core::field::Field;
use pd_core::influence::InfluenceFunction;
use pd_core::material::{EnergySplit, Material, StrainEnergy};
use pd_core::points::Points;
use pd_core::quadrature::Quadrature;
use pd_core::record::Record;
use pd_core::run::{Run, TimeStep};
use pd_core::statics::{Solved, Statics};
use pd_core::{Body, Dynamics, Family, Loads, Real, Result, StateReader, StateWriter};
use pd_damage::{
    BondEnergy, CrackOpening, CriticalStretch, ModeEnergies, PowerLaw, Separated, Strengths,
    TsaiHill, TsaiHill3,
};
use pd_models::{
    BondAssociated, Correspondence, Isotropic, LinearElastic, LinearSolid, MadenciOterkus,
    NeoHookean, Ordinary, PlaneMode, Pmb, PolynomialMicromoduli, PositiveSplit,
    SaintVenantKirchhoff, SillingControl, Stiffness, Strained, WanControl,
};

/// A body of any material, criterion and precision: what [`Dynamics`] and energies need, without
/// its type, so that runs and solvers are compiled once and not for every material.
trait Inner<T: Real, const D: usize> {
    fn dynamics(&self) -> Facts<'_, T, D>;
    fn horizon(&self) -> f64;
    fn u_mut(&mut self) -> &mut Field<T, SVector<T, D>>;
    fn v_mut(&mut self) -> &mut Field<T, SVector<T, D>>;
    fn force_mut(&mut self) -> &mut Field<T, SVector<T, D>>;
    fn place(&self, node: usize) -> (usize, SVector<f64, D>);
    fn size(&self, node: usize) -> (f64, f64);
    fn inverse_mass(&self, site: usize) -> T;
    fn damage(&self, node: usize) -> f64;
    fn neighbours(&self, node: usize, visit: &mut dyn FnMut(Neighbour<D>));
    fn kick(&mut self, dt: f64);
    fn drift(&mut self, dt: f64);
    fn evaluate(&mut self) -> Result<()>;
    fn evaluate_and_break(&mut self, step: usize) -> Result<Tally>;
    fn diagonal_blocks(&self) -> Field<T, SMatrix<T, D, D>>;
    fn energy_densities(&self) -> Vec<f64>;
}

/// What a body answers at once.
struct Facts<'a, T: Real, const D: usize> {
    nodes: usize,
    unit: f64,
    linear: bool,
    breaks: bool,
    broken: usize,
    worst: f64,
    u: &'a Field<T, SVector<T, D>>,
    v: &'a Field<T, SVector<T, D>>,
    force: &'a Field<T, SVector<T, D>>,
}

impl<T, const D: usize, F, M, P> Inner<T, D> for Body<T, D, F, M, P>
where
    T: Real,
    F: Family<T, D>,
    M: StrainEnergy<T, D>,
    P: DamagePolicy<T, D, M>,
{
    fn dynamics(&self) -> Facts<'_, T, D> {
        Facts {
            nodes: self.nodes(),
            unit: self.family().unit(),
            linear: M::LINEAR,
            breaks: P::ACTIVE,
            broken: self.broken_bonds(),
            worst: self.worst_index(),
            u: Dynamics::u(self),
            v: Dynamics::v(self),
            force: Dynamics::force(self),
        }
    }
    fn horizon(&self) -> f64 {
        Dynamics::horizon(self)
    }
    fn u_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        Dynamics::u_mut(self)
    }
    fn v_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        Dynamics::v_mut(self)
    }
    fn force_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        Dynamics::force_mut(self)
    }
    fn place(&self, node: usize) -> (usize, SVector<f64, D>) {
        (self.family().site(node), self.position(node))
    }
    fn size(&self, node: usize) -> (f64, f64) {
        (self.volume(node), self.mass(node))
    }
    fn inverse_mass(&self, site: usize) -> T {
        Dynamics::inverse_mass(self, site)
    }
    fn damage(&self, node: usize) -> f64 {
        Body::damage(self, node)
    }
    fn neighbours(&self, node: usize, visit: &mut dyn FnMut(Neighbour<D>)) {
        self.visit_neighbours(node, visit);
    }
    fn kick(&mut self, dt: f64) {
        Dynamics::kick(self, dt);
    }
    fn drift(&mut self, dt: f64) {
        Dynamics::drift(self, dt);
    }
    fn evaluate(&mut self) -> Result<()> {
        Dynamics::evaluate(self)
    }
    fn evaluate_and_break(&mut self, step: usize) -> Result<Tally> {
        Dynamics::evaluate_and_break(self, step, &mut ())
    }
    fn diagonal_blocks(&self) -> Field<T, SMatrix<T, D, D>> {
        Dynamics::diagonal_blocks(self)
    }
    fn energy_densities(&self) -> Vec<f64> {
        Body::energy_densities(self)
    }
}

/// See [`Inner`].
struct AnyBody<T, const D: usize>(Box<dyn Inner<T, D>>);

impl<T: Real, const D: usize> Dynamics<T, D> for AnyBody<T, D> {
    fn nodes(&self) -> usize {
        self.0.dynamics().nodes
    }
    fn site(&self, node: usize) -> usize {
        self.0.place(node).0
    }
    fn unit(&self) -> f64 {
        self.0.dynamics().unit
    }
    fn horizon(&self) -> f64 {
        self.0.horizon()
    }
    fn position(&self, node: usize) -> SVector<f64, D> {
        self.0.place(node).1
    }
    fn volume(&self, node: usize) -> f64 {
        self.0.size(node).0
    }
    fn mass(&self, node: usize) -> f64 {
        self.0.size(node).1
    }
    fn damage(&self, node: usize) -> f64 {
        self.0.damage(node)
    }
    fn broken_bonds(&self) -> usize {
        self.0.dynamics().broken
    }
    fn worst_index(&self) -> f64 {
        self.0.dynamics().worst
    }
    fn visit_neighbours(&self, node: usize, visit: &mut dyn FnMut(Neighbour<D>)) {
        self.0.neighbours(node, visit);
    }
    fn u(&self) -> &Field<T, SVector<T, D>> {
        self.0.dynamics().u
    }
    fn u_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        self.0.u_mut()
    }
    fn v(&self) -> &Field<T, SVector<T, D>> {
        self.0.dynamics().v
    }
    fn v_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        self.0.v_mut()
    }
    fn force(&self) -> &Field<T, SVector<T, D>> {
        self.0.dynamics().force
    }
    fn force_mut(&mut self) -> &mut Field<T, SVector<T, D>> {
        self.0.force_mut()
    }
    fn kick(&mut self, dt: f64) {
        self.0.kick(dt);
    }
    fn drift(&mut self, dt: f64) {
        self.0.drift(dt);
    }
    fn evaluate(&mut self) -> Result<()> {
        self.0.evaluate()
    }
    fn evaluate_and_break(&mut self, step: usize, _: &mut dyn BreakEvents<Self>) -> Result<Tally> {
        self.0.evaluate_and_break(step)
    }
    fn can_break(&self) -> bool {
        self.0.dynamics().breaks
    }
    fn inverse_mass(&self, site: usize) -> T {
        self.0.inverse_mass(site)
    }
    fn is_linear(&self) -> bool {
        self.0.dynamics().linear
    }
    fn diagonal_blocks(&self) -> Field<T, SMatrix<T, D, D>> {
        self.0.diagonal_blocks()
    }
    fn save(&self, _: &mut StateWriter<'_>) -> std::io::Result<()> {
        Err(std::io::Error::other("a specimen keeps no state"))
    }
    fn restore(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Err(pd_core::Error::Other("a specimen keeps no state".to_owned()))
    }
}

/// A body of any material, criterion and precision. SI units.
pub trait Specimen<const D: usize> {
    /// Number of nodes.
    fn nodes(&self) -> usize;
    /// True if forces are linear in the displacements.
    fn is_linear(&self) -> bool;
    /// Δx in m.
    fn unit(&self) -> f64;
    /// x in m.
    fn position(&self, node: usize) -> SVector<f64, D>;
    /// V in m^D.
    fn volume(&self, node: usize) -> f64;
    /// ρV in kg.
    fn mass(&self, node: usize) -> f64;
    /// u in m.
    fn displacement(&self, node: usize) -> SVector<f64, D>;
    /// v in m/s.
    fn velocity(&self, node: usize) -> SVector<f64, D>;
    /// f in N/m³.
    fn force_density(&self, node: usize) -> SVector<f64, D>;
    /// Sets u in m.
    fn displace(&mut self, node: usize, u: &SVector<f64, D>);
    /// Sets v in m/s.
    fn set_in_motion(&mut self, node: usize, v: &SVector<f64, D>);
    /// Damage index φ.
    fn damage(&self, node: usize) -> f64;
    /// Bonds broken.
    fn broken_bonds(&self) -> usize;
    /// Forces of the displacements.
    ///
    /// # Errors
    /// As [`Dynamics::evaluate`].
    fn evaluate(&mut self) -> Result<()>;
    /// W of every node in Pa, of the last evaluation.
    fn energy_densities(&self) -> Vec<f64>;
    /// Solves a static problem.
    ///
    /// # Errors
    /// As [`Statics::solve`].
    fn solve(&mut self, statics: &Statics, loads: Loads) -> Result<Solved>;
    /// Runs for some steps; returns Δt in s.
    ///
    /// # Errors
    /// As [`Run::new`] and [`Run::steps_more`].
    fn run(&mut self, loads: Loads, rule: TimeStep, steps: usize) -> Result<f64>;

    /// Strain energy in J of the last evaluation.
    fn strain_energy(&self) -> f64 {
        self.energy_densities().iter().enumerate().map(|(i, w)| w * self.volume(i)).sum()
    }
    /// Displaces every node from its position.
    fn deform(&mut self, u: &dyn Fn(&SVector<f64, D>) -> SVector<f64, D>) {
        (0..self.nodes()).for_each(|node| self.displace(node, &u(&self.position(node))));
    }
    /// Gives every node a velocity from its position.
    fn launch(&mut self, v: &dyn Fn(&SVector<f64, D>) -> SVector<f64, D>) {
        (0..self.nodes()).for_each(|node| self.set_in_motion(node, &v(&self.position(node))));
    }
    /// ½ Σ ρ V v² in J.
    fn kinetic_energy(&self) -> f64 {
        (0..self.nodes()).map(|i| 0.5 * self.mass(i) * self.velocity(i).norm_squared()).sum()
    }
    /// |Σ f V| / Σ |f V|: 0 for forces in balance.
    fn unbalanced(&self) -> f64 {
        let force = |i| self.force_density(i) * self.volume(i);
        let sum: SVector<f64, D> = (0..self.nodes()).map(force).sum();
        sum.norm() / (0..self.nodes()).map(|i| force(i).norm()).sum::<f64>().max(f64::MIN_POSITIVE)
    }
    /// True if displacements, velocities and forces are numbers.
    fn is_finite(&self) -> bool {
        let finite = |x: SVector<f64, D>| x.iter().all(|x| x.is_finite());
        let all = |i| [self.displacement(i), self.velocity(i), self.force_density(i)].map(finite);
        (0..self.nodes()).all(|i| all(i) == [true; 3])
    }
}

impl<T: Real, const D: usize> Specimen<D> for AnyBody<T, D> {
    fn nodes(&self) -> usize {
        Dynamics::nodes(self)
    }
    fn is_linear(&self) -> bool {
        Dynamics::is_linear(self)
    }
    fn unit(&self) -> f64 {
        Dynamics::unit(self)
    }
    fn position(&self, node: usize) -> SVector<f64, D> {
        Dynamics::position(self, node)
    }
    fn volume(&self, node: usize) -> f64 {
        Dynamics::volume(self, node)
    }
    fn mass(&self, node: usize) -> f64 {
        Dynamics::mass(self, node)
    }
    fn displacement(&self, node: usize) -> SVector<f64, D> {
        self.u().get(self.site(node)).map(Real::to_f64) * Dynamics::unit(self)
    }
    fn velocity(&self, node: usize) -> SVector<f64, D> {
        self.v().get(self.site(node)).map(Real::to_f64) * Dynamics::unit(self)
    }
    fn force_density(&self, node: usize) -> SVector<f64, D> {
        self.force().get(self.site(node)).map(Real::to_f64) / Dynamics::unit(self)
    }
    fn displace(&mut self, node: usize, u: &SVector<f64, D>) {
        let (site, unit) = (self.site(node), Dynamics::unit(self));
        self.u_mut().set(site, (u / unit).map(T::of));
    }
    fn set_in_motion(&mut self, node: usize, v: &SVector<f64, D>) {
        let (site, unit) = (self.site(node), Dynamics::unit(self));
        self.v_mut().set(site, (v / unit).map(T::of));
    }
    fn damage(&self, node: usize) -> f64 {
        Dynamics::damage(self, node)
    }
    fn broken_bonds(&self) -> usize {
        Dynamics::broken_bonds(self)
    }
    fn evaluate(&mut self) -> Result<()> {
        Dynamics::evaluate(self)
    }
    fn energy_densities(&self) -> Vec<f64> {
        self.0.energy_densities()
    }
    fn solve(&mut self, statics: &Statics, loads: Loads) -> Result<Solved> {
        statics.solve(self, loads)
    }
    fn run(&mut self, loads: Loads, rule: TimeStep, steps: usize) -> Result<f64> {
        let mut run = Run::new(self, loads, rule)?;
        run.steps_more(steps)?;
        Ok(run.dt())
    }
}

/// How bonds break, at a strain of about `at`: every criterion, its critical value made from the
/// strain by dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tear {
    /// The criterion.
    pub by: Criterion,
    /// The strain.
    pub at: f64,
}

/// The criteria.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Criterion {
    /// [`CriticalStretch`], for any material.
    Stretch,
    /// [`CrackOpening`], for any material.
    Opening,
    /// [`BondEnergy`], for any material.
    Energy,
    /// [`TsaiHill`], for materials with a stress.
    TsaiHill,
    /// [`PowerLaw`], for materials that tell volumetric from deviatoric energy.
    PowerLaw,
    /// [`Separated`], likewise.
    Separated,
}

/// All criteria.
pub const CRITERIA: [Criterion; 6] = [
    Criterion::Stretch,
    Criterion::Opening,
    Criterion::Energy,
    Criterion::TsaiHill,
    Criterion::PowerLaw,
    Criterion::Separated,
];

impl Tear {
    /// Nothing breaks.
    pub const NEVER: Self = Self { by: Criterion::Stretch, at: 1e6 };
}

/// A criterion for any material, chosen when the program runs: one version of every loop.
#[derive(Debug, Clone, Copy)]
enum ForAny {
    Stretch(CriticalStretch),
    Opening(CrackOpening),
    Energy(BondEnergy),
}

impl<T: Real, const D: usize, M: Material<T, D>> DamageCriterion<T, D, M> for ForAny {
    type NodeConst = ();
    type NodeValue = ();
    fn index(&self, bond: &TestedBond<'_, T, D, M, (), ()>) -> T {
        match self {
            Self::Stretch(criterion) => criterion.index(bond),
            Self::Opening(criterion) => criterion.index(bond),
            Self::Energy(criterion) => criterion.index(bond),
        }
    }
}

/// A criterion for a material with a capability: those for any, or the ones it is for.
#[derive(Debug, Clone, Copy)]
enum OrElse<C> {
    Any(ForAny),
    Own(C),
}

impl<T, const D: usize, M, C> DamageCriterion<T, D, M> for OrElse<C>
where
    T: Real,
    M: Material<T, D>,
    C: DamageCriterion<T, D, M, NodeConst = ()>,
{
    type NodeConst = ();
    type NodeValue = C::NodeValue;
    fn node_value(
        &self,
        material: &M,
        constants: &M::NodeConst,
        state: &M::NodeState,
    ) -> C::NodeValue {
        match self {
            Self::Any(_) => Record::zero(),
            Self::Own(criterion) => criterion.node_value(material, constants, state),
        }
    }
    fn index(&self, bond: &TestedBond<'_, T, D, M, (), C::NodeValue>) -> T {
        match self {
            Self::Any(criterion) => criterion.index(&bond.seen_by([&(), &()], [&(), &()])),
            Self::Own(criterion) => criterion.index(bond),
        }
    }
}

/// Criteria for materials that tell volumetric from deviatoric energy.
#[derive(Debug, Clone, Copy)]
enum Split {
    PowerLaw(PowerLaw),
    Separated(Separated),
}

impl<T: Real, const D: usize, M: EnergySplit<T, D>> DamageCriterion<T, D, M> for Split {
    type NodeConst = ();
    type NodeValue = ();
    fn index(&self, bond: &TestedBond<'_, T, D, M, (), ()>) -> T {
        match self {
            Self::PowerLaw(criterion) => criterion.index(bond),
            Self::Separated(criterion) => criterion.index(bond),
        }
    }
}

/// What the bodies are made of.
#[derive(Debug, Clone)]
pub struct Recipe<const D: usize> {
    /// Stiffness of anisotropic materials.
    pub stiffness: Stiffness<D>,
    /// Moduli of isotropic ones; bond-based materials take Young's modulus alone.
    pub moduli: Isotropic,
    /// ρ in kg/m³.
    pub density: f64,
    /// ω.
    pub influence: InfluenceFunction,
    /// Nodes.
    pub points: Points<D>,
    /// δ in m.
    pub horizon: f64,
    /// How bonds break.
    pub tear: Tear,
}

/// A specimen by name, or the reason why there is none.
pub struct Named<const D: usize> {
    /// Name of the material.
    pub name: &'static str,
    /// The body.
    pub body: pd_models::Result<Box<dyn Specimen<D>>>,
}

impl<const D: usize> Recipe<D> {
    /// E ε² / δ^D: an energy of the size of a bond's.
    fn bond_energy(&self) -> f64 {
        self.moduli.young() * self.tear.at.powi(2) / self.horizon.powi(D as i32)
    }
    fn modes(&self) -> Result<ModeEnergies> {
        let w = self.bond_energy();
        ModeEnergies::new(w, Some(2.0 * w), w)
    }
    fn strengths(&self) -> Strengths {
        let stress = self.moduli.young() * self.tear.at;
        Strengths { along: stress, across: 0.5 * stress, shear: 0.5 * stress }
    }
    /// None for a criterion that is not for any material.
    fn for_any(&self) -> Result<Option<ForAny>> {
        let at = self.tear.at;
        Ok(Some(match self.tear.by {
            Criterion::Stretch => ForAny::Stretch(CriticalStretch::new(at)?),
            Criterion::Opening => ForAny::Opening(CrackOpening::new(at * self.horizon)?),
            Criterion::Energy => ForAny::Energy(BondEnergy::new(self.bond_energy())?),
            _ => return Ok(None),
        }))
    }
    /// For any material, or by its own criterion; None for one that does not compile with it.
    fn or_own<C>(&self, own: Result<Option<C>>) -> Result<Option<OrElse<C>>> {
        Ok(self.for_any()?.map(OrElse::Any).or(own?.map(OrElse::Own)))
    }
    fn split(&self) -> Result<Option<OrElse<Split>>> {
        let modes = self.modes()?;
        self.or_own(Ok(match self.tear.by {
            Criterion::PowerLaw => Some(Split::PowerLaw(PowerLaw::new(modes))),
            Criterion::Separated => Some(Split::Separated(Separated::new(modes))),
            _ => None,
        }))
    }
    /// Adds a specimen to a list if the criterion compiles with the material.
    fn add<T, M, C>(
        &self,
        list: &mut Vec<Named<D>>,
        name: &'static str,
        material: pd_models::Result<M>,
        criterion: Result<Option<C>>,
    ) where
        T: Real,
        M: StrainEnergy<T, D> + 'static,
        C: DamageCriterion<T, D, M> + 'static,
    {
        let body = |criterion| -> pd_models::Result<Box<dyn Specimen<D>>> {
            let family = Cloud::new(&self.points, Horizon::Metres(self.horizon), Quadrature::None)?;
            let body = Body::<T, D, _, M, _>::new(family, material?, Breaking::new(criterion))?;
            Ok(Box::new(AnyBody(Box::new(body))))
        };
        let body = match criterion {
            Ok(None) => return,
            Ok(Some(criterion)) => body(criterion),
            Err(error) => Err(error.into()),
        };
        list.push(Named { name, body });
    }
}

/// Adds specimens to a list: name, material, and where it has a capability the criteria it takes.
macro_rules! add {
    ($list:ident, $recipe:ident, $t:ty; $($name:literal: $material:expr, $criterion:ident;)*) => {
        $($recipe.add::<$t, _, _>(&mut $list, $name, $material, $recipe.$criterion());)*
    };
}

impl Recipe<2> {
    fn stress(&self) -> Result<Option<OrElse<TsaiHill>>> {
        let own = || TsaiHill::new(&self.strengths(), 0.3);
        self.or_own((self.tear.by == Criterion::TsaiHill).then(own).transpose())
    }

    /// Plates of every material that the criterion compiles with.
    pub fn specimens<T: Real>(&self) -> Vec<Named<2>> {
        let Self { stiffness: c, moduli, density: rho, influence: omega, .. } = self;
        let (rho, omega) = (*rho, *omega);
        let stress = PlaneMode::PlaneStress;
        let third = || Isotropic::from_young_poisson(moduli.young(), 1.0 / 3.0);
        let bonds = |t: Isotropic| Pmb::plane(&t, stress, rho, omega);
        let linear = || Correspondence::new(LinearElastic(*c), rho, omega);
        let solid = || LinearSolid::plane(moduli, stress, rho, omega);
        let split = || PositiveSplit::plane(c, rho, omega);
        let mut list = Vec::new();
        add! { list, self, T;
            "bonds": third().and_then(bonds).map(Ordinary::new), for_any;
            "linear solid": solid().map(Ordinary::new), split;
            "linearised linear solid": solid().map(Ordinary::linearised), split;
            "Madenci-Oterkus":
                MadenciOterkus::plane(moduli, stress, rho).map(Ordinary::new), for_any;
            "polynomial micromoduli":
                PolynomialMicromoduli::plane(c, rho, omega).map(Ordinary::new), for_any;
            "positive split": split().map(Ordinary::new), for_any;
            "strained positive split":
                split().map(|m| Ordinary::linearised(Strained::plane(m, c, omega))), stress;
            "correspondence": linear(), stress;
            "correspondence, Wan":
                linear().and_then(|m| Ok(m.with_control(WanControl::new(c, 1.0)?))), stress;
            "correspondence, Silling": linear().and_then(|m| {
                Ok(m.with_control(SillingControl::new(moduli.plane_bulk(stress), 1.0)?))
            }), stress;
            "bond-associated": BondAssociated::<2, 3>::new(c, rho, omega), stress;
            "Saint-Venant-Kirchhoff":
                Correspondence::new(SaintVenantKirchhoff(*c), rho, omega), stress;
            "neo-Hookean": Correspondence::new(NeoHookean::new(moduli), rho, omega), stress;
        }
        list
    }
}

impl Recipe<3> {
    fn stress(&self) -> Result<Option<OrElse<TsaiHill3>>> {
        let own = || TsaiHill3::new(&self.strengths(), [1.0, 0.3, 0.1]);
        self.or_own((self.tear.by == Criterion::TsaiHill).then(own).transpose())
    }

    /// Blocks of every material that the criterion compiles with.
    pub fn specimens<T: Real>(&self) -> Vec<Named<3>> {
        let Self { stiffness: c, moduli, density: rho, influence: omega, .. } = self;
        let (rho, omega) = (*rho, *omega);
        let quarter = || Isotropic::from_young_poisson(moduli.young(), 0.25);
        let linear = || Correspondence::new(LinearElastic(*c), rho, omega);
        let bonds = |q: Isotropic| Pmb::solid(&q, rho, omega);
        let mut list = Vec::new();
        add! { list, self, T;
            "bonds on their family":
                quarter().and_then(bonds).map(|m| Ordinary::new(m.on_family())), for_any;
            "linear solid": LinearSolid::solid(moduli, rho, omega).map(Ordinary::new), split;
            "Madenci-Oterkus": MadenciOterkus::solid(moduli, rho).map(Ordinary::new), for_any;
            "polynomial micromoduli":
                PolynomialMicromoduli::solid(c, rho, omega).map(Ordinary::new), for_any;
            "positive split": PositiveSplit::solid(c, rho, omega).map(Ordinary::new), for_any;
            "correspondence, Wan":
                linear().and_then(|m| Ok(m.with_control(WanControl::new(c, 1.0)?))), stress;
            "bond-associated": BondAssociated::<3, 6>::new(c, rho, omega), stress;
            "Saint-Venant-Kirchhoff":
                Correspondence::new(SaintVenantKirchhoff(*c), rho, omega), stress;
            "neo-Hookean": Correspondence::new(NeoHookean::new(moduli), rho, omega), stress;
        }
        list
    }
}
