//! A bond and what its ends know.

use crate::Real;
use nalgebra::SVector;

/// One bond of a body: the reference vector ξ = x' − x and the relative displacement
/// η = u' − u, both in units of the body's length unit ([`Scale::unit`], Δx).
///
/// Its stretch λ = |Y|/|ξ| enters the forces by t = λ² − 1 = η·(η + 2ξ)/|ξ|² and by functions of
/// √(1+t), which [`stretch`](Self::stretch) gives without a root or a division while |t| is small.
#[derive(Debug, Clone, Copy)]
pub struct Bond<T, const D: usize> {
    /// Reference bond vector ξ.
    pub xi: SVector<T, D>,
    /// Relative displacement η.
    pub eta: SVector<T, D>,
    /// 2ξ, so that a kernel reads it with ξ.
    twice: SVector<T, D>,
    /// 1/|ξ|².
    inverse_square: T,
    arithmetic: Arithmetic,
}

/// How the functions of a bond are computed. Constant in every kernel, so it costs no branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Arithmetic {
    /// |t| ≤ [`Bond::SMALL`] is known.
    pub small: bool,
    /// The processor multiplies and adds in one instruction.
    pub fused: bool,
}

/// Functions of the stretch λ of a bond.
#[derive(Debug, Clone, Copy)]
pub struct Stretch<T> {
    /// 1 − 1/λ.
    pub g: T,
    /// λ − 1.
    pub strain: T,
    /// 1/λ.
    pub inverse: T,
}

impl<T: Real, const D: usize> Bond<T, D> {
    /// Up to this |t| (a stretch of about 1.5 %) the functions of a bond are polynomials.
    pub const SMALL: f64 = 1.0 / 32.0;

    /// The bond ξ with the relative displacement η.
    #[inline(always)]
    pub fn new(xi: SVector<T, D>, eta: SVector<T, D>) -> Self {
        let arithmetic = Arithmetic { small: false, fused: false };
        Self::of_kernel(xi, eta, xi.dot(&xi).recip(), arithmetic)
    }
    /// A bond of a kernel, which knows 1/|ξ|² and what its processor can do.
    #[inline(always)]
    pub(crate) fn of_kernel(
        xi: SVector<T, D>,
        eta: SVector<T, D>,
        inverse_square: T,
        arithmetic: Arithmetic,
    ) -> Self {
        Self::of_table((xi, xi + xi), eta, inverse_square, arithmetic)
    }
    /// As [`of_kernel`](Self::of_kernel), for a kernel that has ξ and 2ξ in a table.
    #[inline(always)]
    pub(crate) fn of_table(
        (xi, twice): (SVector<T, D>, SVector<T, D>),
        eta: SVector<T, D>,
        inverse_square: T,
        arithmetic: Arithmetic,
    ) -> Self {
        Self { xi, eta, twice, inverse_square, arithmetic }
    }
    /// Deformed bond Y = ξ + η.
    #[inline(always)]
    pub fn deformed(&self) -> SVector<T, D> {
        self.xi + self.eta
    }
    /// The same bond seen from its other end.
    #[inline(always)]
    pub fn reversed(&self) -> Self {
        Self { xi: -self.xi, eta: -self.eta, twice: -self.twice, ..*self }
    }
    /// 1/|ξ|².
    #[inline(always)]
    pub fn inverse_square(&self) -> T {
        self.inverse_square
    }
    /// a · b + c: rounded once in the kernels of processors that can (x86-64 with AVX2 and FMA,
    /// Arm), so all of those give the same bits; rounded twice elsewhere.
    #[inline(always)]
    pub fn fma(&self, a: T, b: T, c: T) -> T {
        if self.arithmetic.fused { T::fused(a, b, c) } else { a * b + c }
    }
    /// a·b of two vectors.
    #[inline(always)]
    pub fn dot<const N: usize>(&self, a: &SVector<T, N>, b: &SVector<T, N>) -> T {
        let mut sum = a[0] * b[0];
        for d in 1..N {
            sum = self.fma(a[d], b[d], sum);
        }
        sum
    }
    /// sum + a v.
    #[inline(always)]
    pub fn add_scaled<const N: usize>(&self, sum: &mut SVector<T, N>, a: T, v: &SVector<T, N>) {
        for d in 0..N {
            sum[d] = self.fma(a, v[d], sum[d]);
        }
    }
    /// t = |Y|²/|ξ|² − 1 without cancellation, η·(η + 2ξ)/|ξ|².
    #[inline(always)]
    pub fn square_strain(&self) -> T {
        self.dot(&self.eta, &(self.eta + self.twice)) * self.inverse_square
    }
    /// t p(t) of a polynomial p given from its constant c₀ on, as t (c₀ + t r(t)). The small part r
    /// by pairs of coefficients, so that a processor has two things to do at a time:
    /// r = (c₁ + c₂t) + t²((c₃ + c₄t) + t²(…)).
    #[inline(always)]
    fn times_polynomial(&self, t: T, coefficients: &[T]) -> T {
        let [constant, rest @ ..] = coefficients else { return T::zero() };
        let square = t * t;
        let mut pairs = rest.chunks(2).rev().map(|pair| match *pair {
            [even, odd] => self.fma(odd, t, even),
            [even] => even,
            _ => T::zero(),
        });
        let mut r = pairs.next().unwrap_or(T::zero());
        for pair in pairs {
            r = self.fma(r, square, pair);
        }
        t * self.fma(r, t, *constant)
    }
    /// 1 − 1/λ and λ − 1, each to less than two units in the last place, and 1/λ.
    ///
    /// For small |t|, g = 1 − (1+t)^(−½) = t p(t) and λ − 1 = (1+t)^½ − 1 = t q(t) with the
    /// polynomials [`Real::STRETCH`]; else g = t/(λ(1+λ)) and λ − 1 = t/(1+λ) with λ = |Y|/|ξ|.
    #[inline(always)]
    pub fn stretch(&self) -> Stretch<T> {
        let t = self.square_strain();
        let [p, q] = T::STRETCH;
        let g = self.times_polynomial(t, p);
        let strain = self.times_polynomial(t, q);
        let near = Stretch { g, strain, inverse: T::one() - g };
        if self.arithmetic.small {
            return near;
        }
        let y = self.deformed();
        let lambda = (self.dot(&y, &y) * self.inverse_square).sqrt();
        let shared = (lambda * (T::one() + lambda)).recip();
        let far = Stretch {
            g: t * shared,
            strain: t * shared * lambda,
            inverse: (T::one() + lambda) * shared,
        };
        // Blends, not branches: both sides are known. NaN takes the exact side.
        let small = t.abs() <= T::of(Self::SMALL);
        let blend = |near: T, far: T| if small { near } else { far };
        Stretch {
            g: blend(near.g, far.g),
            strain: blend(near.strain, far.strain),
            inverse: blend(near.inverse, far.inverse),
        }
    }
    /// Extension e = |Y| − |ξ| = |ξ|(λ − 1) and direction M = Y/|Y|; `length` is |ξ|.
    #[inline(always)]
    pub fn extension_and_direction(&self, length: T) -> (T, SVector<T, D>) {
        let Stretch { strain, inverse, .. } = self.stretch();
        (length * strain, self.deformed() * (inverse * (length * self.inverse_square)))
    }
    /// Extension e = |Y| − |ξ|; `length` is |ξ|.
    #[inline(always)]
    pub fn extension(&self, length: T) -> T {
        length * self.stretch().strain
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

#[cfg(test)]
mod tests {
    use super::*;

    /// a + b and a · b as unevaluated sums of two numbers, exact.
    fn two_sum(a: f64, b: f64) -> [f64; 2] {
        let sum = a + b;
        let part = sum - a;
        [sum, (a - (sum - part)) + (b - part)]
    }
    fn two_product(a: f64, b: f64) -> [f64; 2] {
        let product = a * b;
        [product, a.mul_add(b, -product)]
    }
    /// Product of two such sums, to about 2⁻¹⁰⁰.
    fn product([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
        let [p, e] = two_product(a, c);
        two_sum(p, e + (a * d + b * c))
    }
    fn ulp(x: f64) -> f64 {
        let x = x.abs();
        f64::from_bits(x.to_bits() + 1) - x
    }

    /// Error of g and λ − 1 in units in the last place, by the residuals of (1−g)²(1+t) = 1 and
    /// (1 + (λ−1))² = 1 + t in twice the precision.
    fn errors(t: f64, found: Stretch<f64>) -> [f64; 2] {
        let square = two_sum(1.0, t);
        let [inverse, lambda] = [two_sum(1.0, -found.g), two_sum(1.0, found.strain)];
        let [high, low] = product(product(inverse, inverse), square);
        let g = ((high - 1.0) + low) / (2.0 * (1.0 - found.g) * (1.0 + t));
        let [high, low] = product(lambda, lambda);
        let e = ((high - square[0]) + (low - square[1])) / (2.0 * (1.0 + found.strain));
        [g.abs() / ulp(found.g), e.abs() / ulp(found.strain)]
    }

    /// Bonds with t from −1/32 to 1/32 and the paths that a kernel may take.
    fn for_every_small_bond(mut check: impl FnMut(Bond<f64, 1>)) {
        for sign in [-1.0, 1.0] {
            for k in 0..40_000 {
                // Dense near the ends of the range, down to 1e-9.
                let size =
                    (Bond::<f64, 1>::SMALL * 0.999_999) * (-20.0 * k as f64 / 40_000.0).exp();
                let eta = (1.0 + sign * size).sqrt() - 1.0;
                for (small, fused) in [(true, true), (true, false), (false, true), (false, false)] {
                    let path = Arithmetic { small, fused };
                    check(Bond::of_kernel([1.0].into(), [eta].into(), 1.0, path));
                }
            }
        }
    }

    #[test]
    fn polynomials_are_right_to_a_few_units_in_the_last_place() {
        let mut worst = [0.0_f64; 2];
        for_every_small_bond(|bond| {
            let error = errors(bond.square_strain(), bond.stretch());
            worst = [worst[0].max(error[0]), worst[1].max(error[1])];
        });
        assert!(worst[0] < 2.0 && worst[1] < 2.0, "{worst:?}");
        assert!(worst[0] > 0.5, "an error of less than rounding means that nothing was measured");
    }

    #[test]
    fn single_precision_is_right_to_two_units_in_the_last_place() {
        for k in 1..=20_000 {
            for sign in [-1.0_f32, 1.0] {
                let eta = sign * 0.0155 * k as f32 / 20_000.0;
                for fused in [true, false] {
                    let path = Arithmetic { small: true, fused };
                    let bond = Bond::<f32, 1>::of_kernel([1.0].into(), [eta].into(), 1.0, path);
                    let t = f64::from(bond.square_strain());
                    let found = bond.stretch().g;
                    let exact = t / (1.0 + t + (1.0 + t).sqrt());
                    let unit = f64::from(f32::from_bits(found.abs().to_bits() + 1) - found.abs());
                    assert!((f64::from(found) - exact).abs() < 2.0 * unit, "t = {t}");
                }
            }
        }
    }

    /// A bond has the same bits whether its block was taken for small or not.
    #[test]
    fn known_small_or_found_small_is_the_same() {
        for_every_small_bond(|bond| {
            let other = Arithmetic { small: !bond.arithmetic.small, ..bond.arithmetic };
            let other = Bond { arithmetic: other, ..bond };
            let (a, b) = (bond.stretch(), other.stretch());
            assert!(a.g == b.g && a.strain == b.strain && a.inverse == b.inverse);
        });
    }

    #[test]
    fn large_stretches_take_the_exact_path() {
        for lambda in [0.01, 0.5, 0.9, 0.98, 1.02, 1.5, 3.0, 100.0] {
            let bond = Bond::<f64, 1>::new([2.0].into(), [2.0 * (lambda - 1.0)].into());
            let found = bond.stretch();
            assert!((found.g / (1.0 - 1.0 / lambda) - 1.0).abs() < 1e-12, "λ = {lambda}");
            assert!((found.strain / (lambda - 1.0) - 1.0).abs() < 1e-12, "λ = {lambda}");
            assert!((found.inverse * lambda - 1.0).abs() < 1e-12, "λ = {lambda}");
        }
    }
}
