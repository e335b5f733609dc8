//! Kinematics of a bond: finite (the papers' nonlinear form) or linearised.

use nalgebra::SVector;
use pd_core::Real;
use pd_core::bond::Bond;

/// |ξ| and 1/|ξ| in units of Δx.
#[derive(Debug, Clone, Copy)]
pub struct BondLength<T> {
    /// |ξ|.
    pub length: T,
    /// 1/|ξ|.
    pub inverse: T,
}

impl<T: Real> BondLength<T> {
    /// Of a reference bond.
    pub fn new<const D: usize>(xi: &SVector<f64, D>) -> Self {
        let length = xi.norm();
        Self { length: T::of(length), inverse: T::of(1.0 / length) }
    }
}

/// How extension e and direction M follow from a bond.
pub trait Kinematics: Copy + Default + Send + Sync + 'static {
    /// True if e is linear in η and M does not depend on it.
    const LINEAR: bool = false;
    /// Extension e and direction M of the force.
    fn extension_and_direction<T: Real, const D: usize>(
        bond: &Bond<T, D>,
        length: BondLength<T>,
    ) -> (T, SVector<T, D>);
}

/// e = |Y| − |ξ| without cancellation, M = Y/|Y|. Objective for any rotation.
#[derive(Debug, Clone, Copy, Default)]
pub struct Finite;

impl Kinematics for Finite {
    #[inline(always)]
    fn extension_and_direction<T: Real, const D: usize>(
        bond: &Bond<T, D>,
        length: BondLength<T>,
    ) -> (T, SVector<T, D>) {
        bond.extension_and_direction(length.length)
    }
}

/// e = η·n, M = n = ξ/|ξ|: no square root and no division; small strains and rotations.
#[derive(Debug, Clone, Copy, Default)]
pub struct Linearised;

impl Kinematics for Linearised {
    const LINEAR: bool = true;
    #[inline(always)]
    fn extension_and_direction<T: Real, const D: usize>(
        bond: &Bond<T, D>,
        length: BondLength<T>,
    ) -> (T, SVector<T, D>) {
        let n = bond.xi * length.inverse;
        (bond.eta.dot(&n), n)
    }
}
