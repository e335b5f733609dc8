//! Cracks and criteria: one file per property.
mod calibration;
#[path = "../common/mod.rs"]
mod common;
mod correspondence_softens;
mod crack_costs_its_energy;
mod crack_through_width;
mod criteria_bonds;
mod criteria_disagree;
mod energy_of_fracture;
mod local_energy;
