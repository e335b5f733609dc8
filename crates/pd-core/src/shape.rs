//! The shape tensor K = Σ ω ξ⊗ξ βV and what to do where it cannot be inverted.

use crate::bond::Neighbourhood;
use crate::{Error, Result};
use nalgebra::{Matrix3, SMatrix};

/// What happens to a node whose shape tensor is too badly conditioned to be inverted, as after
/// the loss of all but fewer than D independent bonds (errata 000-7: any collinear family).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum IllConditioned {
    /// The run ends with [`Error::SingularShapeTensor`].
    Refuse,
    /// The node is detached: it carries no stress and its bonds break.
    #[default]
    Detach,
    /// B is the inverse on the well-conditioned directions only.
    PseudoInverse,
}

/// Inverts shape tensors by condition number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapePolicy {
    /// What to do beyond the limit.
    pub rule: IllConditioned,
    /// Largest condition number accepted.
    pub limit: f64,
}

impl Default for ShapePolicy {
    /// Detach beyond a condition number of 10⁶ (families of the usual lattices stay below 100).
    fn default() -> Self {
        Self { rule: IllConditioned::Detach, limit: 1e6 }
    }
}

/// K = Σ ω ξ⊗ξ βV in Δx^(D+2), with the weight ω of each member.
pub fn shape_tensor<K: Copy, const D: usize>(
    family: &Neighbourhood<'_, K, D>,
    weight: impl Fn(&K) -> f64,
) -> SMatrix<f64, D, D> {
    family.members.iter().fold(SMatrix::zeros(), |sum, m| {
        sum + m.xi * m.xi.transpose() * (weight(&m.bond) * m.volume)
    })
}

impl ShapePolicy {
    /// B = K⁻¹; zero for a node that is to be detached.
    ///
    /// # Errors
    /// [`Error::SingularShapeTensor`] under [`IllConditioned::Refuse`].
    pub fn invert<const D: usize>(
        &self,
        k: &SMatrix<f64, D, D>,
        node: usize,
        neighbours: usize,
    ) -> Result<SMatrix<f64, D, D>> {
        // One fixed size serves 2D and 3D: unused axes get the eigenvalue −1, which no shape
        // tensor has.
        let scale = k.trace();
        if scale.is_nan() || scale <= 0.0 {
            return match self.rule {
                IllConditioned::Refuse => Err(Error::SingularShapeTensor {
                    node,
                    condition: f64::INFINITY,
                    limit: self.limit,
                    neighbours,
                }),
                _ => Ok(SMatrix::zeros()),
            };
        }
        let embedded = Matrix3::from_fn(|i, j| match (i < D && j < D, i == j) {
            (true, _) => k[(i, j)] / scale,
            (false, true) => -1.0,
            (false, false) => 0.0,
        });
        let eigen = embedded.symmetric_eigen();
        let used = |a: usize| eigen.eigenvalues[a] > -0.5;
        let largest = eigen.eigenvalues.max();
        let smallest =
            (0..3).filter(|&a| used(a)).map(|a| eigen.eigenvalues[a]).fold(f64::INFINITY, f64::min);
        let condition = if smallest > 0.0 { largest / smallest } else { f64::INFINITY };
        let inverse = |keep: &dyn Fn(f64) -> bool| {
            let mut b = SMatrix::<f64, D, D>::zeros();
            for a in (0..3).filter(|&a| used(a) && keep(eigen.eigenvalues[a])) {
                let axis = nalgebra::SVector::<f64, D>::from_fn(|d, _| eigen.eigenvectors[(d, a)]);
                b += axis * axis.transpose() / (eigen.eigenvalues[a] * scale);
            }
            b
        };
        if condition <= self.limit {
            return Ok(k.try_inverse().unwrap_or_else(|| inverse(&|_| true)));
        }
        match self.rule {
            IllConditioned::Refuse => {
                Err(Error::SingularShapeTensor { node, condition, limit: self.limit, neighbours })
            }
            IllConditioned::Detach => Ok(SMatrix::zeros()),
            IllConditioned::PseudoInverse => Ok(inverse(&|value| value * self.limit >= largest)),
        }
    }
}
