//! Rotation of the material, and the plane stiffness of a solid.

use super::{PlaneMode, Stiffness};
use crate::Result;
use nalgebra::{Matrix3, Rotation2, Rotation3, Vector3};

impl Stiffness<2> {
    /// Material turned by θ (radians) counter-clockwise: a fibre along x comes to +θ, as in the
    /// stress rotation Hattori Eq. 28 (errata 000-14; Scabbia Eq. 46).
    pub fn rotated(&self, theta: f64) -> Self {
        self.turned(Rotation2::new(theta).matrix())
    }
}

impl Stiffness<3> {
    /// Material turned by a rotation R: the axis e of the material comes to R e.
    pub fn rotated(&self, rotation: &Rotation3<f64>) -> Self {
        self.turned(rotation.matrix())
    }
    /// Material turned by φ (radians) counter-clockwise about z (Scabbia Eqs. 46, 50 as corrected
    /// by errata 004-11).
    pub fn rotated_about_z(&self, phi: f64) -> Self {
        self.rotated(&Rotation3::from_axis_angle(&Vector3::z_axis(), phi))
    }
    /// Stiffness of a plane body in xy: the in-plane block in plane strain; in plane stress the one
    /// condensed by σ_zz = σ_yz = σ_xz = 0, that is C_pp − C_pq C_qq⁻¹ C_qp with p = xx, yy, xy and
    /// q = zz, yz, xz.
    ///
    /// In plane strain a material without the mirror plane z also carries σ_yz and σ_xz, which a
    /// plane body does not represent.
    ///
    /// # Errors
    /// Not positive definite to rounding.
    pub fn plane(&self, mode: PlaneMode) -> Result<Stiffness<2>> {
        let (p, q) = ([0, 1, 5], [2, 3, 4]);
        let block = |r: [usize; 3], s: [usize; 3]| Matrix3::from_fn(|i, j| self.entry(r[i], s[j]));
        let own = block(p, p);
        // A block of a positive definite matrix is one too, so the factor exists.
        let plane = match (mode, block(q, q).cholesky()) {
            (PlaneMode::PlaneStress, Some(factor)) => {
                let coupling = block(p, q);
                own - coupling * factor.solve(&coupling.transpose())
            }
            _ => own,
        };
        Stiffness::<2>::from_voigt((plane + plane.transpose()) * 0.5)
    }
}
