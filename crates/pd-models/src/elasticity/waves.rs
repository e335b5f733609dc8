//! Plane waves of the classical continuum (Christoffel).

use super::Stiffness;
use nalgebra::{Matrix3, SVector};

/// A plane wave: speed c in m/s and polarisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave<const D: usize> {
    /// Phase speed in m/s.
    pub speed: f64,
    /// Unit polarisation.
    pub polarisation: SVector<f64, D>,
}

impl<const D: usize> Stiffness<D> {
    /// The D waves along `direction`, fastest first: ρc²p = Γp with Γ_ik = C_ijkl n_j n_l.
    pub fn waves(&self, direction: &SVector<f64, D>, density: f64) -> Vec<Wave<D>> {
        let n = direction.normalize();
        let gamma = Matrix3::from_fn(|i, k| {
            if i >= D || k >= D {
                return if i == k { -1.0 } else { 0.0 };
            }
            let mut sum = 0.0;
            for j in 0..D {
                for l in 0..D {
                    sum += self.c(i, j, k, l) * n[j] * n[l];
                }
            }
            sum
        });
        let eigen = gamma.symmetric_eigen();
        let mut waves: Vec<Wave<D>> = (0..3)
            .filter(|&a| eigen.eigenvalues[a] > 0.0)
            .map(|a| Wave {
                speed: (eigen.eigenvalues[a] / density).sqrt(),
                polarisation: SVector::from_fn(|d, _| eigen.eigenvectors[(d, a)]),
            })
            .collect();
        waves.sort_by(|a, b| b.speed.total_cmp(&a.speed));
        waves
    }
    /// The fastest wave over all directions in m/s (errata 000-15: not √(C22/ρ)).
    pub fn max_wave_speed(&self, density: f64) -> f64 {
        let fastest = |n: &SVector<f64, D>| self.waves(n, density)[0].speed;
        let mut best = (0.0, SVector::zeros());
        let directions = 40;
        for a in 0..2 * directions {
            for b in 0..if D == 3 { directions } else { 1 } {
                let t = std::f64::consts::PI * a as f64 / directions as f64;
                let p = std::f64::consts::FRAC_PI_2 * (1.0 - b as f64 / directions as f64);
                let p = if D == 3 { p } else { std::f64::consts::FRAC_PI_2 };
                let n = SVector::from_fn(|d, _| match d {
                    0 => p.sin() * t.cos(),
                    1 => p.sin() * t.sin(),
                    _ => p.cos(),
                });
                let speed = fastest(&n);
                if speed > best.0 {
                    best = (speed, n);
                }
            }
        }
        // Downhill steps from the best direction, halved until they gain nothing.
        let mut step = 0.1;
        while step > 1e-9 {
            let moved = (0..2 * D)
                .map(|k| {
                    let mut n = best.1;
                    n[k / 2] += if k % 2 == 0 { step } else { -step };
                    (fastest(&n.normalize()), n.normalize())
                })
                .fold(best, |a, b| if b.0 > a.0 { b } else { a });
            if moved.0 > best.0 {
                best = moved;
            } else {
                step *= 0.5;
            }
        }
        best.0
    }
}
