//! What can go wrong, with the numbers that say why.

/// Result of every fallible call of this crate.
pub type Result<X, E = Error> = std::result::Result<X, E>;

/// Error of `pd-core`. Every variant names the value or the node and what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number is outside its admissible range.
    #[error("{what} is {value}, but must be {need}")]
    InvalidValue {
        /// The quantity, with its symbol.
        what: &'static str,
        /// The value given.
        value: f64,
        /// The admissible range.
        need: &'static str,
    },
}

impl Error {
    /// `value` if `ok`, else [`Error::InvalidValue`].
    pub fn check(ok: bool, what: &'static str, value: f64, need: &'static str) -> Result<f64> {
        if ok { Ok(value) } else { Err(Self::InvalidValue { what, value, need }) }
    }

    /// `value` if it is finite and positive.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] otherwise.
    pub fn positive(what: &'static str, value: f64) -> Result<f64> {
        Self::check(value.is_finite() && value > 0.0, what, value, "finite and positive")
    }
}
