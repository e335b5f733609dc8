//! Static solutions: one file per property.
mod blocks;
#[path = "../common/mod.rs"]
mod common;
mod errors;
mod exact;
mod large;
mod oracle;
mod threads;
