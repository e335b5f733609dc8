//! Stroh formalism: openings of an independent code (`data/crack_opening.csv`), the Barnett–Lothe
//! integral, the isotropic limit, A and B, and rotation into crack axes.

use super::common::random;

use nalgebra::{Complex, Matrix2, Rotation2, Vector2};
use pd_models::elasticity::catalogue::*;
use pd_models::{Intensity, Isotropic, PlaneMode, Stiffness, Stroh};
use proptest::prelude::*;
use std::f64::consts::PI;

fn stroh(stiffness: &Stiffness<2>) -> Stroh {
    Stroh::new(stiffness, 0.0).unwrap()
}

/// L = −(1/π)∫₀^π (R(θ) T⁻¹(θ) Rᵀ(θ) − Q(θ)) dθ: no roots, no degeneracy. The integrand is periodic
/// and smooth, so equidistant points converge exponentially.
fn barnett_lothe(c: &Stiffness<2>) -> Matrix2<f64> {
    let points = 4000;
    let sum = (0..points).map(|k| {
        let theta = PI * f64::from(k) / f64::from(points);
        let (m, n) = ([theta.cos(), theta.sin()], [-theta.sin(), theta.cos()]);
        let contract = |a: [f64; 2], b: [f64; 2]| {
            Matrix2::from_fn(|i, k| {
                let sum = |j: usize| (0..2).map(|l| c.c(i, j, k, l) * a[j] * b[l]).sum::<f64>();
                sum(0) + sum(1)
            })
        };
        let (q, r, t) = (contract(m, m), contract(m, n), contract(n, n));
        r * t.try_inverse().unwrap() * r.transpose() - q
    });
    -sum.sum::<Matrix2<f64>>() / f64::from(points)
}

#[test]
fn openings_of_the_reference_table() {
    let mut rows = 0;
    for line in include_str!("../data/crack_opening.csv").lines().skip(2) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |i: usize| cells[i].parse::<f64>().unwrap();
        let (name, angle) = cells[0].split_once(" theta=").unwrap_or((cells[0], "0"));
        let c = match name.split_whitespace().next().unwrap() {
            "isotropic" => {
                let moduli = Isotropic::from_young_poisson(200e9, 0.3).unwrap();
                Stiffness::<2>::isotropic(&moduli, PlaneMode::PlaneStress).unwrap()
            }
            "Zhao" => {
                Stiffness::<2>::isotropic(&steel_q345().unwrap(), PlaneMode::PlaneStress).unwrap()
            }
            "glass-epoxy" => Stiffness::<2>::lamina(&GLASS_EPOXY).unwrap(),
            "graphite-epoxy" => Stiffness::<2>::lamina(&GRAPHITE_EPOXY).unwrap(),
            "HTA/6376" => Stiffness::<2>::lamina(&HTA_6376).unwrap(),
            _ => hattori_plate().unwrap(),
        };
        let c = c.rotated(angle.parse::<f64>().unwrap().to_radians());
        let got = stroh(&c).opening_compliance().column(1) * 2.0;
        let given = Vector2::new(number(1), number(2));
        assert!((got - given).norm() < 2e-6 * given.norm(), "{line}: {got}");
        rows += 1;
    }
    assert_eq!(rows, 15);
}

#[test]
fn isotropic_limit() {
    for (mode, nu, e_prime) in [
        (PlaneMode::PlaneStress, 0.3, 200e9),
        (PlaneMode::PlaneStrain, 0.3, 200e9 / (1.0 - 0.09)),
        (PlaneMode::PlaneStrain, 0.499, 200e9 / (1.0 - 0.499 * 0.499)),
    ] {
        let moduli = Isotropic::from_young_poisson(200e9, nu).unwrap();
        let own = Stroh::new(&Stiffness::<2>::isotropic(&moduli, mode).unwrap(), 0.7).unwrap();
        let error = own.opening_compliance() * (0.5 * e_prime) - Matrix2::identity();
        assert!(error.amax() < 1e-12, "{mode:?}, ν = {nu}: {error}");
        // K_I = (E'/8) √(2π/r) Δu₂, G = K²/E'; the crack points along 0.7 rad.
        let (r, open) = (1e-3_f64, 1e-6);
        let normal = Vector2::new(-0.7_f64.sin(), 0.7_f64.cos());
        let k = own.intensity(r, &(normal * open));
        let exact = e_prime / 8.0 * (2.0 * PI / r).sqrt() * open;
        assert!((k.i / exact - 1.0).abs() < 1e-12 && k.ii.abs() < 1e-9 * exact, "{k:?}");
        assert!((own.energy_release_rate(k) * e_prime / (exact * exact) - 1.0).abs() < 1e-12);
    }
}

proptest! {
    // Shrinking repeats the integral: a few steps are enough to see what fails.
    #![proptest_config(ProptestConfig { cases: 48, max_shrink_iters: 20, ..Default::default() })]

    #[test]
    fn barnett_lothe_integral(c in random::stiffness2()) {
        let own = stroh(&c);
        let product = barnett_lothe(&c) * own.opening_compliance();
        prop_assert!((product - Matrix2::identity()).amax() < 1e-8, "{product}");
    }

    /// L⁻¹ = Re(i A B⁻¹) with A and B as the eigenvectors: {Q + p(R + Rᵀ) + p²T} a = 0,
    /// b = (Rᵀ + p T) a.
    #[test]
    fn a_and_b(c in random::stiffness2()) {
        let own = stroh(&c);
        let [p, q] = own.roots();
        prop_assume!((p - q).norm() > 1e-2);
        let block = |j: usize, l: usize| Matrix2::from_fn(|i, k| Complex::from(c.c(i, j, k, l)));
        let (a, b) = (own.a(), own.b());
        for (k, p) in own.roots().into_iter().enumerate() {
            prop_assert!(p.im > 0.0);
            let bracket = block(0, 0) + (block(0, 1) + block(1, 0)) * p + block(1, 1) * (p * p);
            let size = bracket.map(|x| x.norm()).amax() * a.column(k).map(|x| x.norm()).amax();
            prop_assert!((bracket * a.column(k)).map(|x| x.norm()).amax() < 1e-8 * size);
            let traction = (block(1, 0) + block(1, 1) * p) * a.column(k) - b.column(k);
            prop_assert!(traction.map(|x| x.norm()).amax() < 1e-8 * (1.0 + p.norm()));
        }
        let direct = a * b.try_inverse().unwrap() * Complex::i();
        let difference = direct.map(|x| x.re) - own.opening_compliance();
        prop_assert!(difference.amax() < 1e-9 * own.opening_compliance().amax());
    }

    /// Turning material, crack and opening together changes nothing; opening and intensity are
    /// inverse; ends of a crack see the mirrored sliding.
    #[test]
    fn rotation_into_crack_axes(c in random::stiffness2(), angle in -7.0..7.0_f64) {
        let (flat, turned) = (stroh(&c), Stroh::new(&c.rotated(angle), angle).unwrap());
        let k = Intensity { i: 3e6, ii: -1.2e6 };
        let du = flat.opening(2e-3, k);
        let again = turned.intensity(2e-3, &(Rotation2::new(angle) * du));
        prop_assert!((again.i / k.i - 1.0).abs() < 1e-9 && (again.ii / k.ii - 1.0).abs() < 1e-9);
        let left = Stroh::new(&c, PI).unwrap();
        // Upper minus lower face changes sign with the axes.
        let mirrored = left.intensity(2e-3, &(-du));
        prop_assert!((mirrored.i / k.i - 1.0).abs() < 1e-9 && (mirrored.ii / k.ii - 1.0).abs() < 1e-9);
    }
}
