//! The symbol of bond-based materials against its closed form
//! ρ D(k) = Σ c ω βV n⊗n (1 − cos k·ξ)/|ξ|.

use super::common;

use common::{DENSITY, DX, symbol};
use nalgebra::{SMatrix, SVector};
use pd_core::{InfluenceFunction, Quadrature, Symbol};
use pd_models::{Isotropic, Ordinary, PlaneMode, Pmb};
use proptest::prelude::*;

fn closed_form<const D: usize>(
    pmb: &Pmb,
    m: f64,
    influence: impl Fn(f64) -> f64,
    quadrature: Quadrature,
    k: &SVector<f64, D>,
) -> SMatrix<f64, D, D> {
    let reach = m.ceil() as i32 + 1;
    let span = 2 * reach + 1;
    let cell = SVector::<f64, D>::repeat(DX);
    let mut sum = SMatrix::zeros();
    for index in 0..span.pow(D as u32) {
        let xi = SVector::<f64, D>::from_fn(|d, _| {
            f64::from(index / span.pow(d as u32) % span - reach) * DX
        });
        let length = xi.norm();
        if length > 0.0 {
            let beta = quadrature.weight(&xi, &cell, m * DX);
            let n = xi / length;
            let c = pmb.micromodulus(m * DX) * influence(length / (m * DX));
            let volume = beta * DX.powi(D as i32);
            sum += n * n.transpose() * (c * volume * (1.0 - k.dot(&xi).cos()) / length);
        }
    }
    sum
}

const QUADRATURES: [Quadrature; 4] =
    [Quadrature::None, Quadrature::LinearRamp, Quadrature::ExtendedRamp, Quadrature::Exact];

fn quartic(r: f64) -> f64 {
    (1.0 - r * r).powi(2)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn in_plane(m in 1.0..4.5, q in 0..4_usize, x in -3.1..3.1, y in -3.1..3.1) {
        let moduli = Isotropic::from_young_poisson(210e9, 1.0 / 3.0).unwrap();
        let pmb = Pmb::plane(&moduli, PlaneMode::PlaneStress, DENSITY, quartic).unwrap();
        let found: Symbol<2> = symbol(&Ordinary::new(pmb.clone()), m, QUADRATURES[q]);
        let k = SVector::from([x, y]) / DX;
        let exact = closed_form(&pmb, m, quartic, QUADRATURES[q], &k);
        let error = (found.stiffness(&k) - exact).norm();
        prop_assert!(error < 1e-10 * exact.norm(), "{error} of {exact}");
        prop_assert!((found.matrix(&k) * DENSITY - found.stiffness(&k)).norm() < 1e-12 * exact.norm());
    }

    #[test]
    fn in_space(m in 1.0..3.2, q in 0..4_usize, k in prop::array::uniform3(-3.1..3.1)) {
        let moduli = Isotropic::from_young_poisson(210e9, 0.25).unwrap();
        let pmb = Pmb::solid(&moduli, DENSITY, quartic).unwrap();
        let found: Symbol<3> = symbol(&Ordinary::new(pmb.clone()), m, QUADRATURES[q]);
        let k = SVector::from(k) / DX;
        let exact = closed_form(&pmb, m, quartic, QUADRATURES[q], &k);
        let error = (found.stiffness(&k) - exact).norm();
        prop_assert!(error < 1e-10 * exact.norm(), "{error} of {exact}");
    }
}

/// On its own family the energy of a dilation is exact, but not that of every strain; the
/// trace of Γ over the axes is that of the classical continuum.
#[test]
fn matched_on_the_family_the_mean_long_wave_stiffness_is_exact() {
    let moduli = Isotropic::from_young_poisson(210e9, 0.25).unwrap();
    let pmb = Pmb::solid(&moduli, DENSITY, InfluenceFunction::Constant).unwrap().on_family();
    let symbol: Symbol<3> = symbol(&Ordinary::new(pmb), 3.0, Quadrature::None);
    let k = 1e-5 / DX;
    let trace: f64 =
        (0..3).map(|axis| symbol.stiffness(&(SVector::ith(axis, k))).trace() / (k * k)).sum();
    // Σ_axes tr Γ = C_iijj-type sum Σ_j C_ijij = 3(λ + 2μ) + 6μ with λ = μ.
    let exact = 15.0 * moduli.shear();
    assert!((trace / exact - 1.0).abs() < 1e-8, "{trace} {exact}");
}
