//! The elasticity tensor C_ijkl, symmetric positive definite by construction.

use super::voigt::{voigt_axes, voigt_components, voigt_index};
use crate::{Error, Result};
use nalgebra::{Matrix3, Matrix6, SMatrix};
use pd_core::Real;
use std::array::from_fn;

/// Asymmetry accepted, relative to the largest entry.
const SYMMETRY: f64 = 1e-12;
/// Smallest eigenvalue accepted, relative to the largest: what rounding can tell from 0.
const DEFINITE: f64 = 1e-14;

/// C_ijkl by axes.
type Tensor<const D: usize> = [[[[f64; D]; D]; D]; D];

/// Stiffness of a D-dimensional body in Pa: any symmetric positive definite elasticity tensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness<const D: usize> {
    tensor: Tensor<D>,
}

impl<const D: usize> Stiffness<D> {
    /// From Voigt entries, checked.
    pub(super) fn from_entries(entry: impl Fn(usize, usize) -> f64) -> Result<Self> {
        let n = voigt_components(D);
        let mut largest = 0.0_f64;
        for r in 0..n {
            for c in 0..n {
                let (what, value) = ("entry of the stiffness [Pa]", entry(r, c));
                pd_core::Error::check(value.is_finite(), what, value, "finite")?;
                largest = largest.max(value.abs());
            }
        }
        for r in 0..n {
            for c in r + 1..n {
                let (upper, lower) = (entry(r, c), entry(c, r));
                if (upper - lower).abs() > SYMMETRY * largest {
                    return Err(Error::NotSymmetric { row: r, column: c, upper, lower });
                }
            }
        }
        let stiffness = Self::symmetrised(entry);
        let (eigenvalue, largest) = stiffness.extreme_eigenvalues();
        if eigenvalue <= DEFINITE * largest.abs() {
            return Err(Error::NotPositiveDefinite { eigenvalue, largest });
        }
        Ok(stiffness)
    }

    /// From Voigt entries, with exactly the symmetries C_ijkl = C_jikl = C_klij.
    pub(super) fn symmetrised(entry: impl Fn(usize, usize) -> f64) -> Self {
        let mean = |r, c| 0.5 * (entry(r, c) + entry(c, r));
        let v = |i, j| voigt_index(D, i, j);
        let tensor = from_fn(|i| {
            from_fn(|j| from_fn(|k| from_fn(|l| mean(v(i, j).min(v(k, l)), v(i, j).max(v(k, l))))))
        });
        Self { tensor }
    }

    /// Smallest and largest eigenvalue of the Mandel matrix: those of C as a map of tensors.
    fn extreme_eigenvalues(&self) -> (f64, f64) {
        let n = voigt_components(D);
        let factor = |r: usize| if r < D { 1.0 } else { std::f64::consts::SQRT_2 };
        // One fixed size serves both dimensions: in 2D it holds the matrix twice.
        let mandel = Matrix6::from_fn(|r, c| {
            let (a, b) = (r % n, c % n);
            if r / n == c / n { factor(a) * factor(b) * self.entry(a, b) } else { 0.0 }
        });
        let values = mandel.symmetric_eigenvalues();
        (values.min(), values.max())
    }

    /// Entry of the Voigt matrix.
    pub(super) fn entry(&self, row: usize, column: usize) -> f64 {
        let ((i, j), (k, l)) = (voigt_axes(D, row), voigt_axes(D, column));
        self.tensor[i][j][k][l]
    }

    /// C_ijkl in Pa, axes from 0.
    #[inline(always)]
    pub fn c(&self, i: usize, j: usize, k: usize, l: usize) -> f64 {
        self.tensor[i][j][k][l]
    }

    /// σ = C:ε for a symmetric strain tensor (its upper triangle is read). No branch, and cast in
    /// place: a copy with entries of type `T` is not faster.
    #[inline(always)]
    pub fn contract<T: Real>(&self, strain: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let mut stress = SMatrix::zeros();
        for i in 0..D {
            for j in i..D {
                let c = &self.tensor[i][j];
                let mut sum = T::zero();
                for k in 0..D {
                    sum += T::of(c[k][k]) * strain[(k, k)];
                    for l in k + 1..D {
                        sum += T::of(2.0 * c[k][l]) * strain[(k, l)];
                    }
                }
                stress[(i, j)] = sum;
                stress[(j, i)] = sum;
            }
        }
        stress
    }

    /// Energy density ½ ε:C:ε in J/m³ for a symmetric strain tensor.
    pub fn energy(&self, strain: &SMatrix<f64, D, D>) -> f64 {
        0.5 * self.contract(strain).dot(strain)
    }

    /// The material turned by R: C'_ijkl = R_im R_jn R_ko R_lp C_mnop (errata 000-13, 000-14).
    pub(super) fn turned(&self, r: &SMatrix<f64, D, D>) -> Self {
        // One index at a time; each pass turns the first index and moves it last.
        let mut tensor = self.tensor;
        for _ in 0..4 {
            let old = tensor;
            let turn = |i, j: usize, k: usize, l: usize| -> f64 {
                (0..D).map(|m| r[(i, m)] * old[m][j][k][l]).sum()
            };
            tensor = from_fn(|j| from_fn(|k| from_fn(|l| from_fn(|i| turn(i, j, k, l)))));
        }
        let turned = Self { tensor };
        Self::symmetrised(|r, c| turned.entry(r, c))
    }
}

impl Stiffness<2> {
    /// From the plane stiffness matrix in Pa, order xx, yy, xy, engineering shear.
    ///
    /// # Errors
    /// Not finite, not symmetric (to 1e-12 of the largest entry), not positive definite.
    pub fn from_voigt(c: Matrix3<f64>) -> Result<Self> {
        Self::from_entries(|r, s| c[(r, s)])
    }
    /// From the 6 constants C11, C12, C16, C22, C26, C66 in Pa (upper triangle, row by row).
    ///
    /// # Errors
    /// Not finite, not positive definite.
    pub fn from_components(c: [f64; 6]) -> Result<Self> {
        let row = [0, 3, 5];
        Self::from_entries(|r, s| c[row[r.min(s)] + r.abs_diff(s)])
    }
    /// The Voigt matrix in Pa.
    pub fn voigt(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|r, c| self.entry(r, c))
    }
}

impl Stiffness<3> {
    /// From the stiffness matrix in Pa, order xx, yy, zz, yz, xz, xy, engineering shears.
    ///
    /// # Errors
    /// Not finite, not symmetric (to 1e-12 of the largest entry), not positive definite.
    pub fn from_voigt(c: Matrix6<f64>) -> Result<Self> {
        Self::from_entries(|r, s| c[(r, s)])
    }
    /// From the 21 constants C11, C12, …, C16, C22, …, C66 in Pa (upper triangle, row by row).
    ///
    /// # Errors
    /// Not finite, not positive definite.
    pub fn from_components(c: [f64; 21]) -> Result<Self> {
        let row = [0, 6, 11, 15, 18, 20];
        Self::from_entries(|r, s| c[row[r.min(s)] + r.abs_diff(s)])
    }
    /// The Voigt matrix in Pa.
    pub fn voigt(&self) -> Matrix6<f64> {
        Matrix6::from_fn(|r, c| self.entry(r, c))
    }
}
