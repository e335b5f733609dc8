//! Damage criteria for bonds, ways to combine them, and measures of the cracks they make.
pub mod combine;
pub mod crack_path;
pub mod critical_stretch;
pub mod tsai_hill;

pub use combine::{CriterionExt, Interfaces, Sparing};
pub use crack_path::{CrackPath, CrackTip, LineFit};
pub use critical_stretch::CriticalStretch;
pub use tsai_hill::{Signs, Strengths, Strengths3, TsaiHill, TsaiHill3};
