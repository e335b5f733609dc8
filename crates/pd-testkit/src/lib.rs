//! Problems with known solutions, for tests, benches and examples. Not published.
pub mod beam;
pub mod clock;
pub mod dsif;
pub mod fem;
pub mod generate;
pub mod graded_wave;
pub mod hattori61;
pub mod infinite_plate;
pub mod oracle;
pub mod plane_wave;
pub mod quads;
pub mod scabbia63;
pub mod specimen;
