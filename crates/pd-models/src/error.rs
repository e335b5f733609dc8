//! What can go wrong with a material, with the numbers that say why.

/// Result of every fallible call of this crate.
pub type Result<X, E = Error> = std::result::Result<X, E>;

/// Error of `pd-models`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Poisson's ratio is not the one the model has.
    #[error(
        "Poisson's ratio is {given}, but a bond-based material in {mode} has {own}: use the linear \\
         solid for any other"
    )]
    PoissonRatio {
        /// The value given.
        given: f64,
        /// The model's own.
        own: f64,
        /// Kind of body.
        mode: &'static str,
    },
    /// A stiffness matrix is not symmetric.
    #[error("the stiffness is not symmetric: C[{row}][{column}] = {upper:e}, but {lower:e} across")]
    NotSymmetric {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// Entry above the diagonal, Pa.
        upper: f64,
        /// Entry below the diagonal, Pa.
        lower: f64,
    },
    /// A stiffness is not positive definite.
    #[error(
        "the stiffness is not positive definite: its smallest eigenvalue is {eigenvalue:e} Pa \\
         (largest {largest:e} Pa), so some strain would release energy. {hint}"
    )]
    NotPositiveDefinite {
        /// The smallest eigenvalue in Pa (of the Mandel matrix).
        eigenvalue: f64,
        /// The largest one in Pa.
        largest: f64,
        /// What to look at.
        hint: &'static str,
    },
    /// An error of the core.
    #[error(transparent)]
    Core(#[from] pd_core::Error),
}
