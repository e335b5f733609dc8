//! Materials and families: one file per property; one program, so that the bodies they share are
//! compiled once.
mod bond_associated;
#[path = "../common/mod.rs"]
mod common;
mod critical_step_body;
mod crosscode;
mod elasticity_tensor;
mod energy;
mod finite_elements;
mod force_is_energy_gradient;
mod graded;
mod lattice_ends;
mod lattice_is_cloud;
mod material_check;
mod momentum;
mod no_overhead;
mod numbering;
mod oracle;
mod overflowing_law;
mod patch;
mod phase_velocity;
mod rigid_motion;
mod several_materials;
mod strained;
mod time_step_estimates;
mod unstable_body;
