//! Scabbia's micromoduli amplify plane waves in strongly anisotropic materials: the figures found
//! by an independent code (errata 004-20).

use super::common;

use common::{DENSITY, KERNELS, on_grid, plies, polynomial, symbol};
use pd_core::symbol::Stability;
use pd_core::{Error, InfluenceFunction, Quadrature, Symbol};
use pd_models::elasticity::catalogue::{
    GLASS_EPOXY, GRAPHITE_EPOXY, GRAPHITE_FABRIC_CARBON, GRAPHITE_FABRIC_CARBON_SOLID, HTA_6376,
    hattori_inclusion, hattori_plate, pps_carbon, steel,
};
use pd_models::{Lamina, Ordinary, PlaneMode, PolynomialMicromoduli, Stiffness};

/// Smallest eigenvalues in GPa/Δx² on a grid of 41 points per axis, β = 1, by material and kernel.
#[test]
fn the_printed_table_is_reproduced() {
    let printed = [
        [-24.9, -42.6, -4.4],
        [-2.8, -7.9, 0.39],
        [-19.5, -31.9, -3.8],
        [-17.9, -29.1, -3.5],
        [-7.9, -14.9, -1.2],
        [0.05, 0.07, 0.08],
        [0.10, 0.14, 0.16],
    ];
    for ((name, degrees, c), row) in plies().iter().zip(printed) {
        for ((m, influence), figure) in KERNELS.iter().zip(row) {
            let (smallest, ..) = on_grid(&polynomial(c, *m, *influence), 40);
            let digit: f64 = if figure > 0.0 { 0.01 } else { 0.1 };
            let smallest = smallest / 1e9;
            assert!(
                (smallest - figure).abs() < 0.54 * digit,
                "{name} {degrees}° m = {m} {influence:?}: {smallest} against {figure}"
            );
        }
    }
}

fn plane(c: &Stiffness<2>, m: f64) -> Symbol<2> {
    let model = PolynomialMicromoduli::plane(c, DENSITY, InfluenceFunction::Gaussian).unwrap();
    symbol(&Ordinary::linearised(model), m, Quadrature::Exact)
}

fn solid(c: &Stiffness<3>, m: f64) -> Symbol<3> {
    let model = PolynomialMicromoduli::solid(c, DENSITY, InfluenceFunction::Gaussian).unwrap();
    symbol(&Ordinary::linearised(model), m, Quadrature::Exact)
}

/// Smallest over largest eigenvalue and the unstable share of the zone, exact β, from
/// `stability_osb_aniso.json`.
#[test]
fn the_independent_code_agrees_to_rounding() {
    let ply = |ply: &Lamina, degrees: f64| {
        Stiffness::<2>::lamina(ply).unwrap().rotated(degrees.to_radians())
    };
    let in_plane = [
        Stiffness::<2>::isotropic(&steel().unwrap(), PlaneMode::PlaneStress).unwrap(),
        ply(&GRAPHITE_FABRIC_CARBON, 0.0),
        ply(&GRAPHITE_FABRIC_CARBON, 20.0),
        ply(&GLASS_EPOXY, 0.0),
        ply(&GLASS_EPOXY, 40.0),
        ply(&GLASS_EPOXY, -25.0),
        ply(&GRAPHITE_EPOXY, 0.0),
        ply(&GRAPHITE_EPOXY, 30.0),
        ply(&HTA_6376, 0.0),
        hattori_plate().unwrap(),
        hattori_inclusion().unwrap(),
    ];
    let in_space = [
        Stiffness::<3>::isotropic(&steel().unwrap()).unwrap(),
        Stiffness::<3>::orthotropic(&GRAPHITE_FABRIC_CARBON_SOLID).unwrap(),
        pps_carbon().unwrap(),
        pps_carbon().unwrap().rotated_about_z(30_f64.to_radians()),
    ];
    let text = include_str!("../../../../tests/data/pd/stability_osb_aniso.json");
    let data: serde_json::Value = serde_json::from_str(text).unwrap();
    let cases = data["cases"].as_array().unwrap();
    assert_eq!(cases.len(), in_plane.len() + in_space.len());
    for (index, case) in cases.iter().enumerate() {
        for lattice in case["lattice"].as_array().unwrap() {
            let number = |key: &str| lattice[key].as_f64().unwrap();
            let m = number("mbar");
            let (smallest, largest, negative) = match in_plane.get(index) {
                Some(c) => on_grid(&plane(c, m), 120),
                None => on_grid(&solid(&in_space[index - in_plane.len()], m), 24),
            };
            let (ratio, expected) = (smallest / largest, number("min_over_max"));
            let name = &case["material"];
            assert!((ratio - expected).abs() < 1e-12, "{name} m = {m}: {ratio} not {expected}");
            let expected = number("fraction_of_zone_unstable");
            assert!((negative - expected).abs() < 1e-9, "{name} m = {m}: {negative} of the zone");
        }
    }
}

#[test]
fn an_unstable_material_is_refused_with_its_wave() {
    let c = Stiffness::<2>::lamina(&GRAPHITE_FABRIC_CARBON).unwrap();
    let symbol = polynomial(&c, 5.0, InfluenceFunction::Gaussian);
    let stability = symbol.stability();
    let Stability::Unstable(mode) = stability else { panic!("{stability}") };
    // The search goes below the best of the samples, and the mode is one of the symbol.
    let (sampled, ..) = on_grid(&symbol, 120);
    assert!(mode.eigenvalue < sampled / (DENSITY * common::DX * common::DX));
    let residual =
        symbol.matrix(&mode.wave) * mode.polarisation - mode.polarisation * mode.eigenvalue;
    assert!(residual.norm() < 1e-12 * symbol.max_frequency().powi(2));
    assert!((mode.growth_rate().powi(2) + mode.eigenvalue).abs() < 1e-12 * mode.eigenvalue.abs());
    let text = stability.to_string();
    assert!(text.contains("amplifies the plane wave k = ["), "{text}");
    assert!(text.contains(&format!("growth rate {:e} 1/s", mode.growth_rate())), "{text}");
    match symbol.require_stable() {
        Err(Error::UnstableMaterial { eigenvalue, wave, growth_rate }) => {
            assert_eq!(eigenvalue, mode.eigenvalue);
            assert_eq!(wave, mode.wave.as_slice());
            assert_eq!(growth_rate, mode.growth_rate());
        }
        other => panic!("{other:?}"),
    }
    let glass = Stiffness::<2>::lamina(&GLASS_EPOXY).unwrap();
    polynomial(&glass, 3.0, InfluenceFunction::Gaussian).require_stable().unwrap();
}
