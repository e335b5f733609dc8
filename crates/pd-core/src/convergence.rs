//! Convergence studies: how the error falls, and what it costs, as the lattice or the horizon
//! shrinks.
//!
//! - m-convergence: δ fixed, m = δ/Δx grows. The sums become integrals; the error tends to that of
//!   the nonlocal model.
//! - δ-convergence: m fixed, δ = m Δx shrinks. The nonlocal model becomes the local one, but the
//!   error of the quadrature stays.
//! - δm-convergence: δ shrinks and m grows. Both errors go.
//!
//! ```
//! use pd_core::convergence::{Measured, Study, delta_convergence};
//! let study = Study::run(&delta_convergence(3.0, &[4e-3, 2e-3, 1e-3])?, |resolution| {
//!     // Build and solve a body with this Δx and δ, and compare it with what is known.
//!     let error = 1e3 * resolution.horizon().powi(2);
//!     Ok::<_, pd_core::Error>(Measured { error, nodes: 100 })
//! })?;
//! assert!((study.order().expect("errors fall") - 2.0).abs() < 1e-12);
//! println!("{study}");
//! # Ok::<(), pd_core::Error>(())
//! ```

use crate::{Error, Result};
use std::fmt;
use std::time::Instant;

/// Spacing and horizon of one member of a study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Spacing Δx in metres.
    pub spacing: f64,
    /// Ratio m = δ/Δx.
    pub ratio: f64,
}

impl Resolution {
    /// From Δx in metres and m.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless both are finite and positive.
    pub fn new(spacing: f64, ratio: f64) -> Result<Self> {
        let spacing = Error::positive("spacing Δx [m]", spacing)?;
        Ok(Self { spacing, ratio: Error::positive("horizon ratio m = δ/Δx", ratio)? })
    }
    /// Horizon δ = m Δx in metres.
    pub fn horizon(&self) -> f64 {
        self.ratio * self.spacing
    }
}

/// δ fixed (in metres), one member per m.
///
/// # Errors
/// [`Error::InvalidValue`] for a value that is not finite and positive.
pub fn m_convergence(horizon: f64, ratios: &[f64]) -> Result<Vec<Resolution>> {
    ratios.iter().map(|&m| Resolution::new(horizon / m, m)).collect()
}

/// m fixed, one member per Δx in metres.
///
/// # Errors
/// [`Error::InvalidValue`] for a value that is not finite and positive.
pub fn delta_convergence(ratio: f64, spacings: &[f64]) -> Result<Vec<Resolution>> {
    spacings.iter().map(|&dx| Resolution::new(dx, ratio)).collect()
}

/// One member per m, with δ = `horizon` (m₀/m)^`power` in metres, m₀ being the first m: δ shrinks as
/// m grows, the faster the larger the power.
///
/// # Errors
/// [`Error::InvalidValue`] for a value that is not finite and positive.
pub fn delta_m_convergence(horizon: f64, ratios: &[f64], power: f64) -> Result<Vec<Resolution>> {
    Error::positive("power of δ over 1/m", power)?;
    let first = ratios.first().copied().unwrap_or(1.0);
    ratios.iter().map(|&m| Resolution::new(horizon * (first / m).powf(power) / m, m)).collect()
}

/// What one member of a study gave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The error, in whatever norm and unit the study is about.
    pub error: f64,
    /// Number of nodes.
    pub nodes: usize,
}

/// A member of a study, measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Spacing and horizon.
    pub resolution: Resolution,
    /// Error and size.
    pub measured: Measured,
    /// Wall time in seconds.
    pub seconds: f64,
    /// Order of the error in Δx since the row before, ln(e'/e)/ln(Δx'/Δx); none for the first row or
    /// an error of zero.
    pub order: Option<f64>,
}

/// A convergence study.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// One row per member, as given.
    pub rows: Vec<Row>,
}

impl Study {
    /// Measures every member in turn.
    ///
    /// # Errors
    /// What `measure` reports.
    pub fn run<E>(
        members: &[Resolution],
        mut measure: impl FnMut(Resolution) -> std::result::Result<Measured, E>,
    ) -> std::result::Result<Self, E> {
        let mut rows: Vec<Row> = Vec::with_capacity(members.len());
        for &resolution in members {
            let start = Instant::now();
            let measured = measure(resolution)?;
            let seconds = start.elapsed().as_secs_f64();
            let order = rows.last().and_then(|last| {
                let fall = (last.measured.error / measured.error).ln();
                let order = fall / (last.resolution.spacing / resolution.spacing).ln();
                order.is_finite().then_some(order)
            });
            rows.push(Row { resolution, measured, seconds, order });
        }
        Ok(Self { rows })
    }
    /// Order of the error in Δx between the first and the last member.
    pub fn order(&self) -> Option<f64> {
        let (first, last) = (self.rows.first()?, self.rows.last()?);
        let fall = (first.measured.error / last.measured.error).ln();
        let order = fall / (first.resolution.spacing / last.resolution.spacing).ln();
        order.is_finite().then_some(order)
    }
}

/// A table: Δx, m, δ, nodes, error, order, seconds.
impl fmt::Display for Study {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Δx [m] | m | δ [m] | nodes | error | order | time [s]")?;
        for row in &self.rows {
            let Row { resolution, measured, seconds, order } = row;
            let order = order.map_or("–".to_owned(), |order| format!("{order:.2}"));
            let (dx, m, delta) = (resolution.spacing, resolution.ratio, resolution.horizon());
            let (nodes, error) = (measured.nodes, measured.error);
            writeln!(
                f,
                "{dx:.3e} | {m} | {delta:.3e} | {nodes} | {error:.3e} | {order} | {seconds:.2}"
            )?;
        }
        Ok(())
    }
}
