//! Plane waves of the classical continuum (Christoffel).

use super::Stiffness;
use crate::Result;
use nalgebra::{Matrix3, SMatrix, SVector};
use pd_core::Error;

/// A plane wave: speed c in m/s and polarisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave<const D: usize> {
    /// Phase speed c in m/s.
    pub speed: f64,
    /// Unit polarisation (its sign is arbitrary).
    pub polarisation: SVector<f64, D>,
}

impl<const D: usize> Stiffness<D> {
    /// Acoustic (Christoffel) tensor Γ_ik = C_ijkl n_j n_l of a unit direction n, in Pa.
    pub fn acoustic(&self, n: &SVector<f64, D>) -> SMatrix<f64, D, D> {
        SMatrix::from_fn(|i, k| {
            let row = |j: usize| -> f64 { (0..D).map(|l| self.c(i, j, k, l) * n[l]).sum() };
            (0..D).map(|j| n[j] * row(j)).sum()
        })
    }
    /// Eigenvalues ρc² and eigenvectors of Γ, largest first.
    fn christoffel(&self, n: &SVector<f64, D>) -> [(f64, SVector<f64, D>); D] {
        // One fixed size serves 2D and 3D: the axis that is not there gets a negative eigenvalue,
        // which comes last because Γ is positive definite.
        let acoustic = self.acoustic(n);
        let gamma = Matrix3::from_fn(|i, k| match (i.max(k) < D, i == k) {
            (true, _) => acoustic[(i, k)],
            (false, true) => -1.0,
            (false, false) => 0.0,
        });
        let eigen = gamma.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        std::array::from_fn(|a| {
            let vector = SVector::from_fn(|d, _| eigen.eigenvectors[(d, order[a])]);
            (eigen.eigenvalues[order[a]], vector)
        })
    }

    /// The D waves along `direction` (of any length) in a body of density ρ in kg/m³, fastest
    /// first: ρc² p = Γ p with Γ_ik = C_ijkl n_j n_l.
    ///
    /// # Errors
    /// A direction without a finite positive length, a density that is not finite and positive.
    pub fn waves(&self, direction: &SVector<f64, D>, density: f64) -> Result<[Wave<D>; D]> {
        Error::positive("density ρ [kg/m³]", density)?;
        Error::positive("length of the wave's direction", direction.norm())?;
        let modes = self.christoffel(&direction.normalize());
        Ok(modes
            .map(|(value, polarisation)| Wave { speed: (value / density).sqrt(), polarisation }))
    }

    /// The fastest wave over all directions in m/s (errata 000-15: not √(C22/ρ)).
    ///
    /// # Errors
    /// A density that is not finite and positive.
    pub fn max_wave_speed(&self, density: f64) -> Result<f64> {
        Error::positive("density ρ [kg/m³]", density)?;
        // C_ijkl p_i n_j p_k n_l is the same with p and n exchanged, so the polarisation of the
        // fastest wave along n is a direction with a wave at least as fast: climb from many.
        let starts = 5_usize.pow(D as u32);
        let climb = |start: usize| {
            let digit = |d: usize| (start / 5_usize.pow(d as u32) % 5) as f64 - 2.0;
            let n = SVector::<f64, D>::from_fn(|d, _| digit(d));
            if start == starts / 2 {
                return 0.0; // the zero vector
            }
            let (mut value, mut n) = self.christoffel(&n.normalize())[0];
            for _ in 0..1000 {
                let (higher, next) = self.christoffel(&n)[0];
                let gain = higher - value;
                (value, n) = (value.max(higher), next);
                if gain <= 1e-15 * value {
                    break;
                }
            }
            value
        };
        Ok(((0..starts).map(climb).fold(0.0, f64::max) / density).sqrt())
    }
}
