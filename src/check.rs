//! Tests of a material, yours or ours, in one line of your own tests.
//!
//! ```
//! use peridynamics::check::{Conditions, check_elastic};
//! use peridynamics::prelude::*;
//! # fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
//! let glass = Isotropic::from_young_poisson(70e9, 0.2)?;
//! let mode = PlaneMode::PlaneStress;
//! let model = LinearSolid::plane(&glass, mode, 2500.0, InfluenceFunction::Gaussian)?;
//! check_elastic(&Ordinary::new(model), &Conditions::<2>::default()).assert();
//! # Ok(())
//! # }
//! ```
//!
//! [`check_material`] does the same for a material without a [`StrainEnergy`].

use nalgebra::{DMatrix, SMatrix, SVector};
use pd_core::body::{Body, Dynamics};
use pd_core::cloud::Cloud;
use pd_core::damage::NoDamage;
use pd_core::family::Horizon;
use pd_core::material::{Material, StrainEnergy};
use pd_core::points::Points;
use pd_core::quadrature::Quadrature;
use pd_core::symbol::{Stability, Symbol};
use pd_core::{Error, Result};
use std::fmt;

/// Probing displacement in units of Δx: central differences err by its square, and by rounding
/// over it.
const STEP: f64 = 1e-5;
/// Violations accepted, relative to the largest force (constant). Of differences of forces:
const SYMMETRIC: f64 = 1e-7;
/// Of differences of energies, which lose more digits.
const GRADIENT: f64 = 1e-6;
/// Of sums of forces over a body of a hundred nodes.
const BALANCED: f64 = 1e-12;
/// Of forces of a turned body: H of order one, so it cancels.
const TURNED: f64 = 1e-10;
/// Small rotation, whose force may be of second order.
const ANGLE: f64 = 1e-6;
/// ω² of a wave relative to the stiffest: less than rounding leaves of zero is growth.
const GROWTH: f64 = 1e-9;

/// Which rotations a material claims not to feel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rotations {
    /// Any: finite kinematics.
    #[default]
    Finite,
    /// Small ones only: linearised kinematics, small strains. What is [linear](Material::LINEAR)
    /// claims no more.
    Small,
}

/// The lattice a material is tested on, and what it claims.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions<const D: usize> {
    /// Spacing Δx along each axis in metres.
    pub spacing: [f64; D],
    /// Horizon.
    pub horizon: Horizon,
    /// Quadrature weights of the lattice.
    pub quadrature: Quadrature,
    /// Rotations it claims not to feel.
    pub rotations: Rotations,
}

impl<const D: usize> Default for Conditions<D> {
    /// Δx = 1 mm, m = 3, no quadrature weights, finite rotations.
    fn default() -> Self {
        Self {
            spacing: [1e-3; D],
            horizon: Horizon::Cells(3.0),
            quadrature: Quadrature::None,
            rotations: Rotations::Finite,
        }
    }
}

/// What a material must be for a simulation to mean something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Property {
    /// The linearised operator is symmetric, K_ij = K_jiᵀ: an energy can be behind.
    Symmetry,
    /// Internal forces keep linear and angular momentum.
    Momentum,
    /// A rigid motion changes no force but by turning it.
    Objectivity,
    /// f V = −∂E/∂u.
    Energy,
    /// No plane wave of the lattice grows: ω² ≥ 0.
    Stability,
}

/// Where a violation is largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Place<const D: usize> {
    /// Nowhere in particular.
    Body,
    /// At the node of this reference position in metres.
    Node(SVector<f64, D>),
    /// In the plane wave of this wave vector in 1/m.
    Wave(SVector<f64, D>),
}

/// What became of one part of a property.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome<const D: usize> {
    /// The violation is within its limit.
    Holds {
        /// Violation, relative to the largest force or ω².
        error: f64,
        /// Largest one accepted.
        limit: f64,
    },
    /// The violation is beyond its limit, or no number.
    Fails {
        /// Violation, relative to the largest force or ω².
        error: f64,
        /// Largest one accepted.
        limit: f64,
        /// Where.
        place: Place<D>,
    },
    /// The material refused to be tested.
    Refused(Error),
    /// The material makes no such claim, or has not what it takes to test it.
    DoesNotApply(&'static str),
}

/// One line of a [`Report`].
#[derive(Debug, Clone, PartialEq)]
pub struct Finding<const D: usize> {
    /// The property.
    pub property: Property,
    /// Which part of it.
    pub part: &'static str,
    /// What became of it.
    pub outcome: Outcome<D>,
}

/// What [`check_material`] found.
#[derive(Debug, Clone, PartialEq)]
pub struct Report<const D: usize>(pub Vec<Finding<D>>);

impl<const D: usize> Report<D> {
    /// The findings that fail or were refused.
    pub fn failures(&self) -> impl Iterator<Item = &Finding<D>> {
        let bad =
            |f: &&Finding<D>| matches!(f.outcome, Outcome::Fails { .. } | Outcome::Refused(_));
        self.0.iter().filter(bad)
    }
    /// True if every property that applies holds.
    pub fn holds(&self) -> bool {
        self.failures().next().is_none()
    }
    /// For tests.
    ///
    /// # Panics
    /// With the whole report unless it [`holds`](Self::holds).
    pub fn assert(&self) {
        assert!(self.holds(), "the material is not sound:\n{self}");
    }
    fn add(&mut self, property: Property, part: &'static str, outcome: Outcome<D>) {
        self.0.push(Finding { property, part, outcome });
    }
}

impl<const D: usize> fmt::Display for Report<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Finding { property, part, outcome } in &self.0 {
            write!(f, "{:<12} {part:<42} ", format!("{property:?}"))?;
            match outcome {
                Outcome::Holds { error, limit } => {
                    write!(f, "holds: {error:.1e} (limit {limit:e})")?
                }
                Outcome::Fails { error, limit, place } => {
                    write!(f, "FAILS: {error:.1e} (limit {limit:e})")?;
                    match place {
                        Place::Body => {}
                        Place::Node(x) => write!(f, " at {:?} m", x.as_slice())?,
                        Place::Wave(k) => write!(f, " in the wave k = {:?} 1/m", k.as_slice())?,
                    }
                }
                Outcome::Refused(error) => write!(f, "REFUSED: {error}")?,
                Outcome::DoesNotApply(why) => write!(f, "does not apply: {why}")?,
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

/// Tests a material: [`Property`] by property, without an energy.
///
/// Two bodies serve: the infinite lattice (its [`Symbol`]) and a small free cloud whose nodes are
/// moved off their places and have different volumes, so that a volume forgotten or taken from the
/// wrong end shows.
pub fn check_material<const D: usize, M: Material<f64, D>>(
    material: &M,
    conditions: &Conditions<D>,
) -> Report<D> {
    let mut report = common(material, conditions);
    let why = "the material has no StrainEnergy (else use check_elastic)";
    report.add(Property::Energy, GRADIENT_PART, Outcome::DoesNotApply(why));
    report
}

/// As [`check_material`], and that the forces are those of the energy.
pub fn check_elastic<const D: usize, M: StrainEnergy<f64, D>>(
    material: &M,
    conditions: &Conditions<D>,
) -> Report<D> {
    let mut report = common(material, conditions);
    let outcome = Cluster::of(material, conditions).and_then(|mut body| body.gradient());
    report.add(Property::Energy, GRADIENT_PART, within(outcome, GRADIENT));
    report
}

const GRADIENT_PART: &str = "f V = −∂E/∂u";

fn common<const D: usize, M: Material<f64, D>>(
    material: &M,
    conditions: &Conditions<D>,
) -> Report<D> {
    let mut report = Report(Vec::new());
    let Conditions { spacing, horizon, quadrature, .. } = *conditions;
    let symbol = Symbol::with_spacing(material, spacing, horizon, quadrature);
    let part = "force constants K(x) = K(−x) = K(x)ᵀ";
    let outcome = match &symbol {
        Ok(symbol) => within(Ok((symbol.asymmetry(), Place::Body)), SYMMETRIC),
        Err(Error::ForceConstants { relative, .. }) => {
            Outcome::Fails { error: *relative, limit: SYMMETRIC, place: Place::Body }
        }
        Err(error) => Outcome::Refused(error.clone()),
    };
    report.add(Property::Symmetry, part, outcome);

    let (part, outcome) = match &symbol {
        Ok(symbol) => waves(symbol),
        Err(_) => (GROWTH_PART, Outcome::DoesNotApply("the lattice has no symbol, see symmetry")),
    };
    report.add(Property::Stability, part, outcome);

    let finite = conditions.rotations == Rotations::Finite && !M::LINEAR;
    match Cluster::of(material, conditions) {
        Ok(mut body) => body.probe(finite, &mut report),
        Err(error) => {
            report.add(Property::Symmetry, "operator of a free body", Outcome::Refused(error));
        }
    }
    report
}

const GROWTH_PART: &str = "no plane wave grows";

/// −ω²_min/ω²_max, and the wave.
fn waves<const D: usize>(symbol: &Symbol<D>) -> (&'static str, Outcome<D>) {
    let extremes = symbol.extremes(if D == 3 { 24 } else { 120 });
    let largest = extremes.stiffest.eigenvalue.abs().max(extremes.softest.eigenvalue.abs());
    let error = -extremes.softest.eigenvalue / largest;
    let outcome = within(Ok((error, Place::Wave(extremes.softest.wave))), GROWTH);
    match extremes.stability() {
        Stability::ZeroEnergy(_) => ("no plane wave grows, but one costs no energy", outcome),
        _ => (GROWTH_PART, outcome),
    }
}

/// The largest violation, and where.
type Worst<const D: usize> = (f64, Place<D>);

fn within<const D: usize>(found: Result<Worst<D>>, limit: f64) -> Outcome<D> {
    match found {
        Ok((error, _)) if error <= limit => Outcome::Holds { error, limit },
        Ok((error, place)) => Outcome::Fails { error, limit, place },
        Err(error) => Outcome::Refused(error),
    }
}

/// The small free cloud.
struct Cluster<'m, const D: usize, M: Material<f64, D>> {
    body: Body<f64, D, Cloud<f64, D>, &'m M, NoDamage>,
    unit: f64,
}

/// Numbers in (−1, 1), the same in every run.
fn noise(i: usize) -> f64 {
    2.0 * (43758.5453 * (12.9898 * (i + 1) as f64).sin()).rem_euclid(1.0) - 1.0
}

impl<'m, const D: usize, M: Material<f64, D>> Cluster<'m, D, M> {
    /// 7 × 7 or 5 × 5 × 5 nodes, up to 0.15 Δx off their places, volumes up to 30 % off.
    fn of(material: &'m M, conditions: &Conditions<D>) -> Result<Self> {
        let edge: usize = if D == 3 { 5 } else { 7 };
        let spacing = SVector::from(conditions.spacing);
        let count = edge.pow(D as u32);
        let place = |node: usize| {
            SVector::from_fn(|d, _| {
                let cell = (node / edge.pow(d as u32) % edge) as f64;
                (cell + 0.15 * noise(D * node + d)) * spacing[d]
            })
        };
        let volume = |node| spacing.product() * (1.0 + 0.3 * noise(7 * node + 3));
        let points =
            Points::new((0..count).map(place).collect(), (0..count).map(volume).collect())?
                .with_spacing(spacing[0])?;
        let family = Cloud::new(&points, conditions.horizon, Quadrature::None)?;
        Ok(Self { body: Body::new(family, material, NoDamage)?, unit: spacing[0] })
    }

    /// Reference positions and the displacements of a smooth deformation of some per cent, m.
    fn wavy(&self) -> Vec<SVector<f64, D>> {
        (0..self.body.nodes())
            .map(|node| {
                let x = self.body.position(node) / self.unit;
                SVector::from_fn(|d, _| {
                    let phase: f64 = (0..D).map(|k| (0.3 + 0.2 * (k + d) as f64) * x[k]).sum();
                    0.05 * self.unit * (phase + d as f64).sin()
                })
            })
            .collect()
    }

    /// Forces f V in N of these displacements in m.
    fn forces(&mut self, u: &[SVector<f64, D>]) -> Result<Vec<SVector<f64, D>>> {
        for (node, u) in u.iter().enumerate() {
            self.body.set_displacement_of(node, u);
        }
        self.body.evaluate()?;
        let body = &self.body;
        Ok((0..u.len()).map(|i| body.force_density(i) * body.volume(i)).collect())
    }

    /// Largest violation of all nodes over `scale`, and the node; NaN beats all.
    fn worst(&self, errors: impl Iterator<Item = f64>, scale: f64) -> Worst<D> {
        let beats = |a: f64, b: f64| a.is_nan() || a > b;
        let (error, node) = errors
            .map(|error| error / scale)
            .zip(0..)
            .fold((0.0, 0), |best, next| if beats(next.0, best.0) { next } else { best });
        (error, Place::Node(self.body.position(node)))
    }

    fn probe(&mut self, finite: bool, report: &mut Report<D>) {
        let found = self.asymmetry();
        report.add(Property::Symmetry, "operator of a free body", within(found, SYMMETRIC));

        let found = self.momentum(finite);
        let [linear, angular] = match found {
            Ok(errors) => errors.map(|error| Ok((error, Place::Body))),
            Err(error) => [Err(error.clone()), Err(error)],
        };
        report.add(Property::Momentum, "linear: Σ f V = 0", within(linear, BALANCED));
        let part = if finite { "angular: Σ y × f V = 0" } else { "angular: Σ x × f V = 0" };
        report.add(Property::Momentum, part, within(angular, BALANCED));

        let found = self.translation();
        report.add(Property::Objectivity, "no force of a translation", within(found, BALANCED));
        let part = "a rotation turns the forces";
        if finite {
            let found = self.rotation();
            report.add(Property::Objectivity, part, within(found, TURNED));
        } else {
            let none = Outcome::DoesNotApply("linear, or said to be for small rotations");
            report.add(Property::Objectivity, part, none);
        }
        let found = self.small_rotation();
        report.add(
            Property::Objectivity,
            "no force of a small rotation",
            within(found, 10.0 * ANGLE),
        );
    }

    /// |K_ab − K_ba| of the forces f V about the reference configuration.
    fn asymmetry(&mut self) -> Result<Worst<D>> {
        let n = D * self.body.nodes();
        let mut k = DMatrix::<f64>::zeros(n, n);
        let mut u = vec![SVector::zeros(); self.body.nodes()];
        for column in 0..n {
            for sign in [1.0, -1.0] {
                u[column / D][column % D] = sign * STEP * self.unit;
                for (node, f) in self.forces(&u)?.iter().enumerate() {
                    (0..D).for_each(|a| k[(D * node + a, column)] -= sign * f[a]);
                }
            }
            u[column / D] = SVector::zeros();
        }
        let difference = &k - k.transpose();
        let of_node = |node: usize| difference.rows(D * node, D).iter().fold(0.0, nan_max);
        Ok(self.worst((0..n / D).map(of_node), k.iter().fold(0.0, nan_max)))
    }

    /// |Σ f V| / Σ |f V| and |Σ y × f V| / Σ |y||f V| of a deformed body; with the reference places
    /// for materials that do not know rotations.
    fn momentum(&mut self, finite: bool) -> Result<[f64; 2]> {
        let u = self.wavy();
        let forces = self.forces(&u)?;
        let (mut sum, mut size) = (SVector::<f64, D>::zeros(), 0.0);
        let (mut moment, mut lever) = (SMatrix::<f64, D, D>::zeros(), 0.0);
        for (node, f) in forces.iter().enumerate() {
            let shift = if finite { u[node] } else { SVector::zeros() };
            let y = self.body.position(node) + shift;
            sum += f;
            size += f.norm();
            moment += y * f.transpose() - f * y.transpose();
            lever += y.norm() * f.norm();
        }
        Ok([sum.norm() / size, moment.norm() / lever])
    }

    /// Largest force of a strain of 1 %, what forces of rigid motions are compared with.
    fn scale(&mut self) -> Result<f64> {
        let u: Vec<_> = (0..self.body.nodes()).map(|i| self.body.position(i) * 0.01).collect();
        Ok(self.forces(&u)?.iter().map(|f| f.norm()).fold(0.0, |a, b| nan_max(a, &b)))
    }

    fn translation(&mut self) -> Result<Worst<D>> {
        let scale = self.scale()?;
        let forces = self.forces(&vec![SVector::repeat(0.7 * self.unit); self.body.nodes()])?;
        Ok(self.worst(forces.iter().map(|f| f.norm()), scale))
    }

    /// |f(R y) − R f(y)| of a deformed body turned by about one radian.
    fn rotation(&mut self) -> Result<Worst<D>> {
        let (u, r) = (self.wavy(), rotation::<D>());
        let forces = self.forces(&u)?;
        let turned: Vec<_> = (0..u.len())
            .map(|i| {
                let x = self.body.position(i);
                r * (x + u[i]) - x
            })
            .collect();
        let scale = forces.iter().map(|f| f.norm()).fold(0.0, |a, b| nan_max(a, &b));
        let found = self.forces(&turned)?;
        let errors = forces.iter().zip(&found).map(|(f, g)| (g - r * f).norm());
        Ok(self.worst(errors, scale))
    }

    /// Force of the motion u = W x, |W| = [`ANGLE`], over that of a strain of this size.
    fn small_rotation(&mut self) -> Result<Worst<D>> {
        let scale = self.scale()? * ANGLE / 0.01;
        let r = rotation::<D>();
        let w = (r - r.transpose()) * (0.5 * ANGLE);
        let u: Vec<_> = (0..self.body.nodes()).map(|i| w * self.body.position(i)).collect();
        let forces = self.forces(&u)?;
        Ok(self.worst(forces.iter().map(|f| f.norm()), scale))
    }
}

impl<const D: usize, M: StrainEnergy<f64, D>> Cluster<'_, D, M> {
    /// |f V + ∂E/∂u| at every node of a deformed body, by central differences.
    fn gradient(&mut self) -> Result<Worst<D>> {
        let u = self.wavy();
        let forces = self.forces(&u)?;
        let step = STEP * self.unit;
        let mut errors = Vec::new();
        for node in 0..u.len() {
            let mut gradient = SVector::<f64, D>::zeros();
            for axis in 0..D {
                for sign in [1.0, -1.0] {
                    let mut moved = u[node];
                    moved[axis] += sign * step;
                    self.body.set_displacement_of(node, &moved);
                    self.body.evaluate()?;
                    gradient[axis] += sign * self.body.strain_energy() / (2.0 * step);
                }
            }
            self.body.set_displacement_of(node, &u[node]);
            errors.push((forces[node] + gradient).norm());
        }
        let scale = forces.iter().map(|f| f.norm()).fold(0.0, |a, b| nan_max(a, &b));
        Ok(self.worst(errors.into_iter(), scale))
    }
}

/// The larger magnitude; NaN stays.
fn nan_max(a: f64, b: &f64) -> f64 {
    if b.abs() > a || b.is_nan() { b.abs() } else { a }
}

/// A rotation of about one radian, about no axis of the lattice.
fn rotation<const D: usize>() -> SMatrix<f64, D, D> {
    (1..D).fold(SMatrix::identity(), |r, b| {
        let (sin, cos) = (1.0 / b as f64).sin_cos();
        let mut turn = SMatrix::identity();
        (turn[(b - 1, b - 1)], turn[(b, b)]) = (cos, cos);
        (turn[(b - 1, b)], turn[(b, b - 1)]) = (-sin, sin);
        r * turn
    })
}
