//! Stiffness from engineering constants: always the inverse of the compliance (errata 004-9,
//! 004-10: the printed closed forms have wrong signs).

use super::{Isotropic, Lamina, Orthotropic, PlaneMode, Stiffness, TransverselyIsotropic};
use crate::{Error, Result};

/// ν_ij √(E_j/E_i), which is symmetric in i and j and must lie in (−1, 1).
fn coupling(
    what: &'static str,
    bound: &'static str,
    nu: f64,
    (e_i, e_j): (f64, f64),
) -> Result<f64> {
    let limit = (e_i / e_j).sqrt();
    let ratio = nu / limit;
    if ratio.abs() < 1.0 {
        Ok(ratio)
    } else {
        Err(Error::PoissonBound { what, value: nu, bound, limit })
    }
}

/// Checks that moduli are finite and positive.
fn positive(moduli: &[(&'static str, f64)]) -> Result<()> {
    for &(what, value) in moduli {
        pd_core::Error::positive(what, value)?;
    }
    Ok(())
}

impl Stiffness<2> {
    /// Isotropic, in plane stress or plane strain.
    ///
    /// # Errors
    /// Not positive definite to rounding: ν within about 1e-14 of −1 or (plane strain) ½.
    pub fn isotropic(moduli: &Isotropic, mode: PlaneMode) -> Result<Self> {
        let (kappa, g) = (moduli.plane_bulk(mode), moduli.shear());
        Self::from_components([kappa + g, kappa - g, 0.0, kappa + g, 0.0, g])
    }
    /// A ply in plane stress (Hattori Eq. 34; errata 004-9): C11 = E1/(1−ν12ν21),
    /// C22 = E2/(1−ν12ν21), C12 = ν12 C22, C66 = G12.
    ///
    /// # Errors
    /// A modulus that is not finite and positive, |ν12| ≥ √(E1/E2).
    pub fn lamina(ply: &Lamina) -> Result<Self> {
        let Lamina { e1, e2, g12, nu12 } = *ply;
        positive(&[
            ("Young's modulus E1 [Pa]", e1),
            ("Young's modulus E2 [Pa]", e2),
            ("shear modulus G12 [Pa]", g12),
        ])?;
        let a = coupling("ν12", "√(E1/E2)", nu12, (e1, e2))?;
        let d = (1.0 - a) * (1.0 + a);
        Self::from_components([e1 / d, nu12 * e2 / d, 0.0, e2 / d, 0.0, g12])
    }
}

impl Stiffness<3> {
    /// Isotropic.
    ///
    /// # Errors
    /// Not positive definite to rounding: ν within about 1e-14 of −1 or ½.
    pub fn isotropic(moduli: &Isotropic) -> Result<Self> {
        let (lambda, mu) = (moduli.lame(), moduli.shear());
        Self::from_entries(|r, s| match (r < 3 && s < 3, r == s) {
            (true, true) => lambda + 2.0 * mu,
            (true, false) => lambda,
            (false, true) => mu,
            (false, false) => 0.0,
        })
    }
    /// Orthotropic in the axes x, y, z (Scabbia Eqs. 47, 48 as corrected by errata 004-10).
    ///
    /// # Errors
    /// A modulus that is not finite and positive, |ν_ij| ≥ √(E_i/E_j), Poisson's ratios that are
    /// not admissible together.
    pub fn orthotropic(solid: &Orthotropic) -> Result<Self> {
        let Orthotropic { e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 } = *solid;
        positive(&[
            ("Young's modulus E1 [Pa]", e1),
            ("Young's modulus E2 [Pa]", e2),
            ("Young's modulus E3 [Pa]", e3),
            ("shear modulus G12 [Pa]", g12),
            ("shear modulus G13 [Pa]", g13),
            ("shear modulus G23 [Pa]", g23),
        ])?;
        let a = coupling("ν12", "√(E1/E2)", nu12, (e1, e2))?;
        let b = coupling("ν13", "√(E1/E3)", nu13, (e1, e3))?;
        let c = coupling("ν23", "√(E2/E3)", nu23, (e2, e3))?;
        // S_ij √(E_i E_j) = (1 −a −b; −a 1 −c; −b −c 1) does not depend on the ratio of the moduli.
        let determinant = 1.0 - a * a - b * b - c * c - 2.0 * a * b * c;
        if determinant <= 0.0 {
            return Err(Error::PoissonRatios { determinant });
        }
        let inverse = [
            [1.0 - c * c, a + b * c, b + a * c],
            [a + b * c, 1.0 - b * b, c + a * b],
            [b + a * c, c + a * b, 1.0 - a * a],
        ];
        let (root, shear) = ([e1.sqrt(), e2.sqrt(), e3.sqrt()], [g23, g13, g12]);
        Self::from_entries(|r, s| match (r < 3 && s < 3, r == s) {
            (true, _) => root[r] * root[s] * inverse[r][s] / determinant,
            (false, true) => shear[r - 3],
            (false, false) => 0.0,
        })
    }
    /// Transversely isotropic about x.
    ///
    /// # Errors
    /// As [`orthotropic`](Self::orthotropic); ν23 ≤ −1.
    pub fn transversely_isotropic(solid: &TransverselyIsotropic) -> Result<Self> {
        // Before G23 = E2/(2(1+ν23)) is formed, so that the message is about the value given.
        coupling("ν23", "√(E2/E3)", solid.nu23, (1.0, 1.0))?;
        Self::orthotropic(&solid.orthotropic())
    }
}
