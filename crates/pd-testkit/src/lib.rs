//! Problems with known solutions, for tests, benches and examples. Not published.
pub mod fem;
pub mod generate;
pub mod graded_wave;
pub mod infinite_plate;
pub mod oracle;
pub mod quads;
pub mod specimen;
