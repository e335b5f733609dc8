//! Errata of Willberg, Wiedemann & Rädel 2019 (`docs/errata.md`): the corrected forms hold, the
//! printed ones do not.

use super::averages;

use approx::assert_relative_eq;
use averages::{circle, sphere};
use nalgebra::{Matrix2, Matrix3};
use pd_core::influence::moment;
use pd_core::{Influence, InfluenceFunction};
use pd_models::{Isotropic, PlaneMode};
use std::f64::consts::PI;

fn steel() -> Isotropic {
    Isotropic::from_young_poisson(192e9, 0.33).unwrap()
}

/// (2-5)–(2-8): with eⁱ = θ|ξ|/3 the bonds' energy 9K/(2m) Σ ω eⁱ² + 15G/(2m) Σ ω eᵈ² is that of
/// the solid; with the printed 3K the isotropic part is a third of it.
#[test]
fn eq2_8_energy_of_a_solid() {
    let (bulk, shear) = (steel().bulk(), steel().shear());
    let strain = Matrix3::<f64>::new(1.0, 0.4, -0.3, 0.4, -0.5, 0.2, -0.3, 0.2, 0.7);
    let theta = strain.trace();
    let deviator = strain - Matrix3::identity() * (theta / 3.0);
    // Averages of (e/|ξ|)²; the weights ω|ξ|² cancel against m.
    let isotropic = sphere(|_| (theta / 3.0).powi(2));
    let shearing = sphere(|n| (deviator * n).dot(n).powi(2));
    let dilation = 0.5 * bulk * theta * theta;
    assert_relative_eq!(4.5 * bulk * isotropic, dilation, max_relative = 1e-12);
    assert_relative_eq!(1.5 * bulk * isotropic, dilation / 3.0, max_relative = 1e-12);
    let distortion = shear * deviator.norm_squared();
    assert_relative_eq!(7.5 * shear * shearing, distortion, max_relative = 1e-12);
}

/// The split in the plane, which the paper does not give: κ, 8G and θ|ξ|/2.
#[test]
fn energy_in_the_plane() {
    let (kappa, shear) = (steel().plane_bulk(PlaneMode::PlaneStress), steel().shear());
    let strain = Matrix2::<f64>::new(1.0, 0.4, 0.4, -0.3);
    let theta = strain.trace();
    let bonds = circle(|n| {
        let e = (strain * n).dot(n);
        0.5 * (kappa * theta * theta + 8.0 * shear * (e - 0.5 * theta).powi(2))
    });
    let deviator = strain - Matrix2::identity() * (0.5 * theta);
    let energy = 0.5 * kappa * theta * theta + shear * deviator.norm_squared();
    assert_relative_eq!(bonds, energy, max_relative = 1e-12);
}

/// Energy w(ξ) of all bonds that cross a plane, per area, for δ = 1 (and h = 1): from a depth z
/// below it a share (1 − z/ξ)/2 of the sphere of radius ξ lies above, arccos(z/ξ)/π of the circle.
fn crossing<const D: usize>(w: impl Fn(f64) -> f64) -> f64 {
    let n = 600;
    let middle = |i: usize| (i as f64 + 0.5) / f64::from(n);
    let mut sum = 0.0;
    for (xi, ratio) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let (xi, ratio) = (middle(xi as usize), middle(ratio as usize));
        let above = match D {
            3 => 2.0 * PI * xi * xi * (1.0 - ratio),
            _ => 2.0 * xi * ratio.acos(),
        };
        // z = ξ·ratio, so dz = ξ d(ratio).
        sum += w(xi) * above * xi;
    }
    sum / f64::from(n * n)
}

/// (3-1) and its counterpart for bonds that are not alike: π ∫ w ξ³ dξ = G₀ in space,
/// 2h ∫ w ξ² dξ = G₀ in the plane.
#[test]
fn eq3_1_energy_of_the_crossing_bonds() {
    for influence in [InfluenceFunction::Constant, InfluenceFunction::Linear] {
        let w = |xi: f64| influence.weight(xi);
        assert_relative_eq!(crossing::<3>(w), PI * moment(&influence, 3), max_relative = 1e-4);
        assert_relative_eq!(crossing::<2>(w), 2.0 * moment(&influence, 2), max_relative = 1e-4);
    }
    assert_relative_eq!(crossing::<3>(|_| 4.0 / PI), 1.0, max_relative = 1e-4);
    assert_relative_eq!(crossing::<2>(|_| 1.5), 1.0, max_relative = 1e-4);
}

/// (3-7)–(3-9): with ½ a bond-based solid that breaks at s_c = √(5G₀/(9Kδ)) costs G₀; the printed
/// ¼ counts half of that.
#[test]
fn eq3_7_factor_one_half() {
    // K = G₀ = δ = 1: t + t' = c s with c = 18K/(πδ⁴), e = s ξ.
    let s = (5.0_f64 / 9.0).sqrt();
    let pair = |factor: f64| move |xi: f64| factor * (18.0 / PI * s) * (s * xi);
    assert_relative_eq!(crossing::<3>(pair(0.5)), 1.0, max_relative = 1e-4);
    assert_relative_eq!(crossing::<3>(pair(0.25)), 0.5, max_relative = 1e-4);
}

/// Table 5: G_IC is twice what (5-4) gives for E in GPa, s_C and δ = 1.5075 mm.
#[test]
fn table_5() {
    let (bulk, shear, horizon) = (steel().bulk(), steel().shear(), 1.5075e-3);
    let stiffness = 3.0 * shear + 0.75_f64.powi(4) * (bulk - 5.0 * shear / 3.0);
    let released = 0.02_f64.powi(2) * stiffness * horizon;
    assert_relative_eq!(released, 143_535.9, max_relative = 1e-5);
    assert_relative_eq!(287_072.0 / released, 2.0, max_relative = 1e-5);
}

/// Table 1, power law: one mode alone breaks at its own critical value when the shares are summed,
/// and later as printed.
#[test]
fn table_1_power_law() {
    let critical = [3.0_f64, 2.0, 5.0];
    let square = |w: [f64; 3]| w.iter().map(|x| x * x).sum::<f64>();
    for mode in 0..3 {
        let alone = std::array::from_fn(|i| if i == mode { 1.001 * critical[i] } else { 0.0 });
        assert!(square(std::array::from_fn(|i| alone[i] / critical[i])) > 1.0);
        assert!(square(alone) / square(critical) < 1.0);
    }
}
