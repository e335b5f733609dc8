//! Elasticity: moduli, stiffness of any anisotropy, rotation, plane stress and strain, waves.
//!
//! Voigt order is xx, yy, xy in 2D and xx, yy, zz, yz, xz, xy in 3D, with engineering shear
//! strains. Fibres at angle +θ are turned counter-clockwise from x (errata 000-13, 000-14).
pub mod catalogue;
mod engineering;
mod moduli;
mod stiffness;
pub mod stroh;
mod transform;
pub mod voigt;
mod waves;

pub use moduli::{Isotropic, Lamina, Orthotropic, PlaneMode, TransverselyIsotropic};
pub use stiffness::Stiffness;
pub use stroh::{Intensity, OpeningFit, Stroh};
pub use waves::Wave;
