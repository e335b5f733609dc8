//! Peridynamics
