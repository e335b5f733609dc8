//! Peridynamic bodies: grids, families, integrity, time integration and the plugin traits.
pub mod body;
pub mod bond;
pub mod cloud;
pub mod crack;
pub mod damage;
pub mod error;
pub mod family;
mod gauss;
pub mod grid;
pub mod influence;
pub mod integrator;
pub mod lattice;
pub mod loads;
pub mod material;
pub mod points;
pub mod quadrature;
pub mod real;
pub mod record;
pub mod region;
pub mod run;
pub mod search;
pub mod shape;
pub mod time_step;

pub use error::{Error, Result};
pub use real::Real;
