//! The largest stable time step of a body, 2/ω_max, from its own linearised operator.
//!
//! The bulk value is not safe for a body: free surfaces and cracks change it. A Lanczos iteration
//! (power iteration that keeps what it has learned) on M⁻¹K finds ω_max of the body as it is,
//! broken bonds included; the lattice symbol and the classical estimates stand beside it.

use crate::body::Dynamics;
use crate::{Real, Result};
use nalgebra::{DMatrix, SVector};

/// Largest number of Lanczos steps.
const STEPS: usize = 80;
/// Relative accuracy of ω_max² asked for.
const TOLERANCE: f64 = 1e-3;
/// Amplitude of the probing displacements in units of Δx: small against the bonds, and as
/// displacements are stored (not positions) nothing cancels.
const AMPLITUDE: f64 = 1e-6;

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
fn apply<T: Real, const D: usize, B: Dynamics<T, D>>(
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
    let saved = (body.u().clone(), body.force().clone());
    let result = lanczos(body);
    *body.u_mut() = saved.0;
    body.evaluate()?;
    *body.force_mut() = saved.1;
    result
}

fn lanczos<T: Real, const D: usize, B: Dynamics<T, D>>(body: &mut B) -> Result<Spectrum> {
    let n = body.nodes();
    let masses: Vec<f64> = (0..n).map(|node| body.mass(node)).collect();
    let dot = |a: &[SVector<f64, D>], b: &[SVector<f64, D>]| {
        crate::body::sum_in_order(n, |i| masses[i] * a[i].dot(&b[i]))
    };
    let mut q: Vec<SVector<f64, D>> =
        (0..n).map(|i| SVector::from_fn(|d, _| noise(D * i + d))).collect();
    let norm = dot(&q, &q).sqrt();
    q.iter_mut().for_each(|q| *q /= norm);
    let mut previous = vec![SVector::zeros(); n];
    let mut w = previous.clone();
    let (mut alphas, mut betas): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut found = Spectrum { largest: 0.0, lowest: 0.0, residual: 0.0 };
    for step in 1..=STEPS.min(D * n) {
        apply(body, &q, &mut w)?;
        let alpha = dot(&w, &q);
        let back = betas.last().copied().unwrap_or(0.0);
        for i in 0..n {
            w[i] -= q[i] * alpha + previous[i] * back;
        }
        let beta = dot(&w, &w).sqrt();
        alphas.push(alpha);
        let exhausted = beta <= 1e-12 * alphas[0].abs().max(alpha.abs());
        if step % 5 == 0 || exhausted || step == STEPS.min(D * n) {
            found = ritz(&alphas, &betas, beta);
            if exhausted || found.residual < TOLERANCE {
                break;
            }
        }
        betas.push(beta);
        std::mem::swap(&mut previous, &mut q);
        for i in 0..n {
            q[i] = w[i] / beta;
        }
    }
    Ok(found)
}

fn ritz(alphas: &[f64], betas: &[f64], beta: f64) -> Spectrum {
    let k = alphas.len();
    let tridiagonal = DMatrix::from_fn(k, k, |i, j| match i.abs_diff(j) {
        0 => alphas[i],
        1 => betas[i.min(j)],
        _ => 0.0,
    });
    let eigen = tridiagonal.symmetric_eigen();
    let top = eigen.eigenvalues.imax();
    let value = eigen.eigenvalues[top];
    let residual = beta * eigen.eigenvectors[(k - 1, top)].abs();
    Spectrum {
        largest: value + residual,
        lowest: eigen.eigenvalues.min(),
        residual: residual / value.abs(),
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
