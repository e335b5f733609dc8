//! The shape tensor K = Σ ω ξ⊗ξ βV and what to do where it cannot be inverted.

use crate::bond::Neighbourhood;
use crate::{Error, Result};
use nalgebra::{Matrix3, SMatrix, SVector};

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
    /// [`Error::SingularShapeTensor`] under [`IllConditioned::Refuse`]; [`Error::InvalidNodeValue`]
    /// for a K that is not finite, as with a weight that is not.
    pub fn invert<const D: usize>(
        &self,
        k: &SMatrix<f64, D, D>,
        node: usize,
        neighbours: usize,
    ) -> Result<SMatrix<f64, D, D>> {
        let scale = k.trace();
        if !scale.is_finite() {
            let (what, need) = ("trace of the shape tensor K", "finite: check the weights ω");
            return Err(Error::InvalidNodeValue { node, what, value: scale, need });
        }
        // One fixed size serves 2D and 3D: unused axes get the eigenvalue −1, which no shape
        // tensor has. Without a bond K stays zero.
        let unit = if scale > 0.0 { scale } else { 1.0 };
        let embedded = Matrix3::from_fn(|i, j| match (i < D && j < D, i == j) {
            (true, _) => k[(i, j)] / unit,
            (false, true) => -1.0,
            (false, false) => 0.0,
        });
        let eigen = embedded.symmetric_eigen();
        let used = (0..3).filter(|&a| eigen.eigenvalues[a] > -0.5);
        let largest = eigen.eigenvalues.max();
        let condition_of = |a: usize| match eigen.eigenvalues[a] {
            value if value > 0.0 => largest / value,
            _ => f64::INFINITY,
        };
        let condition = used.clone().map(condition_of).fold(0.0, f64::max);
        // A direction without bonds has no inverse even where no limit is set.
        let limit = self.limit.min(f64::MAX);
        if condition > limit {
            match self.rule {
                IllConditioned::Refuse => {
                    return Err(Error::SingularShapeTensor { node, condition, limit, neighbours });
                }
                IllConditioned::Detach => return Ok(SMatrix::zeros()),
                IllConditioned::PseudoInverse => {}
            }
        }
        // By eigenvectors, not cofactors, which lose twice as many digits as K is ill-conditioned.
        Ok(used.filter(|&a| condition_of(a) <= limit).fold(SMatrix::zeros(), |b, a| {
            let axis = SVector::<f64, D>::from_fn(|d, _| eigen.eigenvectors[(d, a)]);
            b + axis * axis.transpose() / (eigen.eigenvalues[a] * unit)
        }))
    }
}
