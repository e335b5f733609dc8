//! Peridynamic material models: bond-based, ordinary state-based (isotropic and with any
//! stiffness), correspondence.
pub mod anisotropic;
pub mod bond_associated;
pub mod bond_based;
pub mod correspondence;
pub mod elasticity;
pub mod error;
pub mod kinematics;
pub mod linear_solid;
pub mod ordinary;
pub mod probe;
pub mod regions;
pub mod strained;
pub mod surface;

pub use anisotropic::{PolynomialMicromoduli, PositiveSplit};
pub use bond_associated::BondAssociated;
pub use bond_based::{BondBased, BondLaw, Pmb, PmbOnFamily};
pub use correspondence::{
    Constitutive, Correspondence, Hyperelastic, LinearElastic, NeoHookean, NoControl,
    SaintVenantKirchhoff, SillingControl, WanControl, ZeroEnergyControl,
};
pub use elasticity::{
    Intensity, Isotropic, Lamina, OpeningFit, Orthotropic, PlaneMode, Stiffness, Stroh,
    TransverselyIsotropic, Wave,
};
pub use error::{Error, Result};
pub use kinematics::{Finite, Kinematics, Linearised};
pub use linear_solid::{LinearSolid, MadenciOterkus, MadenciOterkusPrinted};
pub use ordinary::{Ordinary, ScalarState, SplitState};
pub use probe::elasticity_tensor;
pub use regions::{Mixed, Regions};
pub use strained::Strained;
pub use surface::OnFamily;
