//! Materials of the papers, with the table or equation that gives their numbers.

use super::{Isotropic, Lamina, Orthotropic, Stiffness};
use crate::Result;

/// HTA/6376 carbon–epoxy ply (Hattori §6.2, Table 2).
pub const HTA_6376: Lamina = Lamina { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12: 0.3 };
/// Density of HTA/6376 in kg/m³ (Hattori Table 2).
pub const HTA_6376_DENSITY: f64 = 1586.0;
/// Strengths of HTA/6376 in Pa: along the fibre, across it, shear (Hattori §6.2, Table 2).
pub const HTA_6376_STRENGTHS: [f64; 3] = [1670e6, 60e6, 70e6];

/// Graphite–epoxy ply (Hattori §6.1).
pub const GRAPHITE_EPOXY: Lamina = Lamina { e1: 144.8e9, e2: 11.7e9, g12: 9.66e9, nu12: 0.21 };
/// Density of the graphite–epoxy in kg/m³ (Hattori §6.1).
pub const GRAPHITE_EPOXY_DENSITY: f64 = 2710.0;

/// Graphite fabric–carbon matrix ply (Scabbia Table 1, its constants of the plane).
pub const GRAPHITE_FABRIC_CARBON: Lamina =
    Lamina { e1: 173.06e9, e2: 33.09e9, g12: 9.38e9, nu12: 0.036 };

/// Graphite fabric–carbon matrix composite (Scabbia Table 1).
pub const GRAPHITE_FABRIC_CARBON_SOLID: Orthotropic = Orthotropic {
    e1: 173.06e9,
    e2: 33.09e9,
    e3: 5.17e9,
    nu12: 0.036,
    nu13: 0.25,
    nu23: 0.171,
    g12: 9.38e9,
    g13: 8.27e9,
    g23: 3.24e9,
};

/// Glass–epoxy ply (Scabbia Table 2; its second E1 is E2, errata 004-17).
pub const GLASS_EPOXY: Lamina = Lamina { e1: 44e9, e2: 10.5e9, g12: 3.74e9, nu12: 0.36 };

/// Steel (Scabbia Table 1).
///
/// # Errors
/// None: its numbers are admissible; so for every function of this module.
pub fn steel() -> Result<Isotropic> {
    Isotropic::from_young_poisson(206.84e9, 0.29)
}

/// Density of the steel Q345 in kg/m³ (Zhao §4.1).
pub const STEEL_Q345_DENSITY: f64 = 7850.0;
/// Steel Q345 (Zhao §4.1).
///
/// # Errors
/// None.
pub fn steel_q345() -> Result<Isotropic> {
    Isotropic::from_young_poisson(203e9, 0.3)
}

/// Density of Willberg's plate with a hole in kg/m³ (Table 5).
pub const WILLBERG_PLATE_DENSITY: f64 = 8000.0;
/// Willberg's plate with a hole (Table 5; E in GPa, errata 002-19).
///
/// # Errors
/// None.
pub fn willberg_plate() -> Result<Isotropic> {
    Isotropic::from_young_poisson(192e9, 0.33)
}

/// Density of Willberg's cantilever beam in kg/m³ (Table 2).
pub const WILLBERG_BEAM_DENSITY: f64 = 2000.0;
/// Willberg's double cantilever beam (Table 2).
///
/// # Errors
/// None.
pub fn willberg_beam() -> Result<Isotropic> {
    Isotropic::from_bulk_shear(1.75e9, 8.08e8)
}

/// Density of Willberg's fibre in kg/m³ (Table 7).
pub const WILLBERG_FIBRE_DENSITY: f64 = 1800.0;
/// Willberg's fibre (Table 7).
///
/// # Errors
/// None.
pub fn willberg_fibre() -> Result<Isotropic> {
    Isotropic::from_bulk_shear(17.283e9, 11.382e9)
}

/// Density of Willberg's resin in kg/m³ (Table 7).
pub const WILLBERG_RESIN_DENSITY: f64 = 1300.0;
/// Willberg's resin (Table 7).
///
/// # Errors
/// None.
pub fn willberg_resin() -> Result<Isotropic> {
    Isotropic::from_bulk_shear(3.125e9, 1.119e9)
}

/// PPS with 40 % weight of carbon fibres (Scabbia Table 3).
///
/// # Errors
/// None.
#[rustfmt::skip]
pub fn pps_carbon() -> Result<Stiffness<3>> {
    let gpa = [
        36.0,  6.7,  6.4, 0.0,  0.0,  0.0,
              15.1,  6.3, 0.0,  0.0,  0.0,
                    10.9, 0.0,  0.0,  0.0,
                          2.78, 0.0,  0.0,
                                3.28, 0.0,
                                      5.8,
    ];
    Stiffness::<3>::from_components(gpa.map(|c| c * 1e9))
}

/// Density of [`hattori_plate`] in kg/m³ (Hattori §6.3).
pub const HATTORI_PLATE_DENSITY: f64 = 1600.0;
/// The plate with inclusion and hole (Hattori Eq. 39).
///
/// # Errors
/// None.
pub fn hattori_plate() -> Result<Stiffness<2>> {
    Stiffness::<2>::from_components([155.43, 3.72, 0.0, 16.34, 0.0, 7.48].map(|c| c * 1e9))
}

/// Density of [`hattori_inclusion`] in kg/m³ (Hattori §6.3).
pub const HATTORI_INCLUSION_DENSITY: f64 = 5670.0;
/// Strengths of the layer of Hattori §6.4 with the stiffness of [`hattori_inclusion`] in Pa: along
/// the fibre, across it, shear.
pub const HATTORI_INCLUSION_STRENGTHS: [f64; 3] = [2100e6, 120e6, 135e6];
/// The inclusion (Hattori Eq. 40): positive definite, but with ν12 = 1.845 and G12 = 14 E2 most
/// likely misprinted (errata 000-18).
///
/// # Errors
/// None.
pub fn hattori_inclusion() -> Result<Stiffness<2>> {
    Stiffness::<2>::from_components([235.0, 3.69, 0.0, 2.0, 0.0, 28.2].map(|c| c * 1e9))
}
