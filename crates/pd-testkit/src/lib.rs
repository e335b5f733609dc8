//! Problems with known solutions, for tests, benches and examples. Not published.
pub mod oracle;
