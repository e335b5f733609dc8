//! Ordinary materials with any stiffness: two calibrations (Scabbia §4 and the positive split).

use crate::Result;
use crate::elasticity::Stiffness;
use crate::elasticity::voigt::voigt_direction;
use crate::kinematics::{BondLength, product};
use crate::linear_solid::weighted_volume;
use crate::ordinary::ScalarState;
use nalgebra::{Matrix6, SMatrix, SVector};
use pd_core::bond::{Bond, Neighbourhood, Scale};
use pd_core::influence::Influence;
use pd_core::{Real, Result as CoreResult};
use std::sync::Arc;

/// Scabbia's polynomial micromoduli (Eqs. 21–24, 28–34), with S = D(D−1)/2 shear products:
///
/// T = (ω/m)[k⟨n⟩ e + |ξ| Λ(n)] M, Λ(n) = (1/m) Σ λ⟨n, n'⟩ ω|ζ| e βV.
///
/// λ is bilinear in the shear products n_a n_b, so Λ needs one sum per product and node.
/// Errata 004-1, 004-6, 004-7 are corrected. **These micromoduli are unstable for strongly
/// anisotropic materials** (`docs/errata.md`, Remark 3): a run refuses such a body with ω² and the
/// wave ([`UnstableBody`](pd_core::Error::UnstableBody)),
/// [`Symbol::stability`](pd_core::symbol::Symbol::stability) says so before, and [`PositiveSplit`]
/// is stable for all.
#[derive(Clone)]
pub struct PolynomialMicromoduli<const D: usize, const S: usize> {
    /// Coefficient of each monomial n_a n_b n_c n_d of k, by the exponents of x, y, z.
    k: Vec<([i32; D], f64)>,
    /// λ by pairs of shear products (yz, xz, xy in 3D; xy in 2D).
    lambda: SMatrix<f64, S, S>,
    density: f64,
    influence: Arc<dyn Influence>,
}

impl PolynomialMicromoduli<2, 1> {
    /// A plate with plane stiffness C (Eqs. 30a–f).
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn plane(
        stiffness: &Stiffness<2>,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        let c = |i, j, k, l| stiffness.c(i, j, k, l);
        let (xxxx, yyyy, xxyy) = (c(0, 0, 0, 0), c(1, 1, 1, 1), c(0, 0, 1, 1));
        let (xxxy, yyxy, xyxy) = (c(0, 0, 0, 1), c(1, 1, 0, 1), c(0, 1, 0, 1));
        let k = vec![
            ([4, 0], 5.0 * xxxx - 10.0 * xxyy + yyyy),
            ([2, 2], 76.0 * xxyy - 10.0 * (xxxx + yyyy)),
            ([0, 4], xxxx - 10.0 * xxyy + 5.0 * yyyy),
            ([3, 1], 40.0 * xxxy - 24.0 * yyxy),
            ([1, 3], 40.0 * yyxy - 24.0 * xxxy),
        ];
        let lambda = SMatrix::<f64, 1, 1>::new(64.0 * (xyxy - xxyy));
        Self::new(k, lambda, density, influence)
    }
}

impl PolynomialMicromoduli<3, 3> {
    /// A solid with stiffness C (Eqs. 34a–u).
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn solid(
        stiffness: &Stiffness<3>,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        let c = |i, j, k, l| stiffness.c(i, j, k, l);
        let normal = |i: usize, j: usize| c(i, i, j, j);
        let mut k = Vec::new();
        // The formulas are the same for every choice of the axes a, b and the third one, d.
        for a in 0..3 {
            let (b, d) = ((a + 1) % 3, (a + 2) % 3);
            let power = |pairs: &[(usize, i32)]| {
                let mut exponents = [0; 3];
                pairs.iter().for_each(|&(axis, n)| exponents[axis] += n);
                exponents
            };
            k.push((
                power(&[(a, 4)]),
                15.0 * normal(a, a) + 15.0 / 8.0 * (normal(b, b) + normal(d, d))
                    - 45.0 / 2.0 * (normal(a, b) + normal(a, d))
                    + 15.0 / 4.0 * normal(b, d),
            ));
            k.push((
                power(&[(a, 2), (b, 2)]),
                765.0 / 4.0 * normal(a, b)
                    - 75.0 / 4.0 * (normal(a, d) + normal(b, d))
                    - 45.0 / 2.0 * (normal(a, a) + normal(b, b))
                    + 15.0 / 4.0 * normal(d, d),
            ));
            for (p, q) in [(b, d), (d, b)] {
                k.push((
                    power(&[(p, 3), (q, 1)]),
                    105.0 * c(p, p, p, q) - 105.0 / 2.0 * (c(q, q, p, q) + c(a, a, p, q)),
                ));
            }
            k.push((
                power(&[(a, 2), (b, 1), (d, 1)]),
                420.0 * c(a, a, b, d) - 105.0 / 2.0 * (c(b, b, b, d) + c(d, d, b, d)),
            ));
        }
        // Shear product r (yz, xz, xy) is the one without axis r.
        let pair = [(1, 2), (0, 2), (0, 1)];
        let lambda = SMatrix::<f64, 3, 3>::from_fn(|r, s| {
            let ((i, j), (p, q)) = (pair[r], pair[s]);
            let cauchy = if r == s {
                normal(i, j)
            } else {
                let shared = 3 - r - s;
                c(shared, shared, r, s)
            };
            225.0 * (c(i, j, p, q) - cauchy)
        });
        Self::new(k, lambda, density, influence)
    }
}

impl<const D: usize, const S: usize> PolynomialMicromoduli<D, S> {
    fn new(
        k: Vec<([i32; D], f64)>,
        lambda: SMatrix<f64, S, S>,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        let density = pd_core::Error::positive("density ρ [kg/m³]", density)?;
        Ok(Self { k, lambda, density, influence: Arc::new(influence) })
    }
    /// k⟨n⟩ in Pa for a direction n.
    pub fn micromodulus(&self, n: &SVector<f64, D>) -> f64 {
        let monomial =
            |powers: &[i32; D]| -> f64 { (0..D).map(|d| n[d].powi(powers[d])).product() };
        self.k.iter().map(|(powers, k)| k * monomial(powers)).sum()
    }
}

impl<const D: usize, const S: usize> PolynomialMicromoduli<D, S> {
    /// Stiffness in Pa (Voigt) of a family of bonds (ξ, βV), in any unit of length, whose horizon is
    /// `horizon` (Scabbia Eq. 42):
    ///
    /// C = (1/m) Σ ω|ξ|² k⟨n⟩ v vᵀ βV + (1/m²) S λ Sᵀ, S = Σ ω|ξ|² v sᵀ βV,
    ///
    /// with v the products n_i n_j and s those of them that are shears. The double sum of the paper
    /// is the product S λ Sᵀ.
    pub fn elasticity_tensor<const V: usize>(
        &self,
        family: &[(SVector<f64, D>, f64)],
        horizon: f64,
    ) -> SMatrix<f64, V, V> {
        let (mut m, mut bonds, mut shear) = (0.0, SMatrix::zeros(), SMatrix::<f64, V, S>::zeros());
        for (xi, volume) in family {
            let n = xi.normalize();
            let v: SVector<f64, V> = voigt_direction(&n);
            let products: SVector<f64, S> = shear_products(&n);
            let weight = self.influence.weight(xi.norm() / horizon) * xi.norm_squared() * volume;
            m += weight;
            bonds += v * v.transpose() * (weight * self.micromodulus(&n));
            shear += v * products.transpose() * weight;
        }
        bonds / m + shear * self.lambda * shear.transpose() / (m * m)
    }
}

/// Shear products n_a n_b of a direction: xy in 2D; yz, xz, xy in 3D.
fn shear_products<const D: usize, const S: usize>(n: &SVector<f64, D>) -> SVector<f64, S> {
    SVector::from_fn(|r, _| if D == 2 { n[0] * n[1] } else { n[(r + 1) % 3] * n[(r + 2) % 3] })
}

/// Constants of a bond of [`PolynomialMicromoduli`].
#[derive(Debug, Clone, Copy)]
pub struct PolynomialBond<T, const S: usize> {
    omega: T,
    /// ω k⟨n⟩.
    stiffness: T,
    /// ω|ξ| times the shear products of n.
    shear: SVector<T, S>,
}

impl<T: Real, const D: usize, const S: usize> ScalarState<T, D> for PolynomialMicromoduli<D, S> {
    type BondConst = PolynomialBond<T, S>;
    /// 1/m.
    type NodeConst = T;
    type FamilyConst = ();
    /// Σ ω|ζ| n_a n_b e βV.
    type FamilySum = SVector<T, S>;
    /// λ · sum / m².
    type NodeState = SVector<T, S>;

    fn density(&self, _: usize) -> f64 {
        self.density
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> PolynomialBond<T, S> {
        let (length, n) = (xi.norm(), xi.normalize());
        let omega = self.influence.weight(length / scale.horizon);
        let products: SVector<f64, S> = shear_products(&n);
        PolynomialBond {
            omega: T::of(omega),
            stiffness: T::of(omega * self.micromodulus(&n)),
            shear: (products * (omega * length)).map(T::of),
        }
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, (BondLength<T>, PolynomialBond<T, S>), D>,
    ) -> CoreResult<(T, ())> {
        let m = family.sum(|m| m.bond.1.omega.to_f64() * m.xi.norm_squared());
        weighted_volume(m, family.node, true).map(|m| (T::of(1.0 / m), ()))
    }
    #[inline(always)]
    fn add(
        &self,
        sum: &mut SVector<T, S>,
        bond: &Bond<T, D>,
        e: T,
        k: &PolynomialBond<T, S>,
        volume: T,
    ) {
        bond.add_scaled(sum, e * volume, &k.shear);
    }
    #[inline(always)]
    fn close(&self, sum: &SVector<T, S>, inverse_m: &T, (): &()) -> SVector<T, S> {
        product(&self.lambda.map(T::of), sum) * (*inverse_m * *inverse_m)
    }
    #[inline(always)]
    fn line(
        &self,
        bond: &Bond<T, D>,
        weight: T,
        k: &PolynomialBond<T, S>,
        inverse_m: &T,
        state: &SVector<T, S>,
    ) -> (Option<T>, T) {
        (Some(bond.dot(&k.shear, state) * weight), *inverse_m * (k.stiffness * weight))
    }
}

/// The positive split: ordinary, any positive definite C, stable, with exactly the energy of C
/// under homogeneous strain at every node, boundary nodes too. V = D(D+1)/2 Voigt components.
///
/// W = (k₀/2m) Σ ω e² βV + ½ s·L·s with the nonlocal strain s = 𝓜⁻¹ Σ μ ω|ξ| e v βV,
/// 𝓜 = Σ ω|ξ|² v vᵀ βV, v = (n_x², …, n_x n_y), L = C − (k₀/m) 𝓜 and
/// k₀ = κ / λ_max(C⁻¹𝓜/m), the fraction κ of the largest that leaves L positive semi-definite.
/// T = ω[(k₀/m) e + |ξ| v·𝓜⁻¹ L s] M.
///
/// The bonds may carry more along a fibre f ([`with_fibre`](Self::with_fibre)): k₀ g⟨n⟩ in place of
/// k₀, g = 1 + r (n·f)⁴, and Σ ω|ξ|² g v vᵀ βV in place of 𝓜 in L and k₀.
#[derive(Clone)]
pub struct PositiveSplit<const D: usize, const V: usize> {
    stiffness: SMatrix<f64, V, V>,
    /// Inverse of the Cholesky factor of C, in the corner of a 6 × 6 matrix.
    inverse_factor: Matrix6<f64>,
    kappa: f64,
    /// Unit vector along the fibre, and r.
    fibre: Option<(SVector<f64, D>, f64)>,
    density: f64,
    influence: Arc<dyn Influence>,
}

impl PositiveSplit<2, 3> {
    /// A plate with plane stiffness C.
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn plane(
        stiffness: &Stiffness<2>,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        Self::new(stiffness.voigt(), density, influence)
    }
}

impl PositiveSplit<3, 6> {
    /// A solid with stiffness C.
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn solid(
        stiffness: &Stiffness<3>,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        Self::new(stiffness.voigt(), density, influence)
    }
}

impl<const D: usize, const V: usize> PositiveSplit<D, V> {
    fn new(
        stiffness: SMatrix<f64, V, V>,
        density: f64,
        influence: impl Influence + 'static,
    ) -> Result<Self> {
        let density = pd_core::Error::positive("density ρ [kg/m³]", density)?;
        // `Stiffness` is positive definite, so the factor exists.
        let inverse_factor = embed(&stiffness, 1.0)
            .cholesky()
            .and_then(|factor| factor.l().try_inverse())
            .unwrap_or_else(Matrix6::identity);
        let influence = Arc::new(influence);
        Ok(Self { stiffness, inverse_factor, kappa: 0.9, fibre: None, density, influence })
    }
    /// Bonds along `fibre` carry 1 + r times as much as those across: g = 1 + r (n·f)⁴. The
    /// stiffness, and that no wave grows, are the same for every r ≥ 0.
    ///
    /// # Errors
    /// A direction of no length, an r that is negative or not finite.
    pub fn with_fibre(mut self, fibre: [f64; D], r: f64) -> Result<Self> {
        let fibre = SVector::from(fibre);
        let length = pd_core::Error::positive("length of the fibre's direction", fibre.norm())?;
        let ok = r >= 0.0 && r.is_finite();
        let r = pd_core::Error::check(ok, "share r of bonds along the fibre", r, "at least 0")?;
        self.fibre = Some((fibre / length, r));
        Ok(self)
    }
    /// g⟨n⟩.
    fn emphasis(&self, n: &SVector<f64, D>) -> f64 {
        self.fibre.map_or(1.0, |(fibre, r)| 1.0 + r * n.dot(&fibre).powi(4))
    }
    /// The share κ of the largest k₀ that is put into the bonds (0.9 by default).
    ///
    /// # Errors
    /// Outside [0, 1]: the energy would not be positive.
    pub fn with_bond_share(mut self, kappa: f64) -> Result<Self> {
        let need = "between 0 and 1: beyond, L is not positive semi-definite";
        let ok = (0.0..=1.0).contains(&kappa);
        self.kappa = pd_core::Error::check(ok, "bond share κ", kappa, need)?;
        Ok(self)
    }
}

/// A V × V matrix in the corner of a 6 × 6 one, `fill` on the rest of the diagonal: one fixed
/// size serves 2D and 3D.
fn embed<const V: usize>(a: &SMatrix<f64, V, V>, fill: f64) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| match (i < V && j < V, i == j) {
        (true, _) => a[(i, j)],
        (false, true) => fill,
        (false, false) => 0.0,
    })
}

/// Constants of a bond of [`PositiveSplit`].
#[derive(Debug, Clone, Copy)]
pub struct SplitBond<T, const V: usize> {
    /// ω g.
    omega: T,
    /// ω|ξ| v.
    strain: SVector<T, V>,
}

impl<T: Real, const D: usize, const V: usize> ScalarState<T, D> for PositiveSplit<D, V> {
    type BondConst = SplitBond<T, V>;
    /// k₀/m.
    type NodeConst = T;
    /// 𝓜⁻¹ L 𝓜⁻¹.
    type FamilyConst = SMatrix<T, V, V>;
    /// Σ ω|ξ| e v βV.
    type FamilySum = SVector<T, V>;
    /// 𝓜⁻¹ L s.
    type NodeState = SVector<T, V>;

    fn density(&self, _: usize) -> f64 {
        self.density
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> SplitBond<T, V> {
        let (length, n) = (xi.norm(), xi.normalize());
        let omega = self.influence.weight(length / scale.horizon);
        let strain: SVector<f64, V> = voigt_direction(&n) * (omega * length);
        SplitBond { omega: T::of(omega * self.emphasis(&n)), strain: strain.map(T::of) }
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, (BondLength<T>, SplitBond<T, V>), D>,
    ) -> CoreResult<(T, SMatrix<T, V, V>)> {
        let mut m = 0.0;
        let mut moment = SMatrix::<f64, V, V>::zeros();
        let mut carried = moment;
        for member in family.members {
            let n = member.xi.normalize();
            let v: SVector<f64, V> = voigt_direction(&n);
            let omega = self.influence.weight(member.xi.norm() / family.scale.horizon);
            let weight = omega * member.xi.norm_squared() * member.volume;
            m += weight;
            moment += v * v.transpose() * weight;
            carried += v * v.transpose() * (weight * self.emphasis(&n));
        }
        weighted_volume(m, family.node, true)?;
        let scaled =
            self.inverse_factor * embed(&(carried / m), 0.0) * self.inverse_factor.transpose();
        let values = scaled.symmetric_eigenvalues();
        let k0 = self.kappa / values.max();
        let inverse = inverse_moment(&moment, m, family.node, family.members.len())?;
        let rest = self.stiffness - carried * (k0 / m);
        let spread = inverse * rest * inverse;
        Ok((T::of(k0 / m), spread.map(T::of)))
    }
    #[inline(always)]
    fn add(
        &self,
        sum: &mut SVector<T, V>,
        bond: &Bond<T, D>,
        e: T,
        k: &SplitBond<T, V>,
        volume: T,
    ) {
        bond.add_scaled(sum, e * volume, &k.strain);
    }
    #[inline(always)]
    fn close(&self, sum: &SVector<T, V>, _: &T, spread: &SMatrix<T, V, V>) -> SVector<T, V> {
        product(spread, sum)
    }
    #[inline(always)]
    fn line(
        &self,
        bond: &Bond<T, D>,
        weight: T,
        k: &SplitBond<T, V>,
        k0_over_m: &T,
        state: &SVector<T, V>,
    ) -> (Option<T>, T) {
        (Some(bond.dot(&k.strain, state) * weight), *k0_over_m * (k.omega * weight))
    }
}

/// 𝓜⁻¹, unless the family cannot tell all strains apart; m = Σω|ξ|²βV.
pub(crate) fn inverse_moment<const V: usize>(
    moment: &SMatrix<f64, V, V>,
    m: f64,
    node: usize,
    neighbours: usize,
) -> CoreResult<SMatrix<f64, V, V>> {
    let values = embed(&(moment / m), 1.0).symmetric_eigenvalues();
    let condition = values.max() / values.min();
    let inverse = moment.try_inverse().filter(|_| condition > 0.0 && condition < LIMIT);
    inverse.ok_or(pd_core::Error::SingularShapeTensor {
        node,
        condition: if condition > 0.0 { condition } else { f64::INFINITY },
        limit: LIMIT,
        neighbours,
    })
}

/// Largest condition number of 𝓜: beyond, the family cannot tell all strains apart.
const LIMIT: f64 = 1e8;
