//! Christoffel waves against an independent code (`data/wave_speeds.csv`: in-plane speeds and
//! polarisations in 15° steps from the fibre, five digits), closed forms and brute force.

use super::common::random;

use approx::assert_relative_eq;
use nalgebra::{SVector, Vector2, Vector3};
use pd_models::elasticity::catalogue::*;
use pd_models::{PlaneMode, Stiffness};
use proptest::prelude::*;
use std::f64::consts::PI;

const TABLE: &str = include_str!("../data/wave_speeds.csv");

/// Stiffness and density of a material of the table.
fn material(name: &str) -> (Stiffness<2>, f64) {
    let ply = |ply| Stiffness::<2>::lamina(&ply).unwrap();
    let plate = |moduli: pd_models::Result<pd_models::Isotropic>| {
        Stiffness::<2>::isotropic(&moduli.unwrap(), PlaneMode::PlaneStress).unwrap()
    };
    match name.split_whitespace().next().unwrap() {
        "graphite-epoxy" => (ply(GRAPHITE_EPOXY), GRAPHITE_EPOXY_DENSITY),
        "HTA/6376" => (ply(HTA_6376), HTA_6376_DENSITY),
        "Hattori" if name.contains("Eq39") => (hattori_plate().unwrap(), HATTORI_PLATE_DENSITY),
        "Hattori" => (hattori_inclusion().unwrap(), HATTORI_INCLUSION_DENSITY),
        "glass-epoxy" => (ply(GLASS_EPOXY), 1.0),
        "graphite-carbon" => (ply(GRAPHITE_FABRIC_CARBON), 1.0),
        "steel" => (plate(steel_q345()), STEEL_Q345_DENSITY),
        "Willberg" => (plate(willberg_plate()), WILLBERG_PLATE_DENSITY),
        _ => panic!("{name}"),
    }
}

/// All 8 materials and 13 directions to the five digits given, polarisations too, and as well
/// with fibre and wave turned together.
#[test]
fn the_reference_table() {
    let mut rows = 0;
    for line in TABLE.lines().skip(1) {
        let (name, numbers) = line.split_once(',').unwrap();
        let numbers: Vec<f64> = numbers.split(',').map(|x| x.parse().unwrap()).collect();
        let (own, density) = material(name);
        for fibre in [0.0_f64, 37.0] {
            let c = own.rotated(fibre.to_radians());
            let (sin, cos) = (numbers[0] + fibre).to_radians().sin_cos();
            let waves = c.waves(&Vector2::new(cos, sin), density).unwrap();
            for (wave, expected) in waves.iter().zip(numbers[1..].chunks(2)) {
                // Five digits, the last one rounded.
                let unit = 10_f64.powf(expected[0].log10().floor() - 4.0);
                assert!((wave.speed - expected[0]).abs() <= 0.501 * unit, "{line}: {wave:?}");
                let p = wave.polarisation;
                let angle = (p.y.atan2(p.x).to_degrees() - fibre).rem_euclid(180.0);
                let error = (angle - expected[1] + 90.0).rem_euclid(180.0) - 90.0;
                assert!(error.abs() <= 5.1e-5, "{line}: {angle}");
            }
        }
        rows += 1;
    }
    assert_eq!(rows, 104);
}

/// √(E1/(1−ν12ν21)/ρ) along the fibre, √(G12/ρ) for shear.
#[test]
fn closed_forms_along_the_axes() {
    let c = Stiffness::<2>::lamina(&HTA_6376).unwrap();
    let [p, s] = c.waves(&Vector2::x(), HTA_6376_DENSITY).unwrap();
    let d = 1.0 - 0.3 * 0.3 * 8.75 / 136.0;
    assert_relative_eq!(p.speed, (136e9 / d / 1586.0_f64).sqrt(), max_relative = 1e-14);
    assert_relative_eq!(s.speed, (5.5e9 / 1586.0_f64).sqrt(), max_relative = 1e-14);
    assert_relative_eq!(p.polarisation.x.abs(), 1.0, max_relative = 1e-14);

    let steel = steel().unwrap();
    let c = Stiffness::<3>::isotropic(&steel).unwrap();
    let waves = c.waves(&Vector3::new(1.0, -2.0, 3.0), 7850.0).unwrap();
    let p = ((steel.bulk() + 4.0 / 3.0 * steel.shear()) / 7850.0).sqrt();
    let s = (steel.shear() / 7850.0).sqrt();
    for (wave, expected) in waves.iter().zip([p, s, s]) {
        assert_relative_eq!(wave.speed, expected, max_relative = 1e-14);
    }
    assert_relative_eq!(c.max_wave_speed(7850.0).unwrap(), p, max_relative = 1e-14);
}

/// Errata 000-15: the fastest wave of Hattori's plates is along the fibre, whatever θ; for the
/// inclusion the faster wave across the fibre is the shear wave.
#[test]
fn fastest_wave_of_the_papers() {
    for (c, density, fastest) in [
        (Stiffness::<2>::lamina(&GRAPHITE_EPOXY).unwrap(), GRAPHITE_EPOXY_DENSITY, 7322.8),
        (Stiffness::<2>::lamina(&HTA_6376).unwrap(), HTA_6376_DENSITY, 9287.1),
        (hattori_plate().unwrap(), HATTORI_PLATE_DENSITY, 9856.2),
        (hattori_inclusion().unwrap(), HATTORI_INCLUSION_DENSITY, 6437.9),
    ] {
        let exact = (c.c(0, 0, 0, 0) / density).sqrt();
        assert_relative_eq!(exact, fastest, max_relative = 1e-5);
        for degrees in [0.0_f64, 13.0, 30.0, 45.0, 90.0] {
            let found = c.rotated(degrees.to_radians()).max_wave_speed(density).unwrap();
            assert_relative_eq!(found, exact, max_relative = 1e-13);
        }
    }
}

/// A needle: E1/E2 = 1e6, the fibre anywhere.
#[test]
fn fastest_wave_of_extreme_anisotropy() {
    let ply = pd_models::Lamina { e1: 1e12, e2: 1e6, g12: 1e6, nu12: 0.3 };
    let c = Stiffness::<2>::lamina(&ply).unwrap();
    for degrees in [0.0_f64, 11.3, 44.9, 89.0] {
        let found = c.rotated(degrees.to_radians()).max_wave_speed(1.0).unwrap();
        assert_relative_eq!(found, 1e6, max_relative = 1e-6);
    }
}

/// Near-evenly spread directions of the half plane or half sphere.
fn directions<const D: usize>(n: usize) -> impl Iterator<Item = SVector<f64, D>> {
    (0..n).map(move |i| {
        let z = if D == 3 { (i as f64 + 0.5) / n as f64 } else { 0.0 };
        let golden = PI * (3.0 - 5.0_f64.sqrt());
        let angle = if D == 3 { golden * i as f64 } else { PI * i as f64 / n as f64 };
        let r = (1.0 - z * z).sqrt();
        SVector::from_fn(|d, _| [r * angle.cos(), r * angle.sin(), z][d])
    })
}

fn brute_force<const D: usize>(c: &Stiffness<D>, n: usize) -> f64 {
    directions(n).map(|n| c.waves(&n, 2e3).unwrap()[0].speed).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// No scanned direction beats the search, and the search is not above what the scan can reach.
    #[test]
    fn fastest_wave_against_a_scan(c2 in random::stiffness2(), c3 in random::stiffness3()) {
        let (found, scanned) = (c2.max_wave_speed(2e3).unwrap(), brute_force(&c2, 720));
        prop_assert!(found >= scanned * (1.0 - 1e-12) && found <= scanned * 1.0001, "{found} {scanned}");
        let (found, scanned) = (c3.max_wave_speed(2e3).unwrap(), brute_force(&c3, 4000));
        prop_assert!(found >= scanned * (1.0 - 1e-12) && found <= scanned * 1.01, "{found} {scanned}");
    }

    /// Each wave solves ρc² p = Γ p: an energy identity that does not form Γ. Sorted, orthonormal.
    #[test]
    fn waves_solve_the_christoffel_equation(
        c in random::stiffness3(), n in proptest::array::uniform3(-1.0..1.0_f64),
    ) {
        let n = Vector3::from(n);
        prop_assume!(n.norm() > 1e-3);
        let waves = c.waves(&n, 2e3).unwrap();
        let n = n.normalize();
        for (a, wave) in waves.iter().enumerate() {
            let p = wave.polarisation;
            let traction = c.contract(&((p * n.transpose() + n * p.transpose()) * 0.5)) * n;
            prop_assert!((traction - p * (2e3 * wave.speed.powi(2))).amax() < 1e-3);
            for (b, other) in waves.iter().enumerate() {
                let expected = f64::from(u8::from(a == b));
                prop_assert!((p.dot(&other.polarisation) - expected).abs() < 1e-12);
            }
        }
        prop_assert!(waves[0].speed >= waves[1].speed && waves[1].speed >= waves[2].speed);
    }
}

#[test]
fn inadmissible_input_is_named() {
    let c = hattori_plate().unwrap();
    for density in [0.0, -1.0, f64::NAN] {
        for text in [
            c.waves(&Vector2::x(), density).unwrap_err().to_string(),
            c.max_wave_speed(density).unwrap_err().to_string(),
        ] {
            assert!(text.contains("density ρ [kg/m³] is"), "{text}");
        }
    }
    for direction in [Vector2::zeros(), Vector2::new(f64::NAN, 1.0)] {
        let text = c.waves(&direction, 1e3).unwrap_err().to_string();
        assert!(text.contains("length of the wave's direction"), "{text}");
    }
}
