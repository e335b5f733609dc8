//! Damage criteria for bonds, ways to combine them, and measures of the cracks they make.
pub mod bond_energy;
pub mod calibration;
pub mod combine;
pub mod crack_opening;
pub mod crack_path;
pub mod critical_stretch;
pub mod measures;
pub mod tsai_hill;

pub use bond_energy::{
    BondEnergy, EnergyCriterion, LocalEnergy, ModeEnergies, PowerLaw, Separated, Uniform,
};
pub use calibration::{BondModel, BondStrength, CrackPlane, FractureEnergy, FractureToughness};
pub use combine::{AnyOf, CriterionExt, Either, Interfaces, Sparing};
pub use crack_opening::CrackOpening;
pub use crack_path::{CrackPath, CrackTip, LineFit, Mirror, TipTrack};
pub use critical_stretch::{CriticalStretch, LocalStretch};
pub use measures::Measures;
pub use tsai_hill::{Signs, Strengths, Strengths3, TsaiHill, TsaiHill3};
