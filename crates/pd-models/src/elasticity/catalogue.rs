//! Materials of the papers.

use super::{Isotropic, Lamina, Orthotropic, Stiffness};
use crate::Result;
use nalgebra::Matrix3;

/// HTA/6376 carbon–epoxy ply (Hattori Table 2): E1 136, E2 8.75, G12 5.5 GPa, ν12 0.3.
pub const HTA_6376: Lamina = Lamina { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12: 0.3 };
/// Density of HTA/6376 in kg/m³ (Hattori Table 2).
pub const HTA_6376_DENSITY: f64 = 1586.0;

/// Graphite–epoxy ply (Hattori §6.1): E1 144.8, E2 11.7, G12 9.66 GPa, ν12 0.21.
pub const GRAPHITE_EPOXY: Lamina = Lamina { e1: 144.8e9, e2: 11.7e9, g12: 9.66e9, nu12: 0.21 };
/// Density of the graphite–epoxy in kg/m³ (Hattori §6.1).
pub const GRAPHITE_EPOXY_DENSITY: f64 = 2710.0;

/// Graphite fabric–carbon matrix ply (Scabbia Table 1, in the plane).
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

/// Steel (Scabbia Table 1): E 206.84 GPa, ν 0.29.
///
/// # Errors
/// None.
pub fn steel() -> Result<Isotropic> {
    Isotropic::from_young_poisson(206.84e9, 0.29)
}

/// PPS with 40 % weight of carbon fibres (Scabbia Table 3).
///
/// # Errors
/// None.
pub fn pps_carbon() -> Result<Stiffness<3>> {
    let mut c = nalgebra::Matrix6::from_diagonal(&[36.0, 15.1, 10.9, 2.78, 3.28, 5.8].into());
    for (row, column, value) in [(0, 1, 6.7), (0, 2, 6.4), (1, 2, 6.3)] {
        c[(row, column)] = value;
        c[(column, row)] = value;
    }
    Stiffness::<3>::from_voigt(c * 1e9)
}

/// The plate of Hattori Eq. 39, density 1600 kg/m³.
///
/// # Errors
/// None.
pub fn hattori_plate() -> Result<Stiffness<2>> {
    let c = Matrix3::new(155.43, 3.72, 0.0, 3.72, 16.34, 0.0, 0.0, 0.0, 7.48);
    Stiffness::<2>::from_voigt(c * 1e9)
}

/// The inclusion of Hattori Eq. 40, density 5670 kg/m³ (unusual constants, errata 000-18).
///
/// # Errors
/// None.
pub fn hattori_inclusion() -> Result<Stiffness<2>> {
    let c = Matrix3::new(235.0, 3.69, 0.0, 3.69, 2.0, 0.0, 0.0, 0.0, 28.2);
    Stiffness::<2>::from_voigt(c * 1e9)
}
