#![doc = include_str!("../README.md")]
//!
//! # Criteria that do not fit
//! Tsai–Hill asks for a stress; a bond-based material has none:
//!
//! ```compile_fail,E0277
//! use peridynamics::prelude::*;
//! fn plate(family: Lattice<f64, 2>, moduli: &Isotropic) -> Result<()> {
//!     let mode = PlaneMode::PlaneStress;
//!     let bonds = Pmb::plane(moduli, mode, 2500.0, InfluenceFunction::Constant).unwrap();
//!     let strengths = Strengths { along: 1e9, across: 6e7, shear: 7e7 };
//!     let tsai_hill = TsaiHill::new(&strengths, 0.0)?;
//!     let body = Body::new(family, Ordinary::new(bonds), Breaking::new(tsai_hill))?;
//!     Ok(())
//! }
//! ```
//!
//! The compiler says:
//!
//! ```text
//! error[E0277]: `Ordinary<Pmb>` has no stress at a node, so a stress-based criterion cannot use it
//!   |
//! 8 |     let body = Body::new(family, Ordinary::new(bonds), Breaking::new(tsai_hill))?;
//!   |                ^^^^ this material gives no stress
//!   |
//!   = note: use a criterion on bonds (critical stretch, bond energy), or a correspondence or state-based material whose nodes have a strain
//! ```
//!
//! Willberg's criteria by mode ask for a dilatation, which bonds alone do not have:
//!
//! ```compile_fail,E0277
//! use peridynamics::prelude::*;
//! fn plate(family: Lattice<f64, 2>, moduli: &Isotropic, modes: ModeEnergies) -> Result<()> {
//!     let mode = PlaneMode::PlaneStress;
//!     let bonds = Pmb::plane(moduli, mode, 2500.0, InfluenceFunction::Constant).unwrap();
//!     // error: `Ordinary<Pmb>` does not tell volumetric from deviatoric bond energy
//!     let body = Body::new(family, Ordinary::new(bonds), Breaking::new(PowerLaw::new(modes)))?;
//!     Ok(())
//! }
//! ```
//!
//! With a correspondence material the first lines compile:
//!
//! ```no_run
//! use peridynamics::prelude::*;
//! fn plate(family: Lattice<f64, 2>, stiffness: Stiffness<2>) -> Result<()> {
//!     let law = LinearElastic(stiffness);
//!     let material = Correspondence::new(law, 2500.0, InfluenceFunction::Linear).unwrap();
//!     let strengths = Strengths { along: 1e9, across: 6e7, shear: 7e7 };
//!     let tsai_hill = TsaiHill::new(&strengths, 0.0)?;
//!     let body = Body::new(family, material, Breaking::new(tsai_hill))?;
//!     Ok(())
//! }
//! ```
//! # The time step
//! `TimeStep::Safety(0.8)` takes that share of the body's own critical step, found from its own
//! operator, so that free surfaces and cracks count. To see it beside the infinite lattice and the
//! estimates of books:
//!
//! ```
//! use peridynamics::prelude::*;
//! # fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
//! let (dx, density, m) = (1e-3, 1586.0, Horizon::Cells(3.0));
//! let grid = Grid::new(&Cuboid::centred([20.0 * dx, 20.0 * dx])?, dx)?;
//! let ply = Lamina { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12: 0.3 };
//! let stiffness = Stiffness::<2>::lamina(&ply)?;
//! let influence = InfluenceFunction::Linear;
//! let material = Correspondence::new(LinearElastic(stiffness), density, influence)?;
//! let symbol = Symbol::of(&material, dx, m, Quadrature::None)?;
//! println!("{}", symbol.stability());
//! let family = Lattice::<f64, 2>::new(&grid, m, Quadrature::None)?;
//! let mut body = Body::new(family, material, NoDamage)?;
//! let fastest = stiffness.max_wave_speed(density)?;
//! let estimates = TimeStepEstimates::new(&mut body, &symbol, fastest)?;
//! println!("{estimates}");
//! assert!(estimates.body < 0.7 * estimates.bulk);
//! # Ok(())
//! # }
//! ```
//!
//! A fixed step above the critical one is refused, and so is a body with a motion that grows at any
//! step (polynomial micromoduli of carbon plies): [`Error::UnstableBody`](core::Error) names ω² and
//! the wave. `TimeStep::Unchecked` runs either.
pub use pd_core as core;
pub use pd_damage as damage;
#[cfg(feature = "io")]
pub use pd_io as io;
pub use pd_models as models;

pub mod advise;
pub mod check;
#[cfg(feature = "io")]
pub mod checkpoint;
#[cfg(feature = "io")]
pub mod observe;
#[cfg(feature = "io")]
pub mod study;
#[cfg(feature = "io")]
pub mod trade;

/// Everything a simulation needs.
pub mod prelude {
    pub use crate::advise::{Advice, Advisor};
    #[cfg(feature = "io")]
    pub use crate::checkpoint::Checkpoint;
    #[cfg(feature = "io")]
    pub use crate::trade::{Cost, Study};
    pub use nalgebra::{SMatrix, SVector};
    pub use pd_core::body::{Body, Dynamics};
    pub use pd_core::bond::{Bond, End, Neighbourhood, Scale};
    pub use pd_core::cloud::Cloud;
    pub use pd_core::crack::{CrackSurface, Polygon, Segment};
    pub use pd_core::damage::{
        Breaking, DamageCriterion, DamagePolicy, NoDamage, Precracked, TestedBond,
    };
    pub use pd_core::family::{Family, Horizon};
    pub use pd_core::grid::{Grid, NodeSet, NodeSets};
    pub use pd_core::influence::{Influence, InfluenceFunction};
    pub use pd_core::integrator::{Integrator, SymplecticEuler, VelocityVerlet};
    pub use pd_core::lattice::Lattice;
    pub use pd_core::loads::{Face, Loads};
    pub use pd_core::material::{EnergySplit, Material, StrainEnergy, StressState};
    pub use pd_core::points::Points;
    pub use pd_core::quadrature::Quadrature;
    pub use pd_core::region::{Ball, Cuboid, Cylinder, Disc, Shape, Within};
    pub use pd_core::relaxation::{DynamicRelaxation, Relaxed};
    pub use pd_core::run::{Energies, Flow, Margin, Observer, Run, TimeStep, View, reaction};
    pub use pd_core::shape::{IllConditioned, ShapePolicy};
    pub use pd_core::statics::{Solved, Statics};
    pub use pd_core::symbol::{Stability, Symbol};
    pub use pd_core::time_step::TimeStepEstimates;
    pub use pd_core::{Error, Real, Result};
    pub use pd_damage::{
        AnyOf, BondEnergy, BondModel, BondStrength, CrackOpening, CrackPath, CrackPlane, CrackTip,
        CriterionExt, CriticalStretch, Either, FractureEnergy, FractureToughness, Interfaces,
        LocalEnergy, LocalStretch, Measures, Mirror, ModeEnergies, PowerLaw, Separated, Signs,
        Strengths, TipTrack, TsaiHill, TsaiHill3,
    };
    pub use pd_models::{
        BondAssociated, BondBased, BondLaw, Constitutive, Correspondence, Isotropic, Lamina,
        LinearElastic, LinearSolid, MadenciOterkus, Mixed, NeoHookean, OnFamily, Ordinary,
        Orthotropic, PlaneMode, Pmb, PolynomialMicromoduli, PositiveSplit, Regions,
        SaintVenantKirchhoff, SillingControl, Stiffness, Strained, Stroh, TransverselyIsotropic,
        WanControl, elasticity_tensor,
    };
}
