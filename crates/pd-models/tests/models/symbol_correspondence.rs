//! Zero-energy modes of correspondence materials, and what controlling them costs.

use super::common;

use common::{DENSITY, DX, KERNELS, plies, symbol};
use nalgebra::{Rotation3, Vector2, Vector3};
use pd_core::symbol::Stability;
use pd_core::{InfluenceFunction, Material, Quadrature, Symbol};
use pd_models::elasticity::catalogue::pps_carbon;
use pd_models::{Correspondence, Isotropic, LinearElastic, NeoHookean, Stiffness, WanControl};
use pd_models::{PlaneMode, SaintVenantKirchhoff};
use std::f64::consts::PI;

fn plain<const D: usize>(
    c: &Stiffness<D>,
    influence: InfluenceFunction,
) -> Correspondence<LinearElastic<D>> {
    Correspondence::new(LinearElastic(*c), DENSITY, influence).unwrap()
}

#[test]
fn without_control_zone_corner_waves_cost_nothing() {
    for (name, degrees, c) in plies() {
        for (m, influence) in [(2.0, InfluenceFunction::Linear), KERNELS[0], KERNELS[1]] {
            let symbol: Symbol<2> = symbol(&plain(&c, influence), m, Quadrature::None);
            let extremes = symbol.extremes(24);
            let largest = extremes.stiffest.eigenvalue;
            for corner in [(PI, PI), (PI, 0.0), (0.0, PI)] {
                let wave = Vector2::new(corner.0, corner.1) / DX;
                for mode in symbol.eigen(&wave) {
                    let relative = mode.eigenvalue.abs() / largest;
                    assert!(relative < 1e-12, "{name} {degrees}° m = {m} {corner:?}: {relative}");
                }
            }
            let stability = extremes.stability();
            assert!(matches!(stability, Stability::ZeroEnergy(_)), "{stability}");
            assert!(stability.to_string().starts_with("zero-energy mode: the wave k = ["));
            symbol.require_stable().unwrap();
        }
    }
}

#[test]
fn without_control_in_space() {
    let turn = Rotation3::from_euler_angles(0.3, -0.7, 1.1);
    let material = plain(&pps_carbon().unwrap().rotated(&turn), InfluenceFunction::Linear);
    let symbol: Symbol<3> = symbol(&material, 2.0, Quadrature::Exact);
    let largest = symbol.max_frequency().powi(2);
    for corner in [[PI, PI, PI], [PI, PI, 0.0], [0.0, 0.0, PI]] {
        for mode in symbol.eigen(&(Vector3::from(corner) / DX)) {
            assert!(mode.eigenvalue.abs() < 1e-12 * largest, "{corner:?}: {mode:?}");
        }
    }
}

#[test]
fn wan_control_lifts_the_softest_wave_and_costs_half_the_time_step() {
    for (name, degrees, c) in plies() {
        for (m, influence) in KERNELS {
            let bare: Symbol<2> = symbol(&plain(&c, influence), m, Quadrature::None);
            let control = WanControl::new(&c, 1.0).unwrap();
            let controlled = plain(&c, influence).with_control(control);
            let controlled: Symbol<2> = symbol(&controlled, m, Quadrature::None);
            let (bare, controlled) = (bare.extremes(40), controlled.extremes(40));
            let Stability::Stable(softest) = controlled.stability() else {
                panic!("{name} {degrees}°: {}", controlled.stability())
            };
            // Stiffer than the continuum (by k²δ²), where the bare material is softer.
            let phase = softest.wave.norm() * DX;
            assert!((phase - PI / 20.0).abs() < 1e-3, "{name} {degrees}° m = {m}: phase {phase}");
            let slowest = c.waves(&softest.wave, DENSITY).unwrap().last().unwrap().speed;
            let lifted = softest.eigenvalue / (slowest * softest.wave.norm()).powi(2);
            assert!((1.0..1.25).contains(&lifted), "{name} {degrees}° m = {m}: {lifted}");
            let raised = controlled.stiffest.eigenvalue / bare.stiffest.eigenvalue;
            assert!((4.5..5.2).contains(&raised), "{name} {degrees}° m = {m}: {raised}");
        }
    }
}

/// Finite-strain laws have the symbol of their small-strain stiffness: the probe is small.
#[test]
fn finite_strain_laws_linearise_to_their_stiffness() {
    fn stiffness<M: Material<f64, 2>>(material: &M, k: &Vector2<f64>) -> nalgebra::Matrix2<f64> {
        symbol::<2, M>(material, 3.0, Quadrature::Exact).stiffness(k)
    }
    let moduli = Isotropic::from_young_poisson(72e9, 0.22).unwrap();
    let c = Stiffness::<2>::isotropic(&moduli, PlaneMode::PlaneStrain).unwrap();
    let influence = InfluenceFunction::Gaussian;
    let k = Vector2::new(0.7, -0.4) / DX;
    let small = stiffness(&plain(&c, influence), &k);
    let svk = Correspondence::new(SaintVenantKirchhoff(c), DENSITY, influence).unwrap();
    let neo = Correspondence::new(NeoHookean::new(&moduli), DENSITY, influence).unwrap();
    for finite in [stiffness(&svk, &k), stiffness(&neo, &k)] {
        let error = (finite - small).norm() / small.norm();
        assert!(error < 1e-8, "{error}");
    }
}
