//! Peridynamic bodies: grids, families, integrity, time integration and the plugin traits.
pub mod error;
mod gauss;
pub mod influence;
pub mod quadrature;
pub mod search;

pub use error::{Error, Result};
pub use influence::{Influence, InfluenceFunction};
pub use quadrature::Quadrature;
pub use search::{Rows, neighbours};
