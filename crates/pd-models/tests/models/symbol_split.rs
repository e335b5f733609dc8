//! The positive split: stable, exact for long waves, and less stiff than the micromoduli.

use super::common;

use common::{DENSITY, DX, KERNELS, plies, polynomial, split, symbol};
use nalgebra::{Rotation3, Vector2, Vector3};
use pd_core::symbol::Stability;
use pd_core::{Horizon, InfluenceFunction, Quadrature, Symbol};
use pd_models::elasticity::catalogue::{GRAPHITE_FABRIC_CARBON_SOLID, pps_carbon};
use pd_models::{Ordinary, PositiveSplit, Stiffness};
use std::f64::consts::PI;

#[test]
fn the_softest_wave_is_the_longest_one() {
    for (name, degrees, c) in plies() {
        for (m, influence) in KERNELS {
            let extremes = split(&c, m, influence).extremes(40);
            let Stability::Stable(softest) = extremes.stability() else {
                panic!("{name} {degrees}°: {}", extremes.stability())
            };
            let phase = softest.wave.norm() * DX;
            assert!((phase - PI / 20.0).abs() < 1e-3, "{name} {degrees}° m = {m}: phase {phase}");
            // Its eigenvalue is the elastic one, ρc²k².
            let slowest = c.waves(&softest.wave, DENSITY).unwrap().last().unwrap().speed;
            let elastic = (slowest * softest.wave.norm()).powi(2);
            let ratio = softest.eigenvalue / elastic;
            assert!((0.93..1.0).contains(&ratio), "{name} {degrees}° m = {m}: {ratio}");
        }
    }
}

#[test]
fn the_largest_eigenvalue_is_two_to_four_times_smaller() {
    for (name, degrees, c) in plies() {
        for (m, influence) in KERNELS {
            let stiffest = |s: Symbol<2>| s.extremes(40).stiffest.eigenvalue;
            let ratio = stiffest(polynomial(&c, m, influence)) / stiffest(split(&c, m, influence));
            assert!(
                (1.7..4.5).contains(&ratio),
                "{name} {degrees}° m = {m} {influence:?}: {ratio}"
            );
        }
    }
}

/// ω/k − c of a wave whose phase per cell is `phase`, relative to c; slowest first.
fn speed_errors<const D: usize>(
    symbol: &Symbol<D>,
    c: &Stiffness<D>,
    n: &nalgebra::SVector<f64, D>,
    phase: f64,
) -> Vec<f64> {
    let found = symbol.phase_speeds(n, phase / DX).unwrap();
    let exact = c.waves(n, DENSITY).unwrap();
    found.iter().zip(exact.iter().rev()).map(|(f, e)| f / e.speed - 1.0).collect()
}

#[test]
fn long_waves_travel_at_the_speeds_of_the_continuum() {
    let directions = (0..12).map(|i| 0.3 * f64::from(i)).map(|a| Vector2::new(a.cos(), a.sin()));
    for n in directions {
        for (_, _, c) in plies() {
            for m in [1.5, 2.0, 3.0, 4.3] {
                for quadrature in [Quadrature::None, Quadrature::LinearRamp, Quadrature::Exact] {
                    let influence = InfluenceFunction::Gaussian;
                    let model = PositiveSplit::plane(&c, DENSITY, influence).unwrap();
                    let symbol = symbol(&Ordinary::new(model), m, quadrature);
                    for error in speed_errors(&symbol, &c, &n, 1e-5) {
                        assert!(error.abs() < 1e-8, "m = {m} {quadrature:?}: {error}");
                    }
                    // The error is of second order in k: it is dispersion, not a wrong modulus.
                    let at = |phase| speed_errors(&symbol, &c, &n, phase);
                    for (coarse, fine) in at(0.02).iter().zip(at(0.01)) {
                        assert!((coarse / fine - 4.0).abs() < 0.05, "m = {m}: {coarse} {fine}");
                    }
                }
            }
        }
    }
}

#[test]
fn long_waves_in_space() {
    let turn = Rotation3::from_euler_angles(0.3, -0.7, 1.1);
    let fabric = Stiffness::<3>::orthotropic(&GRAPHITE_FABRIC_CARBON_SOLID).unwrap();
    for c in [fabric, fabric.rotated(&turn), pps_carbon().unwrap().rotated(&turn)] {
        for m in [2.0, 3.0] {
            let influence = InfluenceFunction::Linear;
            let model = PositiveSplit::solid(&c, DENSITY, influence).unwrap();
            let symbol = symbol(&Ordinary::new(model), m, Quadrature::Exact);
            for n in [Vector3::x(), Vector3::z(), Vector3::new(1.0, -2.0, 0.5)] {
                for error in speed_errors(&symbol, &c, &n, 1e-5) {
                    assert!(error.abs() < 1e-8, "m = {m}: {error}");
                }
            }
            let stability = symbol.stability();
            assert!(matches!(stability, Stability::Stable(_)), "m = {m}: {stability}");
        }
    }
}

/// Cells need not be square; the unit of length is the first edge.
#[test]
fn long_waves_on_a_rectangular_lattice() {
    let (_, _, c) = plies()[1];
    let model = PositiveSplit::plane(&c, DENSITY, InfluenceFunction::Constant).unwrap();
    let horizon = Horizon::Metres(3.0 * DX);
    let symbol =
        Symbol::with_spacing(&Ordinary::new(model), [DX, 0.6 * DX], horizon, Quadrature::Exact)
            .unwrap();
    let n = Vector2::new(0.3, -1.0);
    for error in speed_errors(&symbol, &c, &n, 1e-5) {
        assert!(error.abs() < 1e-8, "{error}");
    }
    let zone = symbol.dispersion(&Vector2::y(), 8).unwrap();
    assert!((zone[7].0 * 0.6 * DX - PI).abs() < 1e-12);
}
