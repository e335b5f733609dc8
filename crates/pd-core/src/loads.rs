//! Boundary conditions and loads on node sets.

use crate::body::Dynamics;
use crate::grid::NodeSet;
use crate::search::neighbours;
use crate::time_step::{apply, in_peace};
use crate::{Error, Real, Result};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use std::collections::HashSet;
use std::sync::Arc;

/// The image of a node is at most this far from a node, in units of Δx.
const APART: f64 = 1e-6;

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

/// A plane face of a body, on which displacements and tractions act as in a local theory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face<const D: usize> {
    point: SVector<f64, D>,
    normal: SVector<f64, D>,
}

impl<const D: usize> Face<D> {
    /// Through a point in metres, with a normal of any length that points out of the body.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a point that is not finite or a normal without length.
    pub fn new(point: [f64; D], normal: [f64; D]) -> Result<Self> {
        for x in point {
            Error::check(x.is_finite(), "point of a face [m]", x, "finite")?;
        }
        let normal = SVector::from(normal);
        Error::positive("length of a face's normal", normal.norm())?;
        Ok(Self { point: point.into(), normal: normal.normalize() })
    }
    /// How far inside the face a place is, in metres; negative outside.
    pub fn depth(&self, x: &SVector<f64, D>) -> f64 {
        self.normal.dot(&(self.point - x))
    }
    /// The mirror image of a place, in metres.
    pub fn image(&self, x: &SVector<f64, D>) -> SVector<f64, D> {
        x + self.normal * (2.0 * self.depth(x))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Displacement,
    Velocity,
    BodyForce,
    Traction,
}

struct Load {
    kind: Kind,
    nodes: NodeSet,
    axis: usize,
    /// Point and normal of the face on which it acts.
    face: Option<[Vec<f64>; 2]>,
    value: Arc<dyn TimeFunction>,
}

impl Load {
    fn face<const D: usize>(&self) -> Result<Option<Face<D>>> {
        let Some([point, normal]) = &self.face else { return Ok(None) };
        let need = "the dimension of the body";
        Error::check(point.len() == D, "dimension of a face", point.len() as f64, need)?;
        let vector = |x: &[f64]| SVector::from_column_slice(x);
        Ok(Some(Face { point: vector(point), normal: vector(normal) }))
    }
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
        let (nodes, value) = (nodes.clone(), Arc::new(value));
        self.loads.push(Load { kind, nodes, axis, face: None, value });
        self
    }
    fn at<const D: usize>(mut self, face: &Face<D>) -> Self {
        if let Some(load) = self.loads.last_mut() {
            load.face = Some([face.point, face.normal].map(|x| x.as_slice().to_vec()));
        }
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
    /// Prescribes u_axis(t) in metres on a face of the body, by a layer of nodes outside it: each of
    /// `nodes` gets 2ū − u(image), with the displacement of the node at its mirror image, so that u
    /// is ū on the face itself and not, as with [`displacement`](Self::displacement), a layer's
    /// half away from it. Layers two horizons thick leave no trace of their own outer surface;
    /// bond-based bodies need one.
    pub fn displacement_at<const D: usize>(
        self,
        face: &Face<D>,
        nodes: &NodeSet,
        axis: usize,
        value: impl TimeFunction + 'static,
    ) -> Self {
        self.with(Kind::Displacement, nodes, axis, value).at(face)
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
    /// A traction along `axis` on a face at which the body ends, with the resultant `force`(t) in N
    /// (per metre of thickness in 2D unless the body has one), spread over those of `nodes` that are
    /// less than two horizons inside, as bonds would carry it if the body went on: the body forces
    /// with which a homogeneous stress of this traction is in equilibrium up to the last node. A
    /// [body force](Self::body_force) in a layer acts as far inside as half its thickness.
    ///
    /// The body is probed when it is bound: by homogeneous strains, as it is then. The face is taken
    /// to cross a body that is homogeneous along it.
    pub fn traction<const D: usize>(
        self,
        face: &Face<D>,
        nodes: &NodeSet,
        axis: usize,
        force: impl TimeFunction + 'static,
    ) -> Self {
        self.with(Kind::Traction, nodes, axis, force).at(face)
    }
    /// Holds all components of the nodes at u = 0.
    pub fn clamp<const D: usize>(self, nodes: &NodeSet) -> Self {
        (0..D).fold(self, |loads, axis| loads.displacement(nodes, axis, 0.0))
    }

    /// Binds the loads to a body, whose motion stays as it is.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for an axis the body does not have, a node it does not have or a
    /// value that is not finite at t = 0, [`Error::ConflictingConditions`] for a component that is
    /// prescribed twice, [`Error::NoImage`] for a layer without a mirror image in the body, and for
    /// a traction on nodes that pass no force on.
    pub fn bind<T: Real, const D: usize, B: Dynamics<T, D>>(self, body: &mut B) -> Result<Bound> {
        let mut prescribed: HashSet<(usize, usize)> = HashSet::new();
        let mut bound = Bound { supports: Vec::new(), forces: Vec::new() };
        for load in self.loads {
            let (axis, kind, face) = (load.axis, load.kind, load.face::<D>()?);
            Error::check(axis < D, "axis of a load", axis as f64, "a component of the body")?;
            let start = load.value.at(0.0);
            Error::check(start.is_finite(), "value of a load at t = 0", start, "finite")?;
            let supports = matches!(kind, Kind::Displacement | Kind::Velocity);
            for node in load.nodes.iter() {
                Error::check(
                    node < body.nodes(),
                    "node of a load",
                    node as f64,
                    "a node of the body (was the set made for another grid?)",
                )?;
                if supports && !prescribed.insert((node, axis)) {
                    return Err(Error::ConflictingConditions { node, axis });
                }
            }
            let mut bind = |axis, sites| {
                let load = BoundLoad { kind, sites, axis, value: Arc::clone(&load.value) };
                if supports { &mut bound.supports } else { &mut bound.forces }.push(load);
            };
            match face {
                None => bind(axis, load.nodes.iter().map(|node| Site::of(body, node)).collect()),
                Some(face) if supports => {
                    let images = images(body, &face, &load.nodes)?.into_iter();
                    let site = |(node, image): (usize, usize)| Site {
                        // A node on the face is its own image: it gets ū itself.
                        image: (image != node).then(|| body.site(image)),
                        ..Site::of(body, node)
                    };
                    bind(axis, load.nodes.iter().zip(images).map(site).collect());
                }
                Some(face) => {
                    let shares = shares(body, &face, &load.nodes, axis)?;
                    for d in 0..D {
                        let site = |(node, share): &(usize, SVector<f64, D>)| Site {
                            share: share[d],
                            ..Site::of(body, *node)
                        };
                        bind(d, shares.iter().map(site).collect());
                    }
                }
            }
        }
        // Images must be in place before what mirrors them.
        bound.supports.sort_by_key(|load| load.sites.iter().any(|s| s.image.is_some()));
        bound.require_images(body)?;
        Ok(bound)
    }
}

/// The node at the mirror image of every node of a layer.
fn images<T: Real, const D: usize>(
    body: &impl Dynamics<T, D>,
    face: &Face<D>,
    layer: &NodeSet,
) -> Result<Vec<usize>> {
    let (nodes, apart) = (body.nodes(), APART * body.unit());
    let mut places: Vec<SVector<f64, D>> = (0..nodes).map(|i| body.position(i)).collect();
    places.extend(layer.iter().map(|node| face.image(&body.position(node))));
    let near = neighbours(&places, |i| if i < nodes { 0.0 } else { apart });
    let image = |(k, node): (usize, usize)| {
        let found = near.row(nodes + k).iter().map(|&i| i as usize).find(|&i| i < nodes);
        let image = places[nodes + k].as_slice().to_vec();
        found.ok_or(Error::NoImage { node, image })
    };
    layer.iter().enumerate().map(image).collect()
}

/// The body forces in 1/m^D, of resultant 1 along `axis`, that keep the nodes near a face in
/// equilibrium under a homogeneous stress whose traction on the face points along `axis`.
fn shares<T: Real, const D: usize, B: Dynamics<T, D>>(
    body: &mut B,
    face: &Face<D>,
    nodes: &NodeSet,
    axis: usize,
) -> Result<Vec<(usize, SVector<f64, D>)>> {
    let unit = body.unit();
    let reach = 2.0 * body.horizon() * unit;
    let near = |&node: &usize| {
        let depth = face.depth(&body.position(node));
        depth > -APART * unit && depth < reach * (1.0 + APART)
    };
    let near: Vec<usize> = nodes.iter().filter(near).collect();
    // Of all σ with σn = t the one without traction across n: t⊗n + n⊗t − (t·n)n⊗n.
    let (n, mut t) = (face.normal, SVector::<f64, D>::zeros());
    t[axis] = 1.0;
    let wanted = t * n.transpose() + n * t.transpose() - n * n.transpose() * t.dot(&n);

    let pairs: Vec<(usize, usize)> = (0..D).flat_map(|i| (i..D).map(move |j| (i, j))).collect();
    // K of u = H (x − x₀) for every strain: what holds the body in it.
    let mut held: Vec<Vec<SVector<f64, D>>> = Vec::new();
    in_peace(body, |body| {
        for &(i, j) in &pairs {
            let mut h = SMatrix::<f64, D, D>::zeros();
            h[(i, j)] += 0.5;
            h[(j, i)] += 0.5;
            let u = |node| h * (body.position(node) - face.point);
            let u: Vec<_> = (0..body.nodes()).map(u).collect();
            let mut k = vec![SVector::zeros(); u.len()];
            apply(body, &u, &mut k)?;
            for (node, k) in k.iter_mut().enumerate() {
                *k /= body.inverse_mass(body.site(node)).to_f64();
            }
            held.push(k);
        }
        Ok(())
    })?;
    // The mean stress by the virial: ∫σ dV = Σ Ku⊗x V for a body that nothing else holds.
    let stress = DMatrix::from_fn(pairs.len(), pairs.len(), |row, k| {
        let (i, j) = pairs[row];
        let torque = |(node, f): (usize, &SVector<f64, D>)| {
            let x = body.position(node);
            0.5 * (f[i] * x[j] + f[j] * x[i]) * body.volume(node)
        };
        held[k].iter().enumerate().map(torque).sum::<f64>()
    });
    let wanted = DVector::from_fn(pairs.len(), |k, _| wanted[pairs[k]]);
    let mix = stress.lu().solve(&wanted).unwrap_or_else(|| DVector::zeros(pairs.len()));
    let share = |node: usize| {
        let parts = held.iter().zip(mix.iter());
        parts.fold(SVector::zeros(), |sum, (held, part)| sum + held[node] * *part)
    };
    let shares: Vec<_> = near.into_iter().map(|node| (node, share(node))).collect();
    let resultant = shares.iter().map(|(node, b)| b[axis] * body.volume(*node)).sum::<f64>();
    let what = "share of a homogeneous stress that the nodes of a traction carry";
    let need = "positive: are they beside the face, does the body end there, is it held by bonds?";
    Error::check(resultant.is_finite() && resultant > 0.0, what, resultant, need)?;
    Ok(shares.into_iter().map(|(node, b)| (node, b / resultant)).collect())
}

struct Site {
    site: usize,
    volume: f64,
    /// Value at this site over the value of the load.
    share: f64,
    /// The site whose displacement this one mirrors.
    image: Option<usize>,
}

impl Site {
    fn of<T: Real, const D: usize>(body: &impl Dynamics<T, D>, node: usize) -> Self {
        Self { site: body.site(node), volume: body.volume(node), share: 1.0, image: None }
    }
}

struct BoundLoad {
    kind: Kind,
    sites: Vec<Site>,
    axis: usize,
    value: Arc<dyn TimeFunction>,
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
                Kind::Traction => "resultant of a traction [N]",
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
    /// The components that mirror another: (site, site of the image, axis).
    pub(crate) fn mirrored(&self) -> Vec<(usize, usize, usize)> {
        let of = |load: &BoundLoad| -> Vec<_> {
            load.sites.iter().filter_map(|s| Some((s.site, s.image?, load.axis))).collect()
        };
        self.supports.iter().flat_map(of).collect()
    }
    /// Refuses a node that mirrors one which itself mirrors another.
    fn require_images<T: Real, const D: usize>(&self, body: &impl Dynamics<T, D>) -> Result<()> {
        let mirrored = self.mirrored();
        let sites: HashSet<_> = mirrored.iter().map(|&(site, _, axis)| (site, axis)).collect();
        let bad = mirrored.iter().find(|&&(_, image, axis)| sites.contains(&(image, axis)));
        let Some(&(site, image, _)) = bad else { return Ok(()) };
        let node_of = |site| (0..body.nodes()).find(|&node| body.site(node) == site).unwrap_or(0);
        let image = body.position(node_of(image)).as_slice().to_vec();
        Err(Error::NoImage { node: node_of(site), image })
    }
    /// Before the drift from t to t + dt: prescribed components move at the speed that takes them
    /// where they must be at t + dt.
    pub fn hold<T: Real, const D: usize>(&self, body: &mut impl Dynamics<T, D>, t: f64, dt: f64) {
        let unit = body.unit();
        for load in &self.supports {
            let axis = load.axis;
            let (end, middle) = (load.value.at(t + dt) / unit, load.value.at(t + 0.5 * dt) / unit);
            for s in &load.sites {
                let at = |site: usize| {
                    let (u, v) = (body.u().get(site)[axis], body.v().get(site)[axis]);
                    (u.to_f64(), v.to_f64())
                };
                let speed = match load.kind {
                    Kind::Displacement => {
                        let image = s.image.map(at).map(|(u, v)| u + dt * v);
                        (image.map_or(end, |image| 2.0 * end - image) - at(s.site).0) / dt
                    }
                    _ => middle,
                };
                let mut v = body.v().get(s.site);
                v[axis] = T::of(speed);
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
                let image = s.image.map(|image| body.u().get(image)[load.axis]);
                let mut u = body.u().get(s.site);
                u[load.axis] = image.map_or(value, |image| value + value - image);
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
            let value = load.value.at(t) * unit;
            for s in &load.sites {
                let mut f = body.force().get(s.site);
                f[load.axis] += T::of(value * s.share);
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
                power += b * s.share * body.v().get(s.site)[load.axis].to_f64() * unit * s.volume;
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
        let sum = |loads: &[BoundLoad], value: &dyn Fn(&BoundLoad, &Site) -> f64| -> f64 {
            let of = |load: &BoundLoad| -> f64 {
                load.sites.iter().map(|s| (value(load, s) * s.volume).powi(2)).sum()
            };
            loads.iter().map(of).sum()
        };
        let force =
            |load: &BoundLoad, s: &Site| body.force().get(s.site)[load.axis].to_f64() / unit;
        let given = |load: &BoundLoad, s: &Site| load.value.at(time) * s.share;
        (sum(&self.supports, &force), sum(&self.forces, &given))
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
