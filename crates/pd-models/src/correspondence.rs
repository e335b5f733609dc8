//! Non-ordinary correspondence (NOSB, Hattori §3.1): a classical constitutive law at every node.

use crate::elasticity::Stiffness;
use crate::elasticity::voigt::small_strain;
use crate::kinematics::product;
use crate::{Error, Result};
use nalgebra::{SMatrix, SVector};
use pd_core::bond::{Bond, End, Neighbourhood, Scale};
use pd_core::influence::{Influence, moment};
use pd_core::material::{Material, StrainEnergy, StressState};
use pd_core::record::Record;
use pd_core::shape::{ShapePolicy, shape_tensor};
use pd_core::{Real, Result as CoreResult};
use std::f64::consts::PI;
use std::sync::Arc;

/// A classical constitutive law. H = F − I is the displacement gradient, first index spatial.
///
/// A law of your own is the one method [`stress`](Self::stress).
pub trait Constitutive<T: Real, const D: usize>: Send + Sync {
    /// First Piola–Kirchhoff stress P = ∂W/∂F in Pa (errata 000-1, 000-2), P_iJ.
    fn stress(&self, h: &SMatrix<T, D, D>) -> SMatrix<T, D, D>;

    /// Cauchy stress σ = P Fᵀ/J in Pa (for small strains P itself).
    #[inline(always)]
    fn cauchy(&self, h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let f = h + SMatrix::identity();
        self.stress(h) * f.transpose() / determinant(&f)
    }
    /// True if the law needs J = det F > 0.
    const NEEDS_POSITIVE_J: bool = false;
    /// True if P is linear in H.
    const LINEAR: bool = false;
}

/// A law with an energy density, so that energies can be reported.
pub trait Hyperelastic<T: Real, const D: usize>: Constitutive<T, D> {
    /// W in Pa.
    fn energy(&self, h: &SMatrix<T, D, D>) -> T;
}

/// Σ A_ij B_ij.
#[inline(always)]
fn double_dot<T: Real, const D: usize>(a: &SMatrix<T, D, D>, b: &SMatrix<T, D, D>) -> T {
    a.component_mul(b).sum()
}

/// Determinant for D = 1, 2, 3 without branches on data.
#[inline(always)]
fn determinant<T: Real, const D: usize>(a: &SMatrix<T, D, D>) -> T {
    match D {
        1 => a[0],
        2 => a[(0, 0)] * a[(1, 1)] - a[(0, 1)] * a[(1, 0)],
        _ => {
            let minor = |i: usize, j: usize| a[(1, i)] * a[(2, j)] - a[(1, j)] * a[(2, i)];
            a[(0, 0)] * minor(1, 2) - a[(0, 1)] * minor(0, 2) + a[(0, 2)] * minor(0, 1)
        }
    }
}

/// A⁻ᵀ det A for D = 2, 3 (the cofactor matrix).
#[inline(always)]
fn cofactor<T: Real, const D: usize>(a: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
    SMatrix::from_fn(|i, j| {
        if D == 2 {
            let sign = if i == j { T::one() } else { -T::one() };
            sign * a[(1 - i, 1 - j)]
        } else {
            let (r, s) = ((i + 1) % D, (i + 2) % D);
            let (p, q) = ((j + 1) % D, (j + 2) % D);
            a[(r, p)] * a[(s, q)] - a[(r, q)] * a[(s, p)]
        }
    })
}

/// Linear elasticity for small strains with any stiffness: ε = sym(H), P ≈ σ = C:ε.
#[derive(Debug, Clone)]
pub struct LinearElastic<const D: usize>(pub Stiffness<D>);

impl<T: Real, const D: usize> Constitutive<T, D> for LinearElastic<D> {
    const LINEAR: bool = true;
    #[inline(always)]
    fn stress(&self, h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        self.0.contract(&small_strain(h))
    }
    #[inline(always)]
    fn cauchy(&self, h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        self.stress(h)
    }
}

impl<T: Real, const D: usize> Hyperelastic<T, D> for LinearElastic<D> {
    #[inline(always)]
    fn energy(&self, h: &SMatrix<T, D, D>) -> T {
        T::of(0.5) * double_dot(&self.stress(h), h)
    }
}

/// Saint-Venant–Kirchhoff with any stiffness: E = ½(H + Hᵀ + HᵀH), S = C:E, P = F S.
#[derive(Debug, Clone)]
pub struct SaintVenantKirchhoff<const D: usize>(pub Stiffness<D>);

impl<const D: usize> SaintVenantKirchhoff<D> {
    #[inline(always)]
    fn green<T: Real>(h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        (h + h.transpose() + h.transpose() * h) * T::of(0.5)
    }
}

impl<T: Real, const D: usize> Constitutive<T, D> for SaintVenantKirchhoff<D> {
    const NEEDS_POSITIVE_J: bool = true;
    #[inline(always)]
    fn stress(&self, h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let s = self.0.contract(&Self::green(h));
        s + product(h, &s)
    }
}

impl<T: Real, const D: usize> Hyperelastic<T, D> for SaintVenantKirchhoff<D> {
    #[inline(always)]
    fn energy(&self, h: &SMatrix<T, D, D>) -> T {
        let e = Self::green(h);
        T::of(0.5) * double_dot(&self.0.contract(&e), &e)
    }
}

/// Compressible neo-Hookean: W = ½μ(tr FᵀF − D) − μ ln J + ½λ (ln J)², P = μ(F − F⁻ᵀ) + λ ln J F⁻ᵀ.
/// In 2D plane strain with the Lamé constants of space.
#[derive(Debug, Clone, Copy)]
pub struct NeoHookean {
    /// Lamé's λ in Pa.
    lambda: f64,
    /// Shear modulus μ in Pa.
    mu: f64,
}

impl NeoHookean {
    /// From isotropic moduli.
    pub fn new(moduli: &crate::elasticity::Isotropic) -> Self {
        Self { lambda: moduli.lame(), mu: moduli.shear() }
    }
}

impl NeoHookean {
    /// J − 1 = tr H + q and cof F − 1, both by powers of H, so that small strains keep their digits;
    /// q first.
    #[inline(always)]
    fn volume_change<T: Real, const D: usize>(h: &SMatrix<T, D, D>) -> (T, T, SMatrix<T, D, D>) {
        let trace = h.trace();
        let linear = SMatrix::identity() * trace - h.transpose();
        let (square, cofactor) = if D == 3 {
            let cofactor = cofactor(h);
            (cofactor.trace() + determinant(h), linear + cofactor)
        } else {
            (determinant(h), linear)
        };
        (square, trace + square, cofactor)
    }
}

impl<T: Real, const D: usize> Constitutive<T, D> for NeoHookean {
    const NEEDS_POSITIVE_J: bool = true;
    /// μ(F − F⁻ᵀ) = μ(H + ((J − 1) − (cof F − 1))/J).
    #[inline(always)]
    fn stress(&self, h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let (_, excess, cofactor) = Self::volume_change(h);
        let inverse_j = (T::one() + excess).recip();
        let (lambda, mu) = (T::of(self.lambda), T::of(self.mu));
        let one = SMatrix::<T, D, D>::identity();
        let shear = h + (one * excess - cofactor) * inverse_j;
        shear * mu + (one + cofactor) * (inverse_j * lambda * excess.ln_1p())
    }
}

impl<T: Real, const D: usize> Hyperelastic<T, D> for NeoHookean {
    /// tr FᵀF − D − 2 ln J = H:H − 2q + 2(x − ln(1 + x)) with x = J − 1 = tr H + q.
    #[inline(always)]
    fn energy(&self, h: &SMatrix<T, D, D>) -> T {
        let (square, x, _) = Self::volume_change(h);
        let ln_j = x.ln_1p();
        // x − ln(1 + x), of second order: its series where the difference would lose digits.
        let mut series = T::zero();
        for k in (2..10).rev() {
            series = T::of(if k % 2 == 0 { 1.0 } else { -1.0 } / f64::from(k)) + x * series;
        }
        let rest = if x.abs() < T::of(0.01) { x * x * series } else { x - ln_j };
        let (half, lambda, mu) = (T::of(0.5), T::of(self.lambda), T::of(self.mu));
        mu * (half * double_dot(h, h) - square + rest) + half * lambda * ln_j * ln_j
    }
}

/// Control of zero-energy modes: what a node adds to T for the part of a bond that F does not
/// explain, z = Y − Fξ = η − Hξ.
pub trait ZeroEnergyControl<T: Real, const D: usize>: Send + Sync {
    /// What it needs of a node.
    type NodeConst: Record<T>;
    /// From the node's B and the sum of ω βV.
    fn node_const(&self, b: &SMatrix<f64, D, D>, omega_sum: f64, scale: Scale) -> Self::NodeConst;
    /// C a, with Z⟨ξ⟩ = C z and T = ω (P B ξ + Z).
    fn stiffness_times<const N: usize>(
        &self,
        c: &Self::NodeConst,
        a: &SMatrix<T, D, N>,
    ) -> SMatrix<T, D, N>;
    /// sum + C η of a bond.
    #[inline(always)]
    fn add_to(&self, sum: &mut SVector<T, D>, c: &Self::NodeConst, bond: &Bond<T, D>) {
        *sum += self.stiffness_times(c, &bond.eta);
    }
}

/// No control, as in Hattori: every zone-corner wave is a zero-energy mode (errata 000-20).
#[derive(Debug, Clone, Copy, Default)]
pub struct NoControl;

impl<T: Real, const D: usize> ZeroEnergyControl<T, D> for NoControl {
    type NodeConst = ();
    fn node_const(&self, _: &SMatrix<f64, D, D>, _: f64, _: Scale) {}
    #[inline(always)]
    fn stiffness_times<const N: usize>(&self, (): &(), _: &SMatrix<T, D, N>) -> SMatrix<T, D, N> {
        SMatrix::zeros()
    }
    #[inline(always)]
    fn add_to(&self, _: &mut SVector<T, D>, (): &(), _: &Bond<T, D>) {}
}

/// Silling 2017: Z = (g c/ω₀) z with ω₀ = Σ ω βV and c = 18K/(πδ⁴) in 3D (2D²κ/∫|ξ|dV in general).
#[derive(Debug, Clone, Copy)]
pub struct SillingControl {
    modulus: f64,
    strength: f64,
}

impl SillingControl {
    /// With the bulk modulus of space or plane in Pa and the strength g (about 1).
    ///
    /// # Errors
    /// A modulus that is not positive, a strength that is negative.
    pub fn new(bulk: f64, strength: f64) -> Result<Self> {
        let modulus = pd_core::Error::positive("bulk modulus κ [Pa]", bulk)?;
        Ok(Self { modulus, strength: checked_strength(strength)? })
    }
}

pub(crate) fn checked_strength(g: f64) -> Result<f64> {
    Ok(pd_core::Error::check(g.is_finite() && g >= 0.0, "control strength g", g, "finite and ≥ 0")?)
}

impl<T: Real, const D: usize> ZeroEnergyControl<T, D> for SillingControl {
    /// g c/ω₀.
    type NodeConst = T;
    fn node_const(&self, b: &SMatrix<f64, D, D>, omega_sum: f64, scale: Scale) -> T {
        let sphere = if D == 3 { 4.0 * PI } else { 2.0 * PI };
        let constant = |_: f64| 1.0;
        let integral = sphere * scale.horizon.powi(D as i32 + 1) * moment(&constant, D as i32);
        let c = 2.0 * (D * D) as f64 * self.modulus / integral;
        let detached = b.iter().all(|&x| x == 0.0);
        T::of(if detached { 0.0 } else { self.strength * c / omega_sum })
    }
    #[inline(always)]
    fn stiffness_times<const N: usize>(&self, c: &T, a: &SMatrix<T, D, N>) -> SMatrix<T, D, N> {
        a * *c
    }
    #[inline(always)]
    fn add_to(&self, sum: &mut SVector<T, D>, c: &T, bond: &Bond<T, D>) {
        bond.add_scaled(sum, *c, &bond.eta);
    }
}

/// Wan et al. 2019: Z = g C̄ z with C̄_ik = C_ijkl B_jl. g = 1 lifts the softest mode to the
/// elastic value and shortens the stable time step by about half.
#[derive(Debug, Clone)]
pub struct WanControl<const D: usize> {
    stiffness: Stiffness<D>,
    strength: f64,
}

impl<const D: usize> WanControl<D> {
    /// With the material's stiffness and the strength g (about 1).
    ///
    /// # Errors
    /// A strength that is negative.
    pub fn new(stiffness: &Stiffness<D>, strength: f64) -> Result<Self> {
        Ok(Self { stiffness: *stiffness, strength: checked_strength(strength)? })
    }
}

impl<T: Real, const D: usize> ZeroEnergyControl<T, D> for WanControl<D> {
    /// g C̄, which is symmetric as C and B are.
    type NodeConst = Symmetric<T, D>;
    fn node_const(&self, b: &SMatrix<f64, D, D>, _: f64, _: Scale) -> Self::NodeConst {
        let entry = |i: usize, k: usize| {
            let mut sum = 0.0;
            for j in 0..D {
                for l in 0..D {
                    sum += self.stiffness.c(i, j, k, l) * b[(j, l)];
                }
            }
            T::of(self.strength * sum)
        };
        packed(&SMatrix::from_fn(entry))
    }
    #[inline(always)]
    fn stiffness_times<const N: usize>(
        &self,
        c: &Self::NodeConst,
        a: &SMatrix<T, D, N>,
    ) -> SMatrix<T, D, N> {
        product(&unpacked(c), a)
    }
    #[inline(always)]
    fn add_to(&self, sum: &mut SVector<T, D>, c: &Self::NodeConst, bond: &Bond<T, D>) {
        let c = unpacked(c);
        for i in 0..D {
            for k in 0..D {
                sum[i] = bond.fma(c[(i, k)], bond.eta[k], sum[i]);
            }
        }
    }
}

/// A symmetric D × D matrix: its diagonal, and beside each entry d of it the one off the diagonal in
/// the rows and columns other than d (D = 3) or all (D = 2).
pub type Symmetric<T, const D: usize> = (SVector<T, D>, SVector<T, D>);

fn packed<T: Real, const D: usize>(a: &SMatrix<T, D, D>) -> Symmetric<T, D> {
    (a.diagonal(), SVector::from_fn(|d, _| a[((d + 1) % D, (d + 2) % D)]))
}

/// The matrix itself.
#[inline(always)]
pub fn unpacked<T: Real, const D: usize>((diagonal, rest): &Symmetric<T, D>) -> SMatrix<T, D, D> {
    let off_diagonal = |i, k| if D == 3 { 3 - i - k } else { 0 };
    SMatrix::from_fn(|i, k| if i == k { diagonal[i] } else { rest[off_diagonal(i, k)] })
}

/// Correspondence material: H = (Σ μ ω η⊗ξ βV) B, T = ω (P(H) B ξ + Z), B = K⁻¹ of the intact
/// family (errata 000-3: no transpose).
#[derive(Clone)]
pub struct Correspondence<L, Z = NoControl> {
    law: L,
    control: Z,
    density: f64,
    influence: Arc<dyn Influence>,
    shape: ShapePolicy,
}

impl<L> Correspondence<L> {
    /// Without control of zero-energy modes.
    ///
    /// # Errors
    /// A density that is not positive.
    pub fn new(law: L, density: f64, influence: impl Influence + 'static) -> Result<Self> {
        let density =
            pd_core::Error::positive("density ρ [kg/m³]", density).map_err(Error::from)?;
        let (influence, shape) = (Arc::new(influence), ShapePolicy::default());
        Ok(Self { law, control: NoControl, density, influence, shape })
    }
}

impl<L, Z> Correspondence<L, Z> {
    /// With a control of zero-energy modes.
    pub fn with_control<Y>(self, control: Y) -> Correspondence<L, Y> {
        let Self { law, density, influence, shape, .. } = self;
        Correspondence { law, control, density, influence, shape }
    }
    /// With a policy for singular shape tensors.
    pub fn with_shape_policy(mut self, shape: ShapePolicy) -> Self {
        self.shape = shape;
        self
    }
    /// The constitutive law.
    pub fn law(&self) -> &L {
        &self.law
    }
}

impl<L, Z> Correspondence<L, Z> {
    /// T/ω = (P B − C H) ξ + C η.
    #[inline(always)]
    fn per_omega<T: Real, const D: usize>(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, T, Z::NodeConst, CorrespondenceState<T, D>>,
    ) -> SVector<T, D>
    where
        Z: ZeroEnergyControl<T, D>,
    {
        let (a, _) = end.state;
        let mut t = SVector::<T, D>::from_fn(|i, _| a[(i, 0)] * bond.xi[0]);
        for j in 1..D {
            for i in 0..D {
                t[i] = bond.fma(a[(i, j)], bond.xi[j], t[i]);
            }
        }
        self.control.add_to(&mut t, end.node, bond);
        t
    }
}

/// State of a node of [`Correspondence`]: P B − C H, which makes T = ω ((P B − C H) ξ + C η); H; and
/// Σ T⟨ξ⟩βV.
pub type CorrespondenceState<T, const D: usize> =
    (SMatrix<T, D, D>, (SMatrix<T, D, D>, SVector<T, D>));

impl<T, const D: usize, L, Z> Material<T, D> for Correspondence<L, Z>
where
    T: Real,
    L: Constitutive<T, D>,
    Z: ZeroEnergyControl<T, D>,
{
    /// ω.
    type BondConst = T;
    /// What the control needs.
    type NodeConst = Z::NodeConst;
    /// B and Σ μ ω ξ βV.
    type FamilyConst = (Symmetric<T, D>, SVector<T, D>);
    /// Σ μ ω η⊗ξ βV and Σ μ ω η βV.
    type FamilySum = (SMatrix<T, D, D>, SVector<T, D>);
    type NodeState = CorrespondenceState<T, D>;
    const FOLLOWS_DAMAGE: bool = true;
    const LINEAR: bool = L::LINEAR;
    const STRETCH: bool = false;
    const CAN_FAULT: bool = L::NEEDS_POSITIVE_J;

    fn density(&self, _: usize) -> f64 {
        self.density
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> T {
        T::of(self.influence.weight(xi.norm() / scale.horizon))
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, T, D>,
    ) -> CoreResult<(Self::NodeConst, Self::FamilyConst)> {
        let k = shape_tensor(family, |omega| omega.to_f64());
        let weighted = family.members.iter().filter(|m| m.bond > T::zero()).count();
        let b = self.shape.invert(&k, family.node, weighted)?;
        let omega_sum = family.sum(|m| m.bond.to_f64());
        let control = self.control.node_const(&b, omega_sum, family.scale);
        let first = family
            .members
            .iter()
            .fold(SVector::zeros(), |sum, m| sum + m.xi * (m.bond.to_f64() * m.volume));
        Ok((control, (packed(&b.map(T::of)), first.map(T::of))))
    }
    #[inline(always)]
    fn add_bond(
        &self,
        (moment, first): &mut Self::FamilySum,
        bond: &Bond<T, D>,
        end: End<'_, T, T, Self::NodeConst, ()>,
    ) {
        // The small numbers by columns: ξ and ω βV are the same for a whole block of a lattice.
        let weight = *end.bond * end.volume;
        let weighted = bond.xi * weight;
        for j in 0..D {
            for i in 0..D {
                moment[(i, j)] = bond.fma(bond.eta[i], weighted[j], moment[(i, j)]);
            }
        }
        bond.add_scaled(first, weight, &bond.eta);
    }
    #[inline(always)]
    fn node_state(
        &self,
        (moment, first): &Self::FamilySum,
        c: &Self::NodeConst,
        (b, reference): &Self::FamilyConst,
        _: &Self::NodeState,
    ) -> Self::NodeState {
        let b = unpacked(b);
        let h = product(moment, &b);
        let a = product(&self.law.stress(&h), &b) - self.control.stiffness_times(c, &h);
        let force = product(&a, reference) + self.control.stiffness_times(c, first);
        (a, (h, force))
    }
    #[inline(always)]
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, T, Self::NodeConst, Self::NodeState>,
    ) -> SVector<T, D> {
        self.per_omega(bond, end) * *end.bond
    }
    /// −T'β'V, the neighbour's share: seen from the near end T' of the reversed bond is −T.
    #[inline(always)]
    fn add_pair_force(
        &self,
        sum: &mut SVector<T, D>,
        bond: &Bond<T, D>,
        [_, far]: [End<'_, T, T, Self::NodeConst, Self::NodeState>; 2],
    ) {
        bond.add_scaled(sum, *far.bond * far.volume, &self.per_omega(bond, far));
    }
    /// Σ T⟨ξ⟩βV, the node's own share.
    #[inline(always)]
    fn node_force(&self, _: &Self::NodeConst, (_, (_, force)): &Self::NodeState) -> SVector<T, D> {
        *force
    }
    #[inline(always)]
    fn detached(&self, ((diagonal, _), _): &Self::FamilyConst) -> bool {
        diagonal.sum() == T::zero()
    }
    fn fault(&self, (_, (h, _)): &Self::NodeState) -> Option<f64> {
        let j = determinant(&(h + SMatrix::identity())).to_f64();
        (j <= 0.0 || j.is_nan()).then_some(j)
    }
}

impl<T, const D: usize, L, Z> StressState<T, D> for Correspondence<L, Z>
where
    T: Real,
    L: Constitutive<T, D>,
    Z: ZeroEnergyControl<T, D>,
{
    #[inline(always)]
    fn stress(&self, _: &Self::NodeConst, (_, (h, _)): &Self::NodeState) -> SMatrix<T, D, D> {
        self.law.cauchy(h)
    }
}

impl<T, const D: usize, L, Z> StrainEnergy<T, D> for Correspondence<L, Z>
where
    T: Real,
    L: Hyperelastic<T, D>,
    Z: ZeroEnergyControl<T, D>,
{
    #[inline(always)]
    fn node_energy(&self, _: &Self::NodeConst, (_, (h, _)): &Self::NodeState) -> T {
        self.law.energy(h)
    }
    #[inline(always)]
    fn bond_energy(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, T, Self::NodeConst, Self::NodeState>,
    ) -> T {
        let (_, (h, _)) = end.state;
        let z = bond.eta - h * bond.xi;
        T::of(0.5) * *end.bond * self.control.stiffness_times(end.node, &z).dot(&z)
    }
}
