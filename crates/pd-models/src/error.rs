//! What can go wrong with a material, with the numbers that say why.

/// Result of every fallible call of this crate.
pub type Result<X, E = Error> = std::result::Result<X, E>;

/// Error of `pd-models`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Poisson's ratio is not the one the model has.
    #[error(
        "Poisson's ratio is {given}, but a bond-based material in {mode} has {own}: use the linear \
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
        "the stiffness is not symmetric positive definite: its smallest eigenvalue is \
         {eigenvalue:e} Pa (largest {largest:e} Pa), so some strain would cost no energy or release \
         it. Check signs, units and the Voigt order (xx, yy, xy or xx, yy, zz, yz, xz, xy)"
    )]
    NotPositiveDefinite {
        /// The smallest eigenvalue in Pa (of the Mandel matrix).
        eigenvalue: f64,
        /// The largest one in Pa.
        largest: f64,
    },
    /// A Poisson's ratio is too large for the Young's moduli of its axes.
    #[error(
        "Poisson's ratio {what} is {value}, but its magnitude must be below {bound} = {limit}, or \
         some strain would release energy (a value above may be that of the other order: \
         ν_ij E_j = ν_ji E_i)"
    )]
    PoissonBound {
        /// Symbol of the ratio.
        what: &'static str,
        /// The value given.
        value: f64,
        /// The bound in symbols.
        bound: &'static str,
        /// Its value.
        limit: f64,
    },
    /// Poisson's ratios that are admissible one by one, but not together.
    #[error(
        "ν12, ν13 and ν23 are admissible one by one, but not together: \
         1 − ν12ν21 − ν13ν31 − ν23ν32 − 2ν21ν32ν13 is {determinant:e}, but must be positive, or \
         some strain would release energy"
    )]
    PoissonRatios {
        /// The determinant of the compliance over the product of its diagonal.
        determinant: f64,
    },
    /// An error of the core.
    #[error(transparent)]
    Core(#[from] pd_core::Error),
}
