//! Linear statics: matrix-free preconditioned Krylov iterations.
//!
//! Wanted is the u with K u = b on every free component, where K u = −f(u) are the forces of the
//! body (exactly, for a material that [is linear](crate::Material::LINEAR); else −∂f/∂u about the
//! reference configuration by central differences) and b the body forces. Multiplied by the nodes'
//! volumes, K is symmetric for every elastic body, and conjugate gradients solve it; with layers
//! that [mirror](Loads::displacement_at) the body it is not, and stabilised bi-conjugate gradients
//! (van der Vorst 1992) take two evaluations an iteration. Prescribed components keep their value. No
//! matrix is stored: one iteration is one evaluation of the forces, and the preconditioner holds
//! the inverse of the D × D block of K of every node. Sums run in a fixed order, so that the result
//! is bitwise the same for any number of threads.
//!
//! ```text
//! let loads = Loads::new().clamp::<2>(&left).body_force(&right, 0, 1e9);
//! let solved = Statics::new().solve(&mut body, loads)?;
//! println!("{} iterations, u = {}", solved.iterations, body.displacement(17));
//! ```

use crate::body::Dynamics;
use crate::field::{Field, map_sites};
use crate::loads::{Bound, Loads};
use crate::parallel::{axpy, axpy_weighted, sum_in_order, zip_pieces};
use crate::time_step::softest_wave;
use crate::tridiagonal::Tridiagonal;
use crate::{Error, Real, Result};
use nalgebra::{DMatrix, SMatrix, SVector};

/// Probing displacements are ε to this power, in units of Δx: a central difference errs by their
/// square, and by ε over them where a material adds 1 to H.
const STEP: f64 = 0.4;
/// A direction that is held less than this fraction of the best held one is free.
const FREE: f64 = 1e-12;
/// A solution whose error may be as large as itself is none.
const KNOWN: f64 = 1.0;

/// A solver of static problems.
#[derive(Debug, Clone, Copy, Default)]
pub struct Statics {
    tolerance: Option<f64>,
    iterations: Option<usize>,
}

/// Where an iteration stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Iterations done.
    pub iteration: usize,
    /// ‖r‖/‖r₀‖, r₀ being the unbalanced forces with nothing but the prescribed displacements.
    pub residual: f64,
}

/// The end of a solution; the displacements are in the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solved {
    /// Iterations done.
    pub iterations: usize,
    /// ‖r‖/‖r₀‖, of the forces evaluated anew.
    pub residual: f64,
    /// How far the displacements may be off: ‖u − u*‖/‖u‖ in the norm of energy (u·VKu)^½, u* being
    /// the exact solution.
    ///
    /// ‖u − u*‖² ≤ r·M⁻¹r/λ with the preconditioner M and the smallest eigenvalue λ of M⁻¹VK, which
    /// is estimated from the iteration itself, as it is one of Lanczos too. Where the stiffness has
    /// a condition of 10¹⁰ a residual of 10⁻¹⁰ says little of the softest motions.
    /// None with layers that mirror the body, whose operator has no norm of energy.
    pub error: Option<f64>,
}

impl Statics {
    /// With a relative residual of √ε of the body's scalars (1.5e-8 in f64, 3.5e-4 in f32) and at
    /// most 20 000 iterations.
    pub fn new() -> Self {
        Self::default()
    }
    /// Relative residual ‖r‖/‖r₀‖ at which the iteration ends.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] outside (0, 1).
    pub fn with_tolerance(mut self, tolerance: f64) -> Result<Self> {
        let ok = tolerance > 0.0 && tolerance < 1.0;
        let need = "between 0 and 1, both excluded";
        self.tolerance = Some(Error::check(ok, "tolerance of the residual", tolerance, need)?);
        Ok(self)
    }
    /// Largest number of iterations.
    pub fn with_iterations(mut self, iterations: usize) -> Self {
        self.iterations = Some(iterations);
        self
    }

    /// Puts the displacements that balance `loads` (at t = 0) into the body. Its forces are then
    /// those of a [`Run`](crate::Run), loads included, so that
    /// [`reaction`](crate::run::reaction) gives the forces of the supports.
    ///
    /// # Errors
    /// What [`Loads::bind`] refuses, and prescribed velocities; [`Error::FreeRigidMotion`],
    /// [`Error::IndefiniteOperator`], [`Error::NotConverged`], [`Error::IllConditioned`]; what the
    /// material reports.
    pub fn solve<T: Real, const D: usize>(
        &self,
        body: &mut impl Dynamics<T, D>,
        loads: Loads,
    ) -> Result<Solved> {
        self.solve_watched(body, loads, |_| {})
    }

    /// As [`solve`](Self::solve); calls `watch` after every iteration. On an error the body keeps the
    /// displacements it had.
    ///
    /// # Errors
    /// As [`solve`](Self::solve).
    pub fn solve_watched<T: Real, const D: usize>(
        &self,
        body: &mut impl Dynamics<T, D>,
        loads: Loads,
        mut watch: impl FnMut(Progress),
    ) -> Result<Solved> {
        let before = body.u().clone();
        let mut solved = loads.bind(body).and_then(|loads| self.iterate(body, &loads, &mut watch));
        if let Err(Error::IndefiniteOperator { wave, .. }) = &mut solved {
            *wave = softest_wave(body)?;
        }
        if solved.is_err() {
            *body.u_mut() = before;
            body.evaluate()?;
        }
        solved
    }

    fn iterate<T: Real, const D: usize>(
        &self,
        body: &mut impl Dynamics<T, D>,
        loads: &Bound,
        watch: &mut dyn FnMut(Progress),
    ) -> Result<Solved> {
        let operator = Operator::new(body, loads)?;
        let tolerance = self.tolerance.unwrap_or(T::EPSILON.sqrt());
        let limit = self.iterations.unwrap_or(20_000);
        let sites = operator.weights.len();
        let inverse = operator.inverse_blocks(body)?;

        // With the free components at rest, r₀ = V b − V K u.
        let mut u = Field::zeros(sites);
        *body.u_mut() = Field::zeros(sites);
        loads.place(body, 0.0);
        std::mem::swap(body.u_mut(), &mut u);
        *body.force_mut() = Field::zeros(sites);
        loads.add_forces(body, 0.0);
        let mut b = Field::zeros(sites);
        operator.weigh(body.force(), 1.0, &mut b);

        let [mut r, mut q] = std::array::from_fn(|_| Field::zeros(sites));
        let mut progress = Progress { iteration: 0, residual: 1.0 };
        let (mut first, mut last) = (0.0, f64::INFINITY);
        let mut softest = f64::INFINITY;
        // The updated residual drifts from the true one by rounding: start again from that.
        loop {
            operator.apply(body, &u, &mut q)?;
            r.as_mut_slice().copy_from_slice(b.as_slice());
            axpy(r.as_mut_slice(), -T::one(), q.as_slice());
            let norm = dot(&r, &r).sqrt();
            first = if progress.iteration == 0 { norm } else { first };
            progress.residual = if norm == 0.0 { 0.0 } else { norm / first };
            let Progress { iteration, residual } = progress;
            if residual <= tolerance {
                break;
            }
            let stuck = residual.is_nan() || residual > 0.5 * last;
            if stuck || iteration >= limit {
                return Err(Error::NotConverged { residual, tolerance, iterations: iteration });
            }
            last = residual;
            let mut goes_on = |norm: f64| {
                progress.iteration += 1;
                progress.residual = norm / first;
                watch(progress);
                progress.residual > tolerance && progress.iteration < limit
            };
            let system = (&operator, &inverse);
            if operator.mirrored.is_empty() {
                let seen = conjugate_gradients(system, body, &mut u, &mut r, &mut goes_on)?;
                softest = softest.min(seen);
            } else {
                bi_conjugate_gradients(system, body, &mut u, &mut r, &mut goes_on)?;
            }
        }
        *body.u_mut() = u;
        body.evaluate()?;
        let Progress { iteration, residual } = progress;
        let symmetric = operator.mirrored.is_empty();
        let error = symmetric.then(|| operator.error(body, (&inverse, &r), softest));
        if let Some(error) = error.filter(|&error| error > KNOWN) {
            return Err(Error::IllConditioned { error, residual, softest });
        }
        loads.add_forces(body, 0.0);
        Ok(Solved { iterations: iteration, residual, error })
    }
}

/// An operator and the inverse of every node's own block of it.
type System<'a, T, const D: usize> = (&'a Operator<T>, &'a Field<T, SMatrix<T, D, D>>);

/// Improves u with the residual r while `goes_on` with the norm of r after every iteration; returns
/// the smallest eigenvalue of M⁻¹VK that it has seen.
fn conjugate_gradients<T: Real, const D: usize>(
    (operator, inverse): System<'_, T, D>,
    body: &mut impl Dynamics<T, D>,
    u: &mut Vectors<T, D>,
    r: &mut Vectors<T, D>,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<f64> {
    // That of the Lanczos iteration which this one is: T_jj = 1/α_j + β_(j−1)/α_(j−1) and
    // T_j,j+1 = √β_j/α_j.
    let (mut lanczos, mut carried) = (Tridiagonal::default(), 0.0);
    let [mut z, mut q] = std::array::from_fn(|_| Field::zeros(r.len()));
    map_sites((inverse, &*r), &mut z, |(m, r), _| m * r);
    let (mut p, mut rz) = (z.clone(), dot(r, &z));
    let mut iteration = 0;
    loop {
        iteration += 1;
        operator.apply(body, &p, &mut q)?;
        let curvature = dot(&p, &q);
        if curvature <= 0.0 {
            return Err(operator.indefinite(body, &p, curvature, iteration));
        }
        let alpha = rz / curvature;
        axpy(u.as_mut_slice(), T::of(alpha), p.as_slice());
        axpy(r.as_mut_slice(), T::of(-alpha), q.as_slice());
        lanczos.diagonal.push(1.0 / alpha + carried);
        let more = goes_on(dot(r, r).sqrt());
        map_sites((inverse, &*r), &mut z, |(m, r), _| m * r);
        let next = dot(r, &z);
        let beta = next / rz;
        lanczos.beside.push(beta.sqrt() / alpha);
        if !more {
            return Ok(lanczos.smallest());
        }
        carried = beta / alpha;
        xpby(z.as_slice(), T::of(beta), p.as_mut_slice());
        rz = next;
    }
}

/// The same for an operator that is not symmetric: stabilised bi-conjugate gradients. Ends early
/// where they break down. They would find an equilibrium that is not stable too: a direction with a
/// negative curvature is refused.
fn bi_conjugate_gradients<T: Real, const D: usize>(
    (operator, inverse): System<'_, T, D>,
    body: &mut impl Dynamics<T, D>,
    u: &mut Vectors<T, D>,
    r: &mut Vectors<T, D>,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<()> {
    let [mut z, mut v, mut t] = std::array::from_fn(|_| Field::zeros(r.len()));
    let mut iteration = 0;
    // out = A z with z = M q.
    let mut apply = |body: &mut _, q: &Vectors<T, D>, z: &mut Vectors<T, D>, out: &mut _| {
        iteration += 1;
        map_sites((inverse, q), z, |(m, q), _| m * q);
        operator.mirror(z);
        operator.apply(body, z, out)?;
        let curvature = dot(z, out);
        if curvature < 0.0 {
            return Err(operator.indefinite(body, z, curvature, iteration));
        }
        Ok(())
    };
    let (shadow, mut p) = (r.clone(), r.clone());
    let mut rho = dot(&shadow, r);
    loop {
        apply(body, &p, &mut z, &mut v)?;
        let alpha = rho / dot(&shadow, &v);
        axpy(u.as_mut_slice(), T::of(alpha), z.as_slice());
        axpy(r.as_mut_slice(), T::of(-alpha), v.as_slice());
        apply(body, r, &mut z, &mut t)?;
        let square = dot(&t, &t);
        let omega = if square > 0.0 { dot(&t, r) / square } else { 0.0 };
        axpy(u.as_mut_slice(), T::of(omega), z.as_slice());
        axpy(r.as_mut_slice(), T::of(-omega), t.as_slice());
        let next = dot(&shadow, r);
        let beta = next / rho * alpha / omega;
        if !goes_on(dot(r, r).sqrt()) || !beta.is_finite() {
            return Ok(());
        }
        axpy(p.as_mut_slice(), T::of(-omega), v.as_slice());
        xpby(r.as_slice(), T::of(beta), p.as_mut_slice());
        rho = next;
    }
}

/// V K with the prescribed components taken out.
struct Operator<T> {
    /// Volume of every site over the largest one; 0 where no node is.
    weights: Vec<T>,
    /// Places of the prescribed components in the node arrays.
    held: Vec<usize>,
    /// Places of the components that mirror another, and of their images.
    mirrored: Vec<(usize, usize)>,
    linear: bool,
    unit: f64,
}

type Vectors<T, const D: usize> = Field<T, SVector<T, D>>;

impl<T: Real> Operator<T> {
    fn new<const D: usize>(body: &impl Dynamics<T, D>, loads: &Bound) -> Result<Self> {
        let sites = body.u().len();
        let largest = (0..body.nodes()).map(|i| body.volume(i)).fold(0.0, f64::max);
        let mut weights = vec![T::zero(); sites];
        for node in 0..body.nodes() {
            weights[body.site(node)] = T::of(body.volume(node) / largest);
        }
        let held: Vec<usize> =
            loads.held()?.into_iter().map(|(site, axis)| axis * sites + site).collect();
        let mut is_held = vec![false; D * sites];
        held.iter().for_each(|&i| is_held[i] = true);
        require_held(body, |node, axis| is_held[axis * sites + body.site(node)])?;
        let place = |(site, image, axis)| (axis * sites + site, axis * sites + image);
        let mirrored = loads.mirrored().into_iter().map(place).collect();
        Ok(Self { weights, held, mirrored, linear: body.is_linear(), unit: body.unit() })
    }

    /// out = factor · V · force on the free components, 0 on the others.
    fn weigh<const D: usize>(&self, force: &Vectors<T, D>, factor: f64, out: &mut Vectors<T, D>) {
        axpy_weighted(out.as_mut_slice(), T::of(factor), &self.weights, force.as_slice());
        self.held.iter().for_each(|&i| out.as_mut_slice()[i] = T::zero());
    }

    /// Gives components that mirror another the negative of it: a change of u that keeps ū.
    fn mirror<const D: usize>(&self, q: &mut Vectors<T, D>) {
        let q = q.as_mut_slice();
        self.mirrored.iter().for_each(|&(own, image)| q[own] = -q[image]);
    }

    /// out = V K q on the free components, 0 on the others; K q = −f(q), or for a material that
    /// is not linear −(f(h q) − f(−h q))/2h.
    fn apply<const D: usize>(
        &self,
        body: &mut impl Dynamics<T, D>,
        q: &Vectors<T, D>,
        out: &mut Vectors<T, D>,
    ) -> Result<()> {
        out.as_mut_slice().fill(T::zero());
        let (signs, step): (&[f64], f64) = if self.linear {
            (&[1.0], 1.0)
        } else {
            let largest = q.as_slice().iter().map(|x| x.to_f64().abs()).fold(0.0, f64::max);
            (&[1.0, -1.0], if largest > 0.0 { T::EPSILON.powf(STEP) / largest } else { 1.0 })
        };
        for sign in signs {
            let factor = T::of(sign * step);
            zip_pieces(body.u_mut().as_mut_slice(), q.as_slice(), &|u, q| {
                u.iter_mut().zip(q).for_each(|(u, q)| *u = factor * *q);
            });
            body.evaluate()?;
            self.weigh(body.force(), -sign / (step * signs.len() as f64), out);
        }
        Ok(())
    }

    /// The inverse of every node's own block of V K.
    fn inverse_blocks<const D: usize>(
        &self,
        body: &impl Dynamics<T, D>,
    ) -> Result<Field<T, SMatrix<T, D, D>>> {
        let sites = self.weights.len();
        let mut blocks = body.diagonal_blocks();
        let mut held = vec![[false; D]; sites];
        self.held.iter().for_each(|i| held[i % sites][i / sites] = true);
        for node in 0..body.nodes() {
            let site = body.site(node);
            let block = blocks.get(site) * self.weights[site];
            let free = SMatrix::<T, D, D>::from_fn(|i, j| {
                let coupled = !(held[site][i] || held[site][j]);
                if coupled {
                    (block[(i, j)] + block[(j, i)]) * T::of(0.5)
                } else if i == j {
                    T::one()
                } else {
                    T::zero()
                }
            });
            let curvature = (0..D).map(|i| free[(i, i)].to_f64()).fold(f64::INFINITY, f64::min);
            let inverse = free.try_inverse().filter(|_| curvature > 0.0);
            let curvature = curvature / self.unit.powi(2);
            let (wave, iteration) = (Vec::new(), 0);
            let indefinite = Error::IndefiniteOperator { curvature, node, wave, iteration };
            blocks.set(site, inverse.ok_or(indefinite)?);
        }
        Ok(blocks)
    }

    /// (r·M⁻¹r/λ)^½ over the norm of the body's u, in the norm of energy.
    fn error<const D: usize>(
        &self,
        body: &impl Dynamics<T, D>,
        (inverse, r): (&Field<T, SMatrix<T, D, D>>, &Vectors<T, D>),
        softest: f64,
    ) -> f64 {
        let [mut z, mut q] = std::array::from_fn(|_| Field::zeros(r.len()));
        map_sites((inverse, r), &mut z, |(m, r), _| m * r);
        axpy_weighted(q.as_mut_slice(), -T::one(), &self.weights, body.force().as_slice());
        let (left, energy) = (dot(r, &z), dot(body.u(), &q));
        if left == 0.0 { 0.0 } else { (left / softest / energy.max(0.0)).sqrt() }
    }

    fn indefinite<const D: usize>(
        &self,
        body: &impl Dynamics<T, D>,
        p: &Vectors<T, D>,
        curvature: f64,
        iteration: usize,
    ) -> Error {
        let size = |node: &usize| p.get(body.site(*node)).map(Real::to_f64).norm_squared();
        let node = (0..body.nodes()).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
        let curvature = curvature / dot(p, p) / self.unit.powi(2);
        Error::IndefiniteOperator { curvature, node, wave: Vec::new(), iteration }
    }
}

/// Σ a·b over all sites, in a fixed order.
fn dot<T: Real, const D: usize>(a: &Vectors<T, D>, b: &Vectors<T, D>) -> f64 {
    let (a, b) = (a.as_slice(), b.as_slice());
    sum_in_order(a.len(), |i| a[i].to_f64() * b[i].to_f64())
}

/// y = x + b y.
fn xpby<T: Real>(x: &[T], b: T, y: &mut [T]) {
    zip_pieces(y, x, &|y, x| y.iter_mut().zip(x).for_each(|(y, x)| *y = *x + b * *y));
}

/// Refuses a body with a part, connected by intact bonds, that the prescribed components leave
/// free to move as a whole.
///
/// A rigid motion m is held if Σ m² over the held components of the part is positive: the Gram
/// matrix of the D translations and D(D−1)/2 rotations over these components must be regular.
fn require_held<T: Real, const D: usize>(
    body: &impl Dynamics<T, D>,
    held: impl Fn(usize, usize) -> bool,
) -> Result<()> {
    let mut seen = vec![false; body.nodes()];
    for first in 0..body.nodes() {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut part = vec![first];
        let mut next = 0;
        while next < part.len() {
            body.visit_neighbours(part[next], &mut |n| {
                if n.intact && !seen[n.node] {
                    seen[n.node] = true;
                    part.push(n.node);
                }
            });
            next += 1;
        }
        if let Some(motion) = free_motion(body, &part, &held) {
            return Err(Error::FreeRigidMotion { node: first, nodes: part.len(), motion });
        }
    }
    Ok(())
}

fn free_motion<T: Real, const D: usize>(
    body: &impl Dynamics<T, D>,
    part: &[usize],
    held: impl Fn(usize, usize) -> bool,
) -> Option<String> {
    let count = part.len() as f64;
    let centre = part.iter().fold(SVector::zeros(), |s, &i| s + body.position(i)) / count;
    let size = part.iter().map(|&i| (body.position(i) - centre).norm()).fold(body.unit(), f64::max);
    let pairs: Vec<(usize, usize)> = (0..D).flat_map(|i| (i + 1..D).map(move |j| (i, j))).collect();
    let modes = D + pairs.len();
    let mut gram = DMatrix::<f64>::zeros(modes, modes);
    let mut row = vec![0.0; modes];
    for &node in part {
        let x = (body.position(node) - centre) / size;
        for axis in (0..D).filter(|&axis| held(node, axis)) {
            row.fill(0.0);
            row[axis] = 1.0;
            for (k, &(i, j)) in pairs.iter().enumerate() {
                // The rotation takes axis i towards axis j.
                row[D + k] = if axis == i {
                    -x[j]
                } else if axis == j {
                    x[i]
                } else {
                    0.0
                };
            }
            for a in 0..modes {
                for b in 0..modes {
                    gram[(a, b)] += row[a] * row[b];
                }
            }
        }
    }
    let eigen = gram.symmetric_eigen();
    let softest = eigen.eigenvalues.imin();
    if eigen.eigenvalues[softest] > FREE * eigen.eigenvalues.max() {
        return None;
    }
    let motion = eigen.eigenvectors.column(softest).iamax();
    let name = |axis: usize| ["x", "y", "z"].get(axis).copied().unwrap_or("?");
    Some(match motion.checked_sub(D) {
        None => format!("translation along {}", name(motion)),
        Some(k) => format!("rotation from {} to {}", name(pairs[k].0), name(pairs[k].1)),
    })
}
