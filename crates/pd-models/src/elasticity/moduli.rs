//! Engineering constants.

use crate::Result;
use pd_core::Error;

/// What a 2D body stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlaneMode {
    /// A thin plate: σ_zz = 0.
    PlaneStress,
    /// A section of a long body: ε_zz = 0.
    PlaneStrain,
}

/// An isotropic elastic solid.
///
/// Keeps all four moduli, so that the pair it was made from comes back as given and none loses
/// digits near ν = ½, where K/G is large.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic {
    young: f64,
    poisson: f64,
    bulk: f64,
    shear: f64,
}

impl Isotropic {
    /// From Young's modulus E in Pa and Poisson's ratio ν.
    ///
    /// # Errors
    /// E not finite and positive, ν outside (−1, ½).
    pub fn from_young_poisson(young: f64, poisson: f64) -> Result<Self> {
        Error::positive("Young's modulus E [Pa]", young)?;
        let poisson = admissible_poisson(poisson)?;
        let bulk = young / (3.0 * (1.0 - 2.0 * poisson));
        let shear = young / (2.0 * (1.0 + poisson));
        Ok(Self { young, poisson, bulk, shear })
    }
    /// From bulk modulus K and shear modulus G in Pa.
    ///
    /// # Errors
    /// A modulus that is not finite and positive; K/G so large or so small that ν is ½ or −1 to
    /// rounding.
    pub fn from_bulk_shear(bulk: f64, shear: f64) -> Result<Self> {
        Error::positive("bulk modulus K [Pa]", bulk)?;
        Error::positive("shear modulus G [Pa]", shear)?;
        let young = 9.0 * bulk * shear / (3.0 * bulk + shear);
        let poisson =
            admissible_poisson((3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)))?;
        Ok(Self { young, poisson, bulk, shear })
    }
    /// From Lamé's constants λ and μ in Pa.
    ///
    /// # Errors
    /// As [`from_bulk_shear`](Self::from_bulk_shear) with K = λ + 2μ/3 and G = μ.
    pub fn from_lame(lambda: f64, mu: f64) -> Result<Self> {
        Self::from_bulk_shear(lambda + 2.0 * mu / 3.0, mu)
    }
    /// Young's modulus E in Pa.
    pub fn young(&self) -> f64 {
        self.young
    }
    /// Poisson's ratio ν.
    pub fn poisson(&self) -> f64 {
        self.poisson
    }
    /// Bulk modulus of space K = E/(3(1−2ν)) in Pa.
    pub fn bulk(&self) -> f64 {
        self.bulk
    }
    /// Shear modulus G = μ = E/(2(1+ν)) in Pa.
    pub fn shear(&self) -> f64 {
        self.shear
    }
    /// Lamé's λ = K − 2G/3 in Pa.
    pub fn lame(&self) -> f64 {
        self.bulk - 2.0 * self.shear / 3.0
    }
    /// Bulk modulus κ of the plane in Pa: E/(2(1−ν)) in plane stress, E/(2(1+ν)(1−2ν)) = K + G/3
    /// in plane strain (errata 004-18).
    pub fn plane_bulk(&self, mode: PlaneMode) -> f64 {
        match mode {
            PlaneMode::PlaneStress => self.young / (2.0 * (1.0 - self.poisson)),
            PlaneMode::PlaneStrain => self.bulk + self.shear / 3.0,
        }
    }
}

/// ν if it lies in (−1, ½).
fn admissible_poisson(nu: f64) -> Result<f64> {
    let need = "between −1 and 1/2 (both exclusive)";
    Ok(Error::check(nu > -1.0 && nu < 0.5, "Poisson's ratio ν", nu, need)?)
}

/// A unidirectional ply in plane stress, fibre along x (Hattori Eq. 34). Moduli in Pa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamina {
    /// Young's modulus along the fibre.
    pub e1: f64,
    /// Young's modulus across.
    pub e2: f64,
    /// Shear modulus.
    pub g12: f64,
    /// Major Poisson's ratio: strain across over strain along, pulled along.
    pub nu12: f64,
}

/// An orthotropic solid in its own axes 1, 2, 3 = x, y, z. Moduli in Pa; ν_ij E_j = ν_ji E_i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orthotropic {
    /// Young's modulus along axis 1.
    pub e1: f64,
    /// Young's modulus along axis 2.
    pub e2: f64,
    /// Young's modulus along axis 3.
    pub e3: f64,
    /// Poisson's ratio: strain along 2 over strain along 1, pulled along 1.
    pub nu12: f64,
    /// Poisson's ratio: strain along 3 over strain along 1, pulled along 1.
    pub nu13: f64,
    /// Poisson's ratio: strain along 3 over strain along 2, pulled along 2.
    pub nu23: f64,
    /// Shear modulus of the plane of axes 1 and 2.
    pub g12: f64,
    /// Shear modulus of the plane of axes 1 and 3.
    pub g13: f64,
    /// Shear modulus of the plane of axes 2 and 3.
    pub g23: f64,
}

/// A transversely isotropic solid, fibre along x. Moduli in Pa; G23 = E2/(2(1+ν23)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransverselyIsotropic {
    /// Young's modulus along the fibre.
    pub e1: f64,
    /// Young's modulus across.
    pub e2: f64,
    /// Shear modulus along the fibre.
    pub g12: f64,
    /// Poisson's ratio along the fibre.
    pub nu12: f64,
    /// Poisson's ratio in the isotropic plane.
    pub nu23: f64,
}

impl TransverselyIsotropic {
    /// The nine orthotropic constants (E3 = E2, ν13 = ν12, G13 = G12).
    pub fn orthotropic(&self) -> Orthotropic {
        let Self { e1, e2, g12, nu12, nu23 } = *self;
        Orthotropic {
            e1,
            e2,
            e3: e2,
            nu12,
            nu13: nu12,
            nu23,
            g12,
            g13: g12,
            g23: e2 / (2.0 * (1.0 + nu23)),
        }
    }
}
