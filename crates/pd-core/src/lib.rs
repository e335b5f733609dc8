//! Peridynamic bodies: grids, families, integrity, time integration and the plugin traits.
pub mod error;

pub use error::{Error, Result};
