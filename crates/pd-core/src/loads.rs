//! Boundary conditions and loads on node sets.

use crate::body::Dynamics;
use crate::grid::NodeSet;
use crate::{Error, Real, Result};
use std::collections::HashMap;

/// A value that is constant or a function of time t in seconds.
pub trait TimeFunction: Send + Sync {
    /// Value at time t.
    fn at(&self, t: f64) -> f64;
}
impl TimeFunction for f64 {
    fn at(&self, _: f64) -> f64 {
        *self
    }
}
impl<F: Fn(f64) -> f64 + Send + Sync> TimeFunction for F {
    fn at(&self, t: f64) -> f64 {
        self(t)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Displacement,
    Velocity,
    BodyForce,
}

struct Load {
    kind: Kind,
    nodes: NodeSet,
    axis: usize,
    value: Box<dyn TimeFunction>,
}

/// Boundary conditions of a run: prescribed displacements and velocities and body forces, each on
/// a node set and one component. Nothing prescribed means free surfaces.
#[derive(Default)]
pub struct Loads {
    loads: Vec<Load>,
}

impl Loads {
    /// No loads.
    pub fn new() -> Self {
        Self::default()
    }
    fn with(
        mut self,
        kind: Kind,
        nodes: &NodeSet,
        axis: usize,
        value: impl TimeFunction + 'static,
    ) -> Self {
        self.loads.push(Load { kind, nodes: nodes.clone(), axis, value: Box::new(value) });
        self
    }
    /// Prescribes u_axis(t) in metres.
    pub fn displacement(
        self,
        nodes: &NodeSet,
        axis: usize,
        value: impl TimeFunction + 'static,
    ) -> Self {
        self.with(Kind::Displacement, nodes, axis, value)
    }
    /// Prescribes v_axis(t) in m/s.
    pub fn velocity(
        self,
        nodes: &NodeSet,
        axis: usize,
        value: impl TimeFunction + 'static,
    ) -> Self {
        self.with(Kind::Velocity, nodes, axis, value)
    }
    /// Adds a body force b_axis(t) in N/m³.
    pub fn body_force(
        self,
        nodes: &NodeSet,
        axis: usize,
        value: impl TimeFunction + 'static,
    ) -> Self {
        self.with(Kind::BodyForce, nodes, axis, value)
    }
    /// Holds all components of the nodes at u = 0.
    pub fn clamp<const D: usize>(self, nodes: &NodeSet) -> Self {
        (0..D).fold(self, |loads, axis| loads.displacement(nodes, axis, 0.0))
    }

    /// Binds the loads to a body.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for an axis the body does not have, a node it does not have or a
    /// value that is not finite at t = 0, [`Error::ConflictingConditions`] for a component that is
    /// prescribed twice.
    pub fn bind<T: Real, const D: usize, B: Dynamics<T, D>>(self, body: &B) -> Result<Bound> {
        let mut prescribed: HashMap<(usize, usize), ()> = HashMap::new();
        let mut bound = Bound { supports: Vec::new(), forces: Vec::new() };
        for load in self.loads {
            let axis = load.axis;
            Error::check(axis < D, "axis of a load", axis as f64, "a component of the body")?;
            let start = load.value.at(0.0);
            Error::check(start.is_finite(), "value of a load at t = 0", start, "finite")?;
            let mut sites = Vec::with_capacity(load.nodes.len());
            for node in load.nodes.iter() {
                Error::check(
                    node < body.nodes(),
                    "node of a load",
                    node as f64,
                    "a node of the body (was the set made for another grid?)",
                )?;
                let kinematic = load.kind != Kind::BodyForce;
                if kinematic && prescribed.insert((node, axis), ()).is_some() {
                    return Err(Error::ConflictingConditions { node, axis });
                }
                sites.push(Site { site: body.site(node), volume: body.volume(node) });
            }
            let entry = BoundLoad { kind: load.kind, sites, axis, value: load.value };
            match load.kind {
                Kind::BodyForce => bound.forces.push(entry),
                _ => bound.supports.push(entry),
            }
        }
        Ok(bound)
    }
}

struct Site {
    site: usize,
    volume: f64,
}

struct BoundLoad {
    kind: Kind,
    sites: Vec<Site>,
    axis: usize,
    value: Box<dyn TimeFunction>,
}

/// Loads bound to the arrays of one body.
pub struct Bound {
    supports: Vec<BoundLoad>,
    forces: Vec<BoundLoad>,
}

impl Bound {
    /// Refuses values that are not finite during the step from t to t + dt: NaN would spread over
    /// the body before anyone looks.
    ///
    /// # Errors
    /// [`Error::InvalidValue`].
    pub fn require_finite(&self, t: f64, dt: f64) -> Result<()> {
        for load in self.supports.iter().chain(&self.forces) {
            let what = match load.kind {
                Kind::Displacement => "prescribed displacement [m]",
                Kind::Velocity => "prescribed velocity [m/s]",
                Kind::BodyForce => "body force [N/m³]",
            };
            for time in [t + 0.5 * dt, t + dt] {
                let value = load.value.at(time);
                Error::check(value.is_finite(), what, value, "finite at every time")?;
            }
        }
        Ok(())
    }
    /// The prescribed components (site, axis).
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a prescribed velocity: a body at rest has none.
    pub(crate) fn held(&self) -> Result<Vec<(usize, usize)>> {
        let mut held = Vec::new();
        for load in &self.supports {
            let displacement = load.kind == Kind::Displacement;
            let need = "absent in a static problem: prescribe a displacement";
            Error::check(displacement, "prescribed velocity [m/s]", load.value.at(0.0), need)?;
            held.extend(load.sites.iter().map(|s| (s.site, load.axis)));
        }
        Ok(held)
    }
    /// Before the drift from t to t + dt: prescribed components move at the speed that takes them
    /// where they must be at t + dt.
    pub fn hold<T: Real, const D: usize>(&self, body: &mut impl Dynamics<T, D>, t: f64, dt: f64) {
        let unit = body.unit();
        for load in &self.supports {
            let speed = |u: f64| match load.kind {
                Kind::Displacement => (load.value.at(t + dt) / unit - u) / dt,
                _ => load.value.at(t + 0.5 * dt) / unit,
            };
            let constant = if load.kind == Kind::Velocity { Some(T::of(speed(0.0))) } else { None };
            for s in &load.sites {
                let u = body.u().get(s.site)[load.axis].to_f64();
                let mut v = body.v().get(s.site);
                v[load.axis] = constant.unwrap_or_else(|| T::of(speed(u)));
                body.v_mut().set(s.site, v);
            }
        }
    }
    /// After the drift: prescribed displacements take their exact value at `t`.
    pub fn place<T: Real, const D: usize>(&self, body: &mut impl Dynamics<T, D>, t: f64) {
        let unit = body.unit();
        for load in self.supports.iter().filter(|l| l.kind == Kind::Displacement) {
            let value = T::of(load.value.at(t) / unit);
            for s in &load.sites {
                let mut u = body.u().get(s.site);
                u[load.axis] = value;
                body.u_mut().set(s.site, u);
            }
        }
    }
    /// After the last kick of a step: prescribed velocities take their value at `t`; components
    /// with a prescribed displacement keep the speed of the drift.
    pub fn finish<T: Real, const D: usize>(
        &self,
        body: &mut impl Dynamics<T, D>,
        t: f64,
        drift: &[Vec<T>],
    ) {
        let unit = body.unit();
        for (load, drift) in self.supports.iter().zip(drift) {
            let value = T::of(load.value.at(t) / unit);
            for (s, &kept) in load.sites.iter().zip(drift) {
                let mut v = body.v().get(s.site);
                v[load.axis] = if load.kind == Kind::Velocity { value } else { kept };
                body.v_mut().set(s.site, v);
            }
        }
    }
    /// Space for [`remember`](Self::remember).
    pub fn scratch<T: Real>(&self) -> Vec<Vec<T>> {
        self.supports.iter().map(|l| vec![T::zero(); l.sites.len()]).collect()
    }
    /// Keeps the drift speed of the prescribed components for [`finish`](Self::finish).
    pub fn remember<T: Real, const D: usize>(
        &self,
        body: &impl Dynamics<T, D>,
        drift: &mut [Vec<T>],
    ) {
        for (load, drift) in self.supports.iter().zip(drift) {
            for (s, kept) in load.sites.iter().zip(drift) {
                *kept = body.v().get(s.site)[load.axis];
            }
        }
    }
    /// Adds the body forces at `t` to the force densities.
    pub fn add_forces<T: Real, const D: usize>(&self, body: &mut impl Dynamics<T, D>, t: f64) {
        let unit = body.unit();
        for load in &self.forces {
            let value = T::of(load.value.at(t) * unit);
            for s in &load.sites {
                let mut f = body.force().get(s.site);
                f[load.axis] += value;
                body.force_mut().set(s.site, f);
            }
        }
    }
    /// Power of the loads in W at `t`: Σ b·v V of the body forces and Σ (ρa − f)·v V of the
    /// supports, without the inertia part (which [`crate::run::Energies`] adds as the change of
    /// kinetic energy of the prescribed components).
    pub fn power<T: Real, const D: usize>(&self, body: &impl Dynamics<T, D>, t: f64) -> f64 {
        let unit = body.unit();
        let mut power = 0.0;
        for load in &self.forces {
            let b = load.value.at(t);
            for s in &load.sites {
                power += b * body.v().get(s.site)[load.axis].to_f64() * unit * s.volume;
            }
        }
        for load in &self.supports {
            for s in &load.sites {
                let f = body.force().get(s.site)[load.axis].to_f64();
                power -= f * body.v().get(s.site)[load.axis].to_f64() * s.volume;
            }
        }
        power
    }
    /// Sums of squares of the reactions of the supports and of the body forces, (f V)² and (b V)²
    /// in N², at time `time`.
    pub fn squares<T: Real, const D: usize>(
        &self,
        body: &impl Dynamics<T, D>,
        time: f64,
    ) -> (f64, f64) {
        let unit = body.unit();
        let sum = |loads: &[BoundLoad], value: &dyn Fn(&BoundLoad, usize) -> f64| -> f64 {
            let of = |load: &BoundLoad| -> f64 {
                load.sites.iter().map(|s| (value(load, s.site) * s.volume).powi(2)).sum()
            };
            loads.iter().map(of).sum()
        };
        let force =
            |load: &BoundLoad, site: usize| body.force().get(site)[load.axis].to_f64() / unit;
        (sum(&self.supports, &force), sum(&self.forces, &|load, _| load.value.at(time)))
    }
    /// Number of prescribed velocities.
    pub fn velocities(&self) -> usize {
        self.supports.iter().filter(|load| load.kind == Kind::Velocity).count()
    }
    /// Kinetic energy of the prescribed components in J.
    pub fn support_kinetic_energy<T: Real, const D: usize>(
        &self,
        body: &impl Dynamics<T, D>,
    ) -> f64 {
        let mut energy = 0.0;
        for load in &self.supports {
            for s in &load.sites {
                let v = body.v().get(s.site)[load.axis].to_f64();
                energy += 0.5 * v * v / body.inverse_mass(s.site).to_f64() * s.volume;
            }
        }
        energy
    }
}
