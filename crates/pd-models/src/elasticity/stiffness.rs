//! The elasticity tensor C_ijkl, symmetric positive definite by construction.

use super::{Isotropic, Lamina, Orthotropic, PlaneMode, TransverselyIsotropic};
use crate::{Error, Result};
use nalgebra::{Matrix3, Matrix6, Rotation2, Rotation3, SMatrix};
use pd_core::Real;

/// Asymmetry accepted, relative to the largest entry.
const SYMMETRY: f64 = 1e-12;

/// Stiffness of a D-dimensional body in Pa: any symmetric positive definite elasticity tensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness<const D: usize> {
    /// C_ijkl by axes; a fixed size serves 2D and 3D.
    tensor: [[[[f64; D]; D]; D]; D],
}

/// Voigt index of a pair of axes.
pub(crate) fn voigt_index(dimension: usize, i: usize, j: usize) -> usize {
    if i == j {
        i
    } else if dimension == 2 {
        2
    } else {
        6 - i - j
    }
}

/// Number of Voigt components.
const fn components(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

impl<const D: usize> Stiffness<D> {
    fn from_entries(entry: impl Fn(usize, usize) -> f64, hint: &'static str) -> Result<Self> {
        let n = components(D);
        let mut largest = 0.0_f64;
        for r in 0..n {
            for c in 0..n {
                let value = entry(r, c);
                let what = "entry of the stiffness [Pa]";
                pd_core::Error::check(value.is_finite(), what, value, "finite")?;
                largest = largest.max(value.abs());
            }
        }
        for r in 0..n {
            for c in r + 1..n {
                let (upper, lower) = (entry(r, c), entry(c, r));
                if (upper - lower).abs() > SYMMETRY * largest {
                    return Err(Error::NotSymmetric { row: r, column: c, upper, lower });
                }
            }
        }
        let v = voigt_index;
        let tensor = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                std::array::from_fn(|k| {
                    std::array::from_fn(|l| {
                        let (r, c) = (v(D, i, j), v(D, k, l));
                        0.5 * (entry(r, c) + entry(c, r))
                    })
                })
            })
        });
        let stiffness = Self { tensor };
        // Unused directions get the largest eigenvalue's scale, so that they never are smallest.
        let mandel = Matrix6::from_fn(|r, c| match (r < n && c < n, r == c) {
            (true, _) => {
                let factor = |a: usize| if a < D { 1.0 } else { std::f64::consts::SQRT_2 };
                factor(r) * factor(c) * stiffness.entry(r, c)
            }
            (false, true) => largest,
            (false, false) => 0.0,
        });
        let values = mandel.symmetric_eigenvalues();
        let (eigenvalue, largest) = (values.min(), values.max());
        if eigenvalue.is_nan() || eigenvalue <= 1e-14 * largest {
            return Err(Error::NotPositiveDefinite { eigenvalue, largest, hint });
        }
        Ok(stiffness)
    }

    /// Entry of the Voigt matrix.
    fn entry(&self, row: usize, column: usize) -> f64 {
        let axes = |r: usize| match (D, r) {
            (_, r) if r < D => (r, r),
            (2, _) => (0, 1),
            (_, 3) => (1, 2),
            (_, 4) => (0, 2),
            _ => (0, 1),
        };
        let ((i, j), (k, l)) = (axes(row), axes(column));
        self.tensor[i][j][k][l]
    }
    /// C_ijkl in Pa.
    pub fn c(&self, i: usize, j: usize, k: usize, l: usize) -> f64 {
        self.tensor[i][j][k][l]
    }
    /// σ = C:ε for a symmetric strain tensor.
    #[inline(always)]
    pub fn contract<T: Real>(&self, strain: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        SMatrix::from_fn(|i, j| {
            let mut sum = T::zero();
            for k in 0..D {
                sum += T::of(self.tensor[i][j][k][k]) * strain[(k, k)];
                for l in k + 1..D {
                    sum += T::of(2.0 * self.tensor[i][j][k][l]) * strain[(k, l)];
                }
            }
            sum
        })
    }
    /// Energy density ½ ε:C:ε in Pa.
    pub fn energy(&self, strain: &SMatrix<f64, D, D>) -> f64 {
        0.5 * self.contract(strain).component_mul(strain).sum()
    }
    /// The material turned by a rotation R: C'_ijkl = R_im R_jn R_ko R_lp C_mnop (errata 000-14).
    fn turned(&self, r: &SMatrix<f64, D, D>) -> Self {
        // One index at a time; each pass turns the first index and moves it last.
        let mut tensor = self.tensor;
        for _ in 0..4 {
            let old = tensor;
            tensor = std::array::from_fn(|j| {
                std::array::from_fn(|k| {
                    std::array::from_fn(|l| {
                        std::array::from_fn(|i| (0..D).map(|m| r[(i, m)] * old[m][j][k][l]).sum())
                    })
                })
            });
        }
        Self { tensor }
    }
}

const PLY: &str = "For a ply |ν12| must be below √(E1/E2).";
const GENERAL: &str = "Check units, signs and the Voigt order (xx, yy, zz, yz, xz, xy).";

impl Stiffness<2> {
    /// From the plane stiffness matrix, order xx, yy, xy.
    ///
    /// # Errors
    /// Not finite, not symmetric, not positive definite.
    pub fn from_voigt(c: Matrix3<f64>) -> Result<Self> {
        Self::from_entries(|r, s| c[(r, s)], GENERAL)
    }
    /// From the 6 constants C11, C12, C16, C22, C26, C66 (upper triangle, row by row).
    ///
    /// # Errors
    /// As [`from_voigt`](Self::from_voigt).
    pub fn from_components(c: [f64; 6]) -> Result<Self> {
        let row = [0, 3, 5];
        Self::from_entries(|r, s| c[row[r.min(s)] + r.abs_diff(s)], GENERAL)
    }
    /// Isotropic, in plane stress or plane strain.
    ///
    /// # Errors
    /// None for moduli that exist.
    pub fn isotropic(moduli: &Isotropic, mode: PlaneMode) -> Result<Self> {
        let (kappa, g) = (moduli.plane_bulk(mode), moduli.shear());
        Self::from_components([kappa + g, kappa - g, 0.0, kappa + g, 0.0, g])
    }
    /// A ply in plane stress: the inverse of its compliance (Hattori Eq. 34; errata 004-9).
    ///
    /// # Errors
    /// Moduli that are not positive, a Poisson's ratio that makes the energy indefinite.
    pub fn lamina(ply: &Lamina) -> Result<Self> {
        for (what, value) in [
            ("Young's modulus E1 [Pa]", ply.e1),
            ("Young's modulus E2 [Pa]", ply.e2),
            ("shear modulus G12 [Pa]", ply.g12),
        ] {
            pd_core::Error::positive(what, value)?;
        }
        let nu21 = ply.nu12 * ply.e2 / ply.e1;
        let d = 1.0 - ply.nu12 * nu21;
        if d.is_nan() || d <= 0.0 {
            let eigenvalue = ply.e2 * d;
            return Err(Error::NotPositiveDefinite { eigenvalue, largest: ply.e1, hint: PLY });
        }
        let c = [ply.e1 / d, nu21 * ply.e1 / d, 0.0, ply.e2 / d, 0.0, ply.g12];
        Self::from_entries(|r, s| c[[0, 3, 5][r.min(s)] + r.abs_diff(s)], PLY)
    }
    /// Material turned by θ (radians) counter-clockwise: a fibre along x comes to +θ.
    pub fn rotated(&self, theta: f64) -> Self {
        self.turned(Rotation2::new(theta).matrix())
    }
    /// The Voigt matrix in Pa.
    pub fn voigt(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|r, c| self.entry(r, c))
    }
}

impl Stiffness<3> {
    /// From the stiffness matrix, order xx, yy, zz, yz, xz, xy.
    ///
    /// # Errors
    /// Not finite, not symmetric, not positive definite.
    pub fn from_voigt(c: Matrix6<f64>) -> Result<Self> {
        Self::from_entries(|r, s| c[(r, s)], GENERAL)
    }
    /// From the 21 constants C11, C12, …, C16, C22, …, C66 (upper triangle, row by row).
    ///
    /// # Errors
    /// As [`from_voigt`](Self::from_voigt).
    pub fn from_components(c: [f64; 21]) -> Result<Self> {
        let row = [0, 6, 11, 15, 18, 20];
        Self::from_entries(|r, s| c[row[r.min(s)] + r.abs_diff(s)], GENERAL)
    }
    /// Isotropic.
    ///
    /// # Errors
    /// None for moduli that exist.
    pub fn isotropic(moduli: &Isotropic) -> Result<Self> {
        let (lambda, mu) = (moduli.lame(), moduli.shear());
        let entry = |r: usize, s: usize| match (r < 3 && s < 3, r == s) {
            (true, true) => lambda + 2.0 * mu,
            (true, false) => lambda,
            (false, true) => mu,
            (false, false) => 0.0,
        };
        Self::from_entries(entry, GENERAL)
    }
    /// Orthotropic: the inverse of its compliance (errata 004-10).
    ///
    /// # Errors
    /// Moduli that are not positive, Poisson's ratios that make the energy indefinite.
    pub fn orthotropic(m: &Orthotropic) -> Result<Self> {
        const HINT: &str = "For an orthotropic solid |ν_ij| must be below √(E_i/E_j), and \
                            1 − ν12ν21 − ν13ν31 − ν23ν32 − 2ν21ν32ν13 must be positive.";
        for (what, value) in [
            ("Young's modulus E1 [Pa]", m.e1),
            ("Young's modulus E2 [Pa]", m.e2),
            ("Young's modulus E3 [Pa]", m.e3),
            ("shear modulus G12 [Pa]", m.g12),
            ("shear modulus G13 [Pa]", m.g13),
            ("shear modulus G23 [Pa]", m.g23),
        ] {
            pd_core::Error::positive(what, value)?;
        }
        let compliance = Matrix3::new(
            1.0 / m.e1,
            -m.nu12 / m.e1,
            -m.nu13 / m.e1,
            -m.nu12 / m.e1,
            1.0 / m.e2,
            -m.nu23 / m.e2,
            -m.nu13 / m.e1,
            -m.nu23 / m.e2,
            1.0 / m.e3,
        );
        let smallest = compliance.symmetric_eigenvalues().min();
        let normal = compliance.try_inverse().filter(|_| smallest > 0.0).ok_or(
            Error::NotPositiveDefinite {
                eigenvalue: 1.0 / smallest,
                largest: m.e1.max(m.e2).max(m.e3),
                hint: HINT,
            },
        )?;
        let normal = (normal + normal.transpose()) * 0.5;
        let shear = [m.g23, m.g13, m.g12];
        let entry = |r: usize, s: usize| match (r < 3 && s < 3, r == s) {
            (true, _) => normal[(r, s)],
            (false, true) => shear[r - 3],
            (false, false) => 0.0,
        };
        Self::from_entries(entry, HINT)
    }
    /// Transversely isotropic about x.
    ///
    /// # Errors
    /// As [`orthotropic`](Self::orthotropic).
    pub fn transversely_isotropic(m: &TransverselyIsotropic) -> Result<Self> {
        Self::orthotropic(&m.orthotropic())
    }
    /// Material turned by a rotation.
    pub fn rotated(&self, rotation: &Rotation3<f64>) -> Self {
        self.turned(rotation.matrix())
    }
    /// Material turned by φ (radians) counter-clockwise about z (errata 004-11).
    pub fn rotated_about_z(&self, phi: f64) -> Self {
        self.rotated(&Rotation3::from_axis_angle(&nalgebra::Vector3::z_axis(), phi))
    }
    /// The Voigt matrix in Pa.
    pub fn voigt(&self) -> Matrix6<f64> {
        Matrix6::from_fn(|r, c| self.entry(r, c))
    }
    /// The plane stiffness of a body in the xy plane: its in-plane block in plane strain, the
    /// condensed one (σ_zz = σ_yz = σ_xz = 0) in plane stress.
    ///
    /// # Errors
    /// None for a stiffness that exists.
    pub fn plane(&self, mode: PlaneMode) -> Result<Stiffness<2>> {
        let c = self.voigt();
        let (inside, outside) = ([0, 1, 5], [2, 3, 4]);
        let block = |r: [usize; 3], s: [usize; 3]| Matrix3::from_fn(|i, j| c[(r[i], s[j])]);
        let own = block(inside, inside);
        let plane = match mode {
            PlaneMode::PlaneStrain => own,
            PlaneMode::PlaneStress => {
                let coupling = block(inside, outside);
                let rest = block(outside, outside).try_inverse().unwrap_or_else(Matrix3::zeros);
                own - coupling * rest * coupling.transpose()
            }
        };
        Stiffness::<2>::from_voigt((plane + plane.transpose()) * 0.5)
    }
}
