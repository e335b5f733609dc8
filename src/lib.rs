//! Peridynamics for anisotropic solids.
pub use pd_core as core;
pub use pd_damage as damage;
#[cfg(feature = "io")]
pub use pd_io as io;
pub use pd_models as models;

#[cfg(feature = "io")]
pub mod observe;

/// Everything a simulation needs.
pub mod prelude {
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
    pub use pd_core::integrator::{SymplecticEuler, VelocityVerlet};
    pub use pd_core::lattice::Lattice;
    pub use pd_core::loads::Loads;
    pub use pd_core::material::{Material, StrainEnergy, StressState};
    pub use pd_core::points::Points;
    pub use pd_core::quadrature::Quadrature;
    pub use pd_core::region::{Ball, Cuboid, Cylinder, Disc, Shape, Within};
    pub use pd_core::run::{Energies, Flow, Observer, Run, TimeStep, View, reaction};
    pub use pd_core::shape::{IllConditioned, ShapePolicy};
    pub use pd_core::{Error, Real, Result};
    pub use pd_damage::{
        CrackPath, CriterionExt, CriticalStretch, Interfaces, Signs, Strengths, TsaiHill, TsaiHill3,
    };
    pub use pd_models::{
        BondBased, BondLaw, Constitutive, Correspondence, Isotropic, Lamina, LinearElastic,
        LinearSolid, MadenciOterkus, NeoHookean, Ordinary, Orthotropic, PlaneMode, Pmb,
        PolynomialMicromoduli, PositiveSplit, Regions, SaintVenantKirchhoff, SillingControl,
        Stiffness, TransverselyIsotropic, WanControl,
    };
}
