//! The symmetric tridiagonal matrix that a Lanczos iteration leaves, or one of conjugate gradients.

use nalgebra::{DMatrix, DVector};

/// Its eigenvalues approach those of the operator from within.
#[derive(Debug, Default)]
pub(crate) struct Tridiagonal {
    pub diagonal: Vec<f64>,
    /// Beside the diagonal; the last one leads out of the matrix.
    pub beside: Vec<f64>,
}

impl Tridiagonal {
    /// All eigenvalues and vectors, as of a dense matrix: for short iterations.
    pub fn eigen(&self) -> (DVector<f64>, DMatrix<f64>) {
        let k = self.diagonal.len();
        let eigen = DMatrix::from_fn(k, k, |i, j| match i.abs_diff(j) {
            0 => self.diagonal[i],
            1 => self.beside[i.min(j)],
            _ => 0.0,
        })
        .symmetric_eigen();
        (eigen.eigenvalues, eigen.eigenvectors)
    }
    /// True if no eigenvalue is below `shift`: every pivot of T − shift is positive.
    fn all_above(&self, shift: f64) -> bool {
        let mut coupling = 0.0;
        self.diagonal.iter().zip(&self.beside).all(|(diagonal, beside)| {
            let pivot = diagonal - shift - coupling;
            coupling = beside * beside / pivot;
            pivot > 0.0
        })
    }
    /// The smallest eigenvalue of a positive definite matrix of any size, by bisection from above;
    /// infinite if it has no row. (nalgebra has eigenvalues of dense matrices only.)
    pub fn smallest(&self) -> f64 {
        let mut above = self.diagonal.iter().copied().fold(f64::INFINITY, f64::min);
        let mut below = above;
        while below > 0.0 && !self.all_above(below) {
            (above, below) = (below, 0.5 * below);
        }
        for _ in 0..20 {
            let middle = 0.5 * (above + below);
            *(if self.all_above(middle) { &mut below } else { &mut above }) = middle;
        }
        below
    }
}
