//! Kinematics of a bond: finite (the papers' nonlinear form) or linearised.

use nalgebra::{SMatrix, SVector};
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
    /// False if nothing depends on the stretch of the bond.
    const STRETCH: bool;
    /// Extension e.
    fn extension<T: Real, const D: usize>(bond: &Bond<T, D>, length: BondLength<T>) -> T;
    /// The force (a + b e) M as a number times a vector; `None` for a = 0.
    fn force<T: Real, const D: usize>(
        bond: &Bond<T, D>,
        length: BondLength<T>,
        a: Option<T>,
        b: T,
    ) -> (T, SVector<T, D>);
}

/// e = |Y| − |ξ| without cancellation, M = Y/|Y|. Objective for any rotation.
#[derive(Debug, Clone, Copy, Default)]
pub struct Finite;

impl Kinematics for Finite {
    const STRETCH: bool = true;
    #[inline(always)]
    fn extension<T: Real, const D: usize>(bond: &Bond<T, D>, length: BondLength<T>) -> T {
        bond.extension(length.length)
    }
    /// With g = 1 − |ξ|/|Y|: e M = g Y and M = (1 − g) Y/|ξ|.
    #[inline(always)]
    fn force<T: Real, const D: usize>(
        bond: &Bond<T, D>,
        length: BondLength<T>,
        a: Option<T>,
        b: T,
    ) -> (T, SVector<T, D>) {
        let g = bond.stretch().g;
        let y = bond.deformed();
        match a.map(|a| a * length.inverse) {
            Some(a) => (bond.fma(b - a, g, a), y),
            None => (b * g, y),
        }
    }
}

/// e = η·n, M = n = ξ/|ξ|: no square root and no division; small strains and rotations.
#[derive(Debug, Clone, Copy, Default)]
pub struct Linearised;

impl Kinematics for Linearised {
    const LINEAR: bool = true;
    const STRETCH: bool = false;
    #[inline(always)]
    fn extension<T: Real, const D: usize>(bond: &Bond<T, D>, length: BondLength<T>) -> T {
        bond.dot(&bond.eta, &(bond.xi * length.inverse))
    }
    #[inline(always)]
    fn force<T: Real, const D: usize>(
        bond: &Bond<T, D>,
        length: BondLength<T>,
        a: Option<T>,
        b: T,
    ) -> (T, SVector<T, D>) {
        let n = bond.xi * length.inverse;
        let e = bond.dot(&bond.eta, &n);
        (a.map_or(b * e, |a| bond.fma(b, e, a)), n)
    }
}

/// A B in plain loops, which vectorise over nodes.
#[inline(always)]
pub(crate) fn product<T: Real, const D: usize, const N: usize>(
    a: &SMatrix<T, D, D>,
    b: &SMatrix<T, D, N>,
) -> SMatrix<T, D, N> {
    let mut product = SMatrix::<T, D, N>::zeros();
    for j in 0..N {
        for k in 0..D {
            for i in 0..D {
                product[(i, j)] += a[(i, k)] * b[(k, j)];
            }
        }
    }
    product
}
