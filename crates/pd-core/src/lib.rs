//! Peridynamic bodies: grids, families, integrity, time integration and the plugin traits.
//!
//! A [`Body`] is a [`Family`] (who interacts with whom: [`Lattice`] or [`Cloud`]), a [`Material`]
//! and a [`DamagePolicy`]; a [`Run`] takes it through time. Users see SI units; inside, lengths
//! are in units of Δx (see [`Scale`]).
pub mod body;
pub mod bond;
pub mod cloud;
pub mod convergence;
pub mod crack;
pub mod damage;
mod diagonal;
pub mod dispatch;
pub mod error;
pub mod family;
pub mod field;
pub mod gauss;
pub mod grid;
pub mod influence;
pub mod integrator;
mod lanes;
pub mod lattice;
pub mod loads;
pub mod material;
mod parallel;
pub mod points;
pub mod quadrature;
pub mod real;
pub mod record;
pub mod region;
pub mod relaxation;
pub mod run;
pub mod search;
pub mod shape;
pub mod state;
pub mod statics;
pub mod symbol;
pub mod time_step;
mod tridiagonal;

pub use body::{Body, Dynamics, Memory};
pub use bond::{Bond, End, Member, Neighbourhood, Scale};
pub use cloud::Cloud;
pub use crack::CrackSurface;
pub use damage::{Breaking, DamageCriterion, DamagePolicy, NoDamage, Precracked, TestedBond};
pub use error::{Error, Result};
pub use family::{Family, Horizon, Neighbour, Tally};
pub use field::Field;
pub use grid::{Grid, NodeSet};
pub use influence::{Influence, InfluenceFunction};
pub use integrator::{Integrator, SymplecticEuler, VelocityVerlet};
pub use lattice::Lattice;
pub use loads::{Face, Loads};
pub use material::{EnergySplit, Material, StrainEnergy, StressState};
pub use points::Points;
pub use quadrature::Quadrature;
pub use real::Real;
pub use record::Record;
pub use relaxation::DynamicRelaxation;
pub use run::{Energies, Flow, Margin, Observer, Run, TimeStep, View};
pub use search::{Rows, neighbours};
pub use state::{Kept, StateReader, StateWriter};
pub use statics::Statics;
pub use symbol::Symbol;
pub use time_step::TimeStepEstimates;
