//! Static solutions: one file per property.
mod blocks;
mod boundary_layers;
#[path = "../common/mod.rs"]
mod common;
mod errors;
mod exact;
mod large;
mod oracle;
mod threads;
