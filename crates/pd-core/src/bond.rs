//! A bond and what its ends know.

use crate::Real;
use nalgebra::SVector;

/// One bond of a body: the reference vector ξ = x' − x and the relative displacement
/// η = u' − u, both in units of the body's length unit ([`Scale::unit`], Δx).
#[derive(Debug, Clone, Copy)]
pub struct Bond<T, const D: usize> {
    /// Reference bond vector ξ.
    pub xi: SVector<T, D>,
    /// Relative displacement η.
    pub eta: SVector<T, D>,
}

impl<T: Real, const D: usize> Bond<T, D> {
    /// Deformed bond Y = ξ + η.
    #[inline(always)]
    pub fn deformed(&self) -> SVector<T, D> {
        self.xi + self.eta
    }
    /// The same bond seen from its other end.
    #[inline(always)]
    pub fn reversed(&self) -> Self {
        Self { xi: -self.xi, eta: -self.eta }
    }
    /// Extension e = |Y| − |ξ| without cancellation, (ξ + Y)·η / (|Y| + |ξ|), and direction
    /// M = Y/|Y|; `length` is |ξ|.
    #[inline(always)]
    pub fn extension_and_direction(&self, length: T) -> (T, SVector<T, D>) {
        let y = self.deformed();
        let deformed_length = y.dot(&y).sqrt();
        let extension = (self.xi + y).dot(&self.eta) / (deformed_length + length);
        (extension, y * deformed_length.recip())
    }
    /// Extension e = |Y| − |ξ|; `length` is |ξ|.
    #[inline(always)]
    pub fn extension(&self, length: T) -> T {
        self.extension_and_direction(length).0
    }
}

/// One end of a bond: the bond's constants as that end sees them, the node's constants and
/// state, and what weighs the end's force state: β V of the neighbour (0 where the bond is outside
/// this end's horizon).
#[derive(Debug, Clone, Copy)]
pub struct End<'a, T, K, C, S> {
    /// Constants of the bond, [`crate::Material::bond_const`].
    pub bond: &'a K,
    /// Constants of the node, [`crate::Material::node_const`].
    pub node: &'a C,
    /// State of the node, [`crate::Material::node_state`].
    pub state: &'a S,
    /// Quadrature volume β V in Δx^D. In a damage criterion 1 if the bond is inside this end's
    /// horizon, else 0.
    pub volume: T,
}

/// Lengths of a family: all constants are computed in units of Δx, so that a body of a
/// nanometre and one of a kilometre are the same numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Horizon δ in units of Δx (m = δ/Δx on a lattice).
    pub horizon: f64,
    /// The unit Δx in metres. Multiply by it to get metres.
    pub unit: f64,
}

/// One neighbour in the reference configuration, for constants computed at setup (in `f64`).
#[derive(Debug, Clone, Copy)]
pub struct Member<K, const D: usize> {
    /// Reference bond ξ in units of Δx.
    pub xi: SVector<f64, D>,
    /// β V in Δx^D.
    pub volume: f64,
    /// The bond's constants.
    pub bond: K,
}

/// A node's neighbourhood, the argument of [`crate::Material::node_const`].
#[derive(Debug, Clone, Copy)]
pub struct Neighbourhood<'a, K, const D: usize> {
    /// Index of the node.
    pub node: usize,
    /// Horizon and unit of length.
    pub scale: Scale,
    /// The neighbours.
    pub members: &'a [Member<K, D>],
}

impl<K: Copy, const D: usize> Neighbourhood<'_, K, D> {
    /// Σ g(member) β V over the neighbourhood.
    pub fn sum(&self, g: impl Fn(&Member<K, D>) -> f64) -> f64 {
        self.members.iter().map(|m| g(m) * m.volume).sum()
    }
}
