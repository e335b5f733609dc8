//! Critical values from what is known of a material: fracture energy, toughness or strength.
//!
//! A crack costs the energy of the bonds that cross it. With w⟨ξ⟩ the energy at which a bond
//! breaks, the crossing bonds of a unit area with normal n cost
//!
//! G = Σ_{ξ·n>0} w⟨ξ⟩ (ξ·n) βV
//!
//! as ξ·n is the depth from which bonds ξ reach across. In the continuum this is 2h∫w ξ² dξ in 2D
//! and π∫w ξ³ dξ in 3D; on a lattice the sum over its offsets, which differs by several percent
//! (+7.9 % for 3D, m = 3.015, β = 1). [`CrackPlane`] knows both, [`BondModel`] what a stretched
//! bond stores, and from the two follow s_c, Δ_cr and w_C for a [`FractureEnergy`].

use nalgebra::SVector;
use pd_core::gauss::integrate;
use pd_core::influence::Influence;
use pd_core::lattice::Lattice;
use pd_core::{Error, Family, Real, Result};
use std::f64::consts::PI;
use std::sync::Arc;

/// Fracture energy G_c (also G₀): energy per area of crack, in J/m² = N/m.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct FractureEnergy(f64);

impl FractureEnergy {
    /// From G_c in J/m².
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn new(energy: f64) -> Result<Self> {
        Ok(Self(Error::positive("fracture energy G_c [J/m²]", energy)?))
    }
    /// G_c in J/m².
    pub fn value(self) -> f64 {
        self.0
    }
}

/// Fracture toughness K_c in Pa√m.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct FractureToughness(f64);

impl FractureToughness {
    /// From K_c in Pa√m.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn new(toughness: f64) -> Result<Self> {
        Ok(Self(Error::positive("fracture toughness K_c [Pa√m]", toughness)?))
    }
    /// G_c = K_c²/E of an isotropic plate in plane stress (Zhao Eq. 14), Young's modulus in Pa.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless E is positive.
    pub fn in_plane_stress(self, young: f64) -> Result<FractureEnergy> {
        FractureEnergy::new(self.0 * self.0 / Error::positive("Young's modulus E [Pa]", young)?)
    }
    /// G_c = K_c²(1 − ν²)/E in plane strain, also at the crack front of a solid (errata 001-5).
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless E is positive and −1 < ν ≤ ½.
    pub fn in_plane_strain(self, young: f64, poisson: f64) -> Result<FractureEnergy> {
        let ok = poisson > -1.0 && poisson <= 0.5;
        let nu = Error::check(ok, "Poisson's ratio ν", poisson, "in (−1, ½]")?;
        let young = Error::positive("Young's modulus E [Pa]", young)?;
        FractureEnergy::new(self.0 * self.0 * (1.0 - nu * nu) / young)
    }
}

/// Tensile strength σ_c in Pa of a body without a crack: the stress at which its bonds break.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct BondStrength(f64);

impl BondStrength {
    /// From σ_c in Pa.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn new(strength: f64) -> Result<Self> {
        Ok(Self(Error::positive("tensile strength σ_c [Pa]", strength)?))
    }
    /// The stretch σ_c/E of the bonds along a uniaxial tension of σ_c.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless E is positive.
    pub fn stretch(self, young: f64) -> Result<f64> {
        Ok(self.0 / Error::positive("Young's modulus E [Pa]", young)?)
    }
    /// The fracture energy that goes with this strength at the horizon of `plane`: that of bonds
    /// breaking at the stretch σ_c/E. Strength and fracture energy of a peridynamic body cannot
    /// both be chosen: G_c grows with σ_c² δ.
    ///
    /// # Errors
    /// As [`stretch`](Self::stretch).
    pub fn fracture_energy<const D: usize>(
        self,
        young: f64,
        model: &BondModel,
        plane: &CrackPlane<D>,
    ) -> Result<FractureEnergy> {
        let stretch = self.stretch(young)?;
        FractureEnergy::new(model.cost(plane, |length| stretch * length))
    }
}

/// The bonds that cross a crack, and the families they belong to: lengths in metres, per unit
/// thickness in 2D.
#[derive(Debug, Clone)]
pub struct CrackPlane<const D: usize> {
    horizon: f64,
    bonds: Bonds,
}

#[derive(Debug, Clone)]
enum Bonds {
    Continuum,
    /// (|ξ|, ξ·n, βV) of all bonds of a node.
    Lattice(Vec<(f64, f64, f64)>),
}

impl<const D: usize> CrackPlane<D> {
    /// A crack in the continuum, for a horizon δ in metres: the integrals of the literature.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn continuum(horizon: f64) -> Result<Self> {
        let horizon = Error::positive("horizon δ [m]", horizon)?;
        Ok(Self { horizon, bonds: Bonds::Continuum })
    }
    /// A crack with the normal `normal` (any length) on this very lattice, with its weights β.
    /// For a normal along an axis it is the cost of every crack between two rows of nodes, for
    /// others the mean over the places of the plane.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a normal without length.
    pub fn lattice<T: Real>(lattice: &Lattice<T, D>, normal: [f64; D]) -> Result<Self> {
        Self::shared(lattice, normal, |_| 1.0)
    }
    /// The same crack through a body of finite width B in metres along an axis, its front parallel to
    /// that axis: of the bonds ξ only the share 1 − |ξ_a|/B has both ends in the body, so that
    /// each must cost more. A beam two horizons wide loses one seventh of its bonds by that.
    /// Families and moduli are means over the width.
    ///
    /// # Errors
    /// As [`lattice`](Self::lattice), and for a width that is not positive or an axis that is not
    /// one.
    pub fn through_width<T: Real>(
        lattice: &Lattice<T, D>,
        normal: [f64; D],
        (axis, width): (usize, f64),
    ) -> Result<Self> {
        Error::check(axis < D, "axis of a width", axis as f64, "below the dimension")?;
        let width = Error::positive("width B [m]", width)?;
        let unit = lattice.unit();
        Self::shared(lattice, normal, |xi| (1.0 - xi[axis].abs() * unit / width).max(0.0))
    }
    /// The bonds of a lattice, each with the share of it that a body has.
    fn shared<T: Real>(
        lattice: &Lattice<T, D>,
        normal: [f64; D],
        share: impl Fn(&SVector<f64, D>) -> f64,
    ) -> Result<Self> {
        let normal = SVector::<f64, D>::from(normal);
        Error::positive("length of the crack's normal", normal.norm())?;
        let n = normal.normalize();
        let unit = lattice.unit();
        let cell = unit.powi(D as i32);
        let bonds = lattice
            .stencil()
            .map(|(xi, volume)| (xi.norm() * unit, xi.dot(&n) * unit, volume * cell * share(&xi)))
            .collect();
        let horizon = lattice.scale(0).horizon * unit;
        Ok(Self { horizon, bonds: Bonds::Lattice(bonds) })
    }
    /// The horizon δ in metres.
    pub fn horizon(&self) -> f64 {
        self.horizon
    }
    /// Σ_{ξ·n>0} f(|ξ|) (ξ·n) βV: what bonds of energy f cost per area.
    pub fn crossing(&self, f: impl Fn(f64) -> f64) -> f64 {
        match &self.bonds {
            Bonds::Continuum if D == 2 => 2.0 * self.radial(|x| f(x) * x * x),
            Bonds::Continuum => PI * self.radial(|x| f(x) * x.powi(3)),
            Bonds::Lattice(bonds) => {
                bonds.iter().filter(|b| b.1 > 0.0).map(|&(x, height, v)| f(x) * height * v).sum()
            }
        }
    }
    /// Σ f(|ξ|) βV over a whole family.
    pub fn family(&self, f: impl Fn(f64) -> f64) -> f64 {
        match &self.bonds {
            Bonds::Continuum if D == 2 => 2.0 * PI * self.radial(|x| f(x) * x),
            Bonds::Continuum => 4.0 * PI * self.radial(|x| f(x) * x * x),
            Bonds::Lattice(bonds) => bonds.iter().map(|&(x, _, v)| f(x) * v).sum(),
        }
    }
    /// Damage index of the first row of nodes beside a crack that is open all along: the share of a
    /// family that lies across. Half in the continuum, less on a lattice (0.31 for m = 2 in 3D).
    pub fn face_damage(&self) -> f64 {
        match &self.bonds {
            Bonds::Continuum => 0.5,
            Bonds::Lattice(bonds) => {
                let all: f64 = bonds.iter().map(|b| b.2).sum();
                bonds.iter().filter(|b| b.1 > 0.0).map(|b| b.2).sum::<f64>() / all
            }
        }
    }
    /// 2∫₀^δ (Σ_{ξ·n>z} f(|ξ|) βV)² dz: the squared sum over the part of each family that lies
    /// beyond the crack, for all nodes on both its sides.
    pub fn squared_share(&self, f: impl Fn(f64) -> f64) -> f64 {
        let delta = self.horizon;
        match &self.bonds {
            Bonds::Continuum => {
                let share = |z: f64| {
                    // r = z + (δ − z)t² takes the root out of the cap's angle arccos(z/r).
                    integrate(0.0, 1.0, |t| {
                        let r = z + (delta - z) * t * t;
                        let cap = if D == 2 {
                            2.0 * r * (z / r).min(1.0).acos()
                        } else {
                            2.0 * PI * r * (r - z)
                        };
                        2.0 * t * (delta - z) * f(r) * cap
                    })
                };
                2.0 * integrate(0.0, delta, |z| share(z).powi(2))
            }
            Bonds::Lattice(bonds) => {
                let mut beyond: Vec<_> = bonds.iter().filter(|b| b.1 > 0.0).collect();
                beyond.sort_by(|a, b| b.1.total_cmp(&a.1));
                // From the farthest bond inwards: the share is constant between two heights.
                let (mut share, mut sum) = (0.0, 0.0);
                for (k, &&(x, height, v)) in beyond.iter().enumerate() {
                    share += f(x) * v;
                    let next = beyond.get(k + 1).map_or(0.0, |b| b.1);
                    sum += share * share * (height - next);
                }
                2.0 * sum
            }
        }
    }
    /// ∫₀^δ f(ξ) dξ, split at δ/2 where the cubic spline has its knot.
    fn radial(&self, f: impl Fn(f64) -> f64) -> f64 {
        let delta = self.horizon;
        integrate(0.0, 0.5 * delta, &f) + integrate(0.5 * delta, delta, &f)
    }
}

/// What stretched bonds store: a material model as calibrations see it.
#[derive(Clone)]
pub struct BondModel {
    kind: Kind,
    influence: Arc<dyn Influence>,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Pmb { bulk: f64, on_family: bool },
    LinearSolid { bulk: f64, shear: f64 },
    MadenciOterkus { bulk: f64, shear: f64 },
}

impl BondModel {
    fn new(kind: Kind, bulk: f64, influence: impl Influence + 'static) -> Result<Self> {
        Error::positive("bulk modulus κ [Pa]", bulk)?;
        Ok(Self { kind, influence: Arc::new(influence) })
    }
    /// Bond-based (PMB): bulk modulus of space in 3D, of the plane in 2D, in Pa.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn pmb(bulk: f64, influence: impl Influence + 'static) -> Result<Self> {
        Self::new(Kind::Pmb { bulk, on_family: false }, bulk, influence)
    }
    /// Bond-based with the micromodulus of each node's own family.
    ///
    /// # Errors
    /// As [`pmb`](Self::pmb).
    pub fn pmb_on_family(bulk: f64, influence: impl Influence + 'static) -> Result<Self> {
        Self::new(Kind::Pmb { bulk, on_family: true }, bulk, influence)
    }
    /// The linear peridynamic solid: bulk modulus (of space or plane) and shear modulus in Pa.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless both are positive.
    pub fn linear_solid(
        bulk: f64,
        shear: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        Error::positive("shear modulus G [Pa]", shear)?;
        Self::new(Kind::LinearSolid { bulk, shear }, bulk, influence)
    }
    /// The Madenci–Oterkus form: bulk modulus (of space or plane) and shear modulus in Pa.
    ///
    /// # Errors
    /// As [`linear_solid`](Self::linear_solid).
    pub fn madenci_oterkus(bulk: f64, shear: f64) -> Result<Self> {
        Error::positive("shear modulus G [Pa]", shear)?;
        let influence = pd_core::InfluenceFunction::Constant;
        Self::new(Kind::MadenciOterkus { bulk, shear }, bulk, influence)
    }

    /// Energy per area of a crack, in J/m², whose crossing bonds have the extension e(|ξ|) (both in
    /// metres) and are the only ones stretched: their own energy and that of the dilatation they
    /// make at the nodes on both sides.
    ///
    /// PMB: w = ½cωe²/|ξ|. Linear solid: w = (α/m)ωe² and ½(κ − α/D²)θ² with θ = (D/m)Σω|ξ|eβV.
    /// Madenci–Oterkus: w = 2bδe²/|ξ| and aθ² with θ = dδΣ(e/|ξ|)βV.
    pub fn cost<const D: usize>(
        &self,
        plane: &CrackPlane<D>,
        extension: impl Fn(f64) -> f64,
    ) -> f64 {
        let (e, delta, d) = (extension, plane.horizon, D as f64);
        let omega = |x: f64| self.influence.weight(x / delta);
        match self.kind {
            Kind::Pmb { bulk, on_family } => {
                let own = if on_family { plane } else { &continuum_of(plane) };
                let c = 2.0 * d * d * bulk / own.family(|x| omega(x) * x);
                plane.crossing(|x| 0.5 * c * omega(x) * e(x).powi(2) / x)
            }
            Kind::LinearSolid { bulk, shear } => {
                let alpha = if D == 2 { 8.0 } else { 15.0 } * shear;
                let m = plane.family(|x| omega(x) * x * x);
                plane.crossing(|x| alpha / m * omega(x) * e(x).powi(2))
                    + 0.5
                        * (d * d * bulk - alpha)
                        * plane.squared_share(|x| omega(x) * x * e(x) / m)
            }
            Kind::MadenciOterkus { bulk, shear } => {
                let (a, b, c) = if D == 2 {
                    let b = 6.0 * shear / (PI * delta.powi(4));
                    (0.5 * bulk - shear, b, 2.0 / (PI * delta.powi(2)))
                } else {
                    let b = 15.0 * shear / (2.0 * PI * delta.powi(5));
                    (0.5 * bulk - 5.0 * shear / 6.0, b, 9.0 / (4.0 * PI * delta.powi(3)))
                };
                plane.crossing(|x| 2.0 * b * delta * e(x).powi(2) / x)
                    + a * plane.squared_share(|x| c * e(x) / x)
            }
        }
    }
}

/// The continuum of the same horizon.
fn continuum_of<const D: usize>(plane: &CrackPlane<D>) -> CrackPlane<D> {
    CrackPlane { horizon: plane.horizon, bonds: Bonds::Continuum }
}

/// The size of extensions e(|ξ|) = size · shape(|ξ|) at which a crack costs `energy`: the cost is
/// quadratic in it.
pub(crate) fn critical_size<const D: usize>(
    energy: FractureEnergy,
    model: &BondModel,
    plane: &CrackPlane<D>,
    shape: impl Fn(f64) -> f64,
) -> Result<f64> {
    let cost = model.cost(plane, shape);
    Error::positive("energy of a crack at unit extension [J/m²]", cost)?;
    Ok((energy.value() / cost).sqrt())
}
