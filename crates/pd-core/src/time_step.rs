//! The largest stable time step of a body, 2/ω_max, from its own linearised operator.
//!
//! The bulk value is not safe for a body: free surfaces and cracks change it. A Lanczos iteration
//! (power iteration that keeps what it has learned) on M⁻¹K finds ω_max of the body as it is,
//! broken bonds included; the lattice symbol and the classical estimates stand beside it.

use crate::body::Dynamics;
use crate::parallel::{map_pieces, sum_in_order};
use crate::symbol::Symbol;
use crate::tridiagonal::Tridiagonal;
use crate::{Error, Real, Result};
use nalgebra::{DVector, SVector};
use std::f64::consts::PI;
use std::fmt;

/// Largest number of Lanczos steps.
const STEPS: usize = 80;
/// Relative accuracy of ω_max² asked for.
const TOLERANCE: f64 = 1e-3;
/// Amplitude of the probing displacements in units of Δx: small against the bonds, and as
/// displacements are stored (not positions) nothing cancels.
const AMPLITUDE: f64 = 1e-6;

/// Wave vectors per axis among which the wave of an unstable body is sought, in 2D and in 3D.
const WAVES: [usize; 2] = [48, 16];

/// Extremes of the spectrum of M⁻¹K of a body about its reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Upper estimate of ω_max² in 1/s² (Ritz value plus its residual).
    pub largest: f64,
    /// Lowest Ritz value in 1/s²: clearly negative for an unstable (indefinite) operator.
    pub lowest: f64,
    /// Residual of the largest Ritz value relative to it.
    pub residual: f64,
}

impl Spectrum {
    /// Critical time step of the explicit schemes, 2/ω_max, in seconds.
    pub fn critical_time_step(&self) -> f64 {
        2.0 / self.largest.sqrt()
    }
}

/// Pseudo-random numbers in (−1, 1), the same in every run.
fn noise(i: usize) -> f64 {
    let mut x = (i as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// K q / ρ by central difference of the forces about u = 0.
pub(crate) fn apply<T: Real, const D: usize, B: Dynamics<T, D>>(
    body: &mut B,
    q: &[SVector<f64, D>],
    out: &mut [SVector<f64, D>],
) -> Result<()> {
    let size = q.iter().map(nalgebra::SVector::amax).fold(0.0, f64::max);
    let step = AMPLITUDE / size;
    out.iter_mut().for_each(|o| *o = SVector::zeros());
    for sign in [1.0, -1.0] {
        for (node, q) in q.iter().enumerate() {
            let site = body.site(node);
            body.u_mut().set(site, (q * (sign * step)).map(T::of));
        }
        body.evaluate()?;
        for (node, out) in out.iter_mut().enumerate() {
            let site = body.site(node);
            let weight = -sign / (2.0 * step) * body.inverse_mass(site).to_f64();
            *out += body.force().get(site).map(|f| f.to_f64() * weight);
        }
    }
    Ok(())
}

/// Extremes of the spectrum of M⁻¹K by a Lanczos iteration in the mass inner product. The body's
/// motion is untouched.
///
/// # Errors
/// What the evaluation of forces reports.
pub fn spectrum<T: Real, const D: usize, B: Dynamics<T, D>>(body: &mut B) -> Result<Spectrum> {
    in_peace(body, |body| Ok(ritz(&lanczos(body, |_| ())?)))
}

/// Refuses a body with a clearly negative ω²: a motion that grows at any time step, like those of
/// polynomial micromoduli of strongly anisotropic plies. `found` is the body's own spectrum; where
/// forces derive from an energy its lowest Ritz value is never below the true one, so nothing
/// stable is refused. A body that is only slightly unstable may pass: ask the [`Symbol`].
///
/// # Errors
/// [`Error::UnstableBody`] with ω² and the wave, and what the evaluation of forces reports.
pub fn require_stable<T: Real, const D: usize, B: Dynamics<T, D>>(
    body: &mut B,
    found: &Spectrum,
) -> Result<()> {
    // What rounding makes of a zero-energy mode is far smaller than its square root.
    if found.lowest >= -T::EPSILON.sqrt() * found.largest {
        return Ok(());
    }
    Err(Error::UnstableBody {
        eigenvalue: found.lowest,
        wave: softest_wave(body)?,
        growth_rate: (-found.lowest).sqrt(),
    })
}

/// The wave vector in 1/m that the softest motion of a body (the lowest Ritz vector) has most of.
pub(crate) fn softest_wave<T: Real, const D: usize, B: Dynamics<T, D>>(
    body: &mut B,
) -> Result<Vec<f64>> {
    let motion = in_peace(body, lowest_motion)?;
    Ok(dominant_wave(body, &motion).iter().copied().collect())
}

/// Probes a body and puts its motion back.
pub(crate) fn in_peace<T: Real, const D: usize, B: Dynamics<T, D>, X>(
    body: &mut B,
    probe: impl FnOnce(&mut B) -> Result<X>,
) -> Result<X> {
    let saved = (body.u().clone(), body.force().clone());
    let result = probe(body);
    *body.u_mut() = saved.0;
    body.evaluate()?;
    *body.force_mut() = saved.1;
    result
}

/// The motion of the lowest Ritz value: the same iteration again, as its vectors are not kept.
fn lowest_motion<T: Real, const D: usize, B: Dynamics<T, D>>(
    body: &mut B,
) -> Result<Vec<SVector<f64, D>>> {
    let (values, vectors) = lanczos(body, |_| ())?.eigen();
    let share: DVector<f64> = vectors.column(values.imin()).into_owned();
    let mut motion = vec![SVector::zeros(); body.nodes()];
    let mut step = 0;
    lanczos(body, |q| {
        motion.iter_mut().zip(q).for_each(|(y, q)| *y += q * share[step]);
        step += 1;
    })?;
    Ok(motion)
}

/// The wave vector k in 1/m, among those of a sampled Brillouin zone, that a motion has most of:
/// largest |Σ y exp(−ik·x)| over the middle of the body, as wide as the samples can tell apart.
fn dominant_wave<T: Real, const D: usize, B: Dynamics<T, D>>(
    body: &B,
    motion: &[SVector<f64, D>],
) -> SVector<f64, D> {
    let (samples, unit) = (WAVES[usize::from(D == 3)], body.unit());
    let n = body.nodes();
    let middle = (0..n).map(|i| body.position(i)).sum::<SVector<f64, D>>() / n as f64;
    let width = 0.5 * samples as f64 * unit;
    let mut near: Vec<(SVector<f64, D>, SVector<f64, D>)> =
        (0..n).map(|i| (body.position(i) - middle, motion[i])).collect();
    if near.iter().filter(|(x, _)| x.amax() < width).count() > samples {
        near.retain(|(x, _)| x.amax() < width);
    }
    // D(−k) = D(k), so half of the zone is enough: the last component is not negative.
    let wave = |index: usize| {
        SVector::<f64, D>::from_fn(|d, _| {
            let place = (index / samples.pow(d as u32) % samples) as f64 / samples as f64;
            let phase = if d == D - 1 { PI * place } else { PI * (2.0 * place - 1.0) };
            phase / unit
        })
    };
    let content = |k: &SVector<f64, D>| {
        let (mut even, mut odd) = (SVector::<f64, D>::zeros(), SVector::<f64, D>::zeros());
        for (x, y) in &near {
            let (sin, cos) = k.dot(x).sin_cos();
            even += y * cos;
            odd += y * sin;
        }
        even.norm_squared() + odd.norm_squared()
    };
    let contents: Vec<f64> = map_pieces(samples.pow(D as u32), samples, &|piece| {
        piece.map(|index| content(&wave(index))).collect::<Vec<f64>>()
    })
    .flatten()
    .collect();
    wave(DVector::from_vec(contents).imax())
}

/// Calls `visit` with every vector of the iteration.
fn lanczos<T: Real, const D: usize, B: Dynamics<T, D>>(
    body: &mut B,
    mut visit: impl FnMut(&[SVector<f64, D>]),
) -> Result<Tridiagonal> {
    let n = body.nodes();
    let masses: Vec<f64> = (0..n).map(|node| body.mass(node)).collect();
    let dot = |a: &[SVector<f64, D>], b: &[SVector<f64, D>]| {
        sum_in_order(n, |i| masses[i] * a[i].dot(&b[i]))
    };
    let mut q: Vec<SVector<f64, D>> =
        (0..n).map(|i| SVector::from_fn(|d, _| noise(D * i + d))).collect();
    let norm = dot(&q, &q).sqrt();
    q.iter_mut().for_each(|q| *q /= norm);
    let mut previous = vec![SVector::zeros(); n];
    let mut w = previous.clone();
    let mut found = Tridiagonal::default();
    let last = STEPS.min(D * n);
    for step in 1..=last {
        visit(&q);
        apply(body, &q, &mut w)?;
        let alpha = dot(&w, &q);
        let back = found.beside.last().copied().unwrap_or(0.0);
        for i in 0..n {
            w[i] -= q[i] * alpha + previous[i] * back;
        }
        let beta = dot(&w, &w).sqrt();
        let what = "force density of a small displacement of the body";
        Error::check(beta.is_finite(), what, beta, "finite")?;
        found.diagonal.push(alpha);
        found.beside.push(beta);
        let exhausted = beta <= 1e-12 * found.diagonal[0].abs().max(alpha.abs());
        if exhausted || (step % 5 == 0 && ritz(&found).residual < TOLERANCE) {
            break;
        }
        std::mem::swap(&mut previous, &mut q);
        for i in 0..n {
            q[i] = w[i] / beta;
        }
    }
    Ok(found)
}

fn ritz(found: &Tridiagonal) -> Spectrum {
    let (values, vectors) = found.eigen();
    let (top, k) = (values.imax(), found.diagonal.len());
    let residual = found.beside[k - 1] * vectors[(k - 1, top)].abs();
    Spectrum {
        largest: values[top] + residual,
        lowest: values.min(),
        residual: residual / values[top].abs(),
    }
}

/// The stable time step of a body beside what other ways to find it say, all in seconds. Print it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeStepEstimates {
    /// 2/ω_max of the body itself: the one that counts.
    pub body: f64,
    /// 2/ω_max of the infinite lattice ([`Symbol::critical_time_step`]): free surfaces and cracks
    /// lower it.
    pub bulk: f64,
    /// Gershgorin's bound on the ω_max of the infinite lattice: never above `bulk`.
    pub gershgorin: f64,
    /// Silling and Askari 2005, √(2ρ / Σ C V) with the stiffness C V of a bond of any material:
    /// the force that the displacement of one end gives the other.
    pub silling_askari: f64,
    /// δ/c with the fastest wave of the continuum: above the limit of PMB and LPS.
    pub courant: f64,
    /// 0.01 δ/c (Hattori 2018).
    pub hattori: f64,
}

impl TimeStepEstimates {
    /// For a body, the symbol of its material and the speed c in m/s of the fastest wave of the
    /// continuum (`Stiffness::max_wave_speed` of `pd-models`).
    ///
    /// # Errors
    /// A speed that is not positive, and what the evaluation of forces reports.
    pub fn new<T: Real, const D: usize, B: Dynamics<T, D>>(
        body: &mut B,
        symbol: &Symbol<D>,
        wave_speed: f64,
    ) -> Result<Self> {
        let wave_speed = Error::positive("speed of the fastest wave c [m/s]", wave_speed)?;
        let horizon = body.horizon() * body.unit();
        Ok(Self {
            body: spectrum(body)?.critical_time_step(),
            bulk: symbol.critical_time_step(),
            gershgorin: symbol.gershgorin_time_step(),
            silling_askari: classical::silling_askari(symbol.density(), symbol.stiffness_sum()),
            courant: classical::courant(horizon, wave_speed),
            hattori: classical::hattori(horizon, wave_speed),
        })
    }
}

impl fmt::Display for TimeStepEstimates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "stable time step            s   of the body's")?;
        let mut line =
            |name: &str, step: f64| writeln!(f, "{name:<22} {step:9.3e} {:9.3}", step / self.body);
        line("this body, 2/ω_max", self.body)?;
        line("infinite lattice", self.bulk)?;
        line("Gershgorin's bound", self.gershgorin)?;
        line("Silling and Askari", self.silling_askari)?;
        line("δ/c", self.courant)?;
        line("Hattori, 0.01 δ/c", self.hattori)
    }
}

/// Classical estimates of the stable time step, for comparison.
pub mod classical {
    /// Hattori 2018: 0.01 δ/c with the wave speed c in m/s.
    pub fn hattori(horizon: f64, wave_speed: f64) -> f64 {
        0.01 * horizon / wave_speed
    }
    /// δ/c_max: unsafe for PMB and LPS (their limit is 0.66–0.70 of it).
    pub fn courant(horizon: f64, wave_speed: f64) -> f64 {
        horizon / wave_speed
    }
    /// Silling and Askari 2005 for bond-based materials: √(2ρ / Σ c V/|ξ|), with the sum over a
    /// family; `stiffness_sum` is Σ c V/|ξ| in N/m⁴.
    pub fn silling_askari(density: f64, stiffness_sum: f64) -> f64 {
        (2.0 * density / stiffness_sum).sqrt()
    }
}
