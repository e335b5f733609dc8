//! The bulk critical time step: what the symbol gives, what a body does with it.

use super::common;

use common::{DENSITY, DX, symbol};
use nalgebra::{Vector2, Vector3};
use pd_core::body::Dynamics;
use pd_core::time_step::classical::courant;
use pd_core::{
    Body, Grid, Horizon, InfluenceFunction, Lattice, Material, NoDamage, Quadrature, Symbol,
};
use pd_models::elasticity::catalogue::steel;
use pd_models::{
    Correspondence, Isotropic, LinearElastic, LinearSolid, Ordinary, PlaneMode, Pmb, Stiffness,
};

#[test]
fn delta_over_c_is_unsafe_for_bond_based_and_linear_solids() {
    let third = Isotropic::from_young_poisson(206.84e9, 1.0 / 3.0).unwrap();
    let own = Isotropic::from_young_poisson(206.84e9, 0.29).unwrap();
    let one = InfluenceFunction::Constant;
    let mode = PlaneMode::PlaneStress;
    for m in [2.0, 3.0, 3.015, 4.0] {
        let pmb = Ordinary::new(Pmb::plane(&third, mode, DENSITY, one).unwrap());
        let lps = Ordinary::new(LinearSolid::plane(&own, mode, DENSITY, one).unwrap());
        let c = |moduli| {
            Stiffness::<2>::isotropic(moduli, mode).unwrap().max_wave_speed(DENSITY).unwrap()
        };
        for (name, symbol, speed) in [
            ("PMB", symbol::<2, _>(&pmb, m, Quadrature::None), c(&third)),
            ("LPS", symbol::<2, _>(&lps, m, Quadrature::None), c(&own)),
        ] {
            let ratio = symbol.critical_time_step() / courant(m * DX, speed);
            assert!((0.655..0.705).contains(&ratio), "{name} m = {m}: {ratio}");
        }
    }
}

/// Nodes on a plane wave of small amplitude have the force density −ρD(k)u, whatever the
/// material: an evaluation that shares nothing with the probe of the symbol.
fn follows_plane_waves<const D: usize, M: Material<f64, D>>(
    material: &M,
    k: nalgebra::SVector<f64, D>,
    polarisation: nalgebra::SVector<f64, D>,
) {
    let (m, cells) = (2.5, 13);
    let symbol: Symbol<D> = symbol(material, m, Quadrature::Exact);
    let dx = nalgebra::SVector::repeat(DX);
    let grid = Grid::lattice(-dx * 6.0, dx, [cells; D]).unwrap();
    let lattice = Lattice::new(&grid, Horizon::Cells(m), Quadrature::Exact).unwrap();
    let mut body = Body::new(lattice, material, NoDamage).unwrap();
    let k = k / DX;
    body.set_displacement(|x| polarisation * (1e-6 * DX * k.dot(x).cos()));
    body.evaluate().unwrap();
    let centre = grid.len() / 2;
    let force = body.force_density(centre);
    let expected = -symbol.stiffness(&k) * body.displacement(centre);
    assert!((force - expected).norm() < 1e-5 * expected.norm(), "{force} {expected}");
}

#[test]
fn a_body_on_a_plane_wave_feels_the_symbol() {
    let moduli = steel().unwrap();
    let gauss = InfluenceFunction::Gaussian;
    let (k2, p2) = (Vector2::new(0.9, -0.5), Vector2::new(1.0, 0.4));
    let (k3, p3) = (Vector3::new(0.9, -0.5, 0.3), Vector3::new(1.0, 0.4, -0.7));
    let c = Stiffness::<2>::isotropic(&moduli, PlaneMode::PlaneStrain).unwrap();
    let lps = LinearSolid::plane(&moduli, PlaneMode::PlaneStrain, DENSITY, gauss).unwrap();
    follows_plane_waves(&Ordinary::new(lps), k2, p2);
    follows_plane_waves(&Correspondence::new(LinearElastic(c), DENSITY, gauss).unwrap(), k2, p2);
    let lps = LinearSolid::solid(&moduli, DENSITY, gauss).unwrap();
    follows_plane_waves(&Ordinary::new(lps), k3, p3);
}

/// Scaling laws: ω ~ 1/Δx, and √(stiffness/density).
#[test]
fn frequencies_scale_with_the_spacing() {
    let model = LinearSolid::solid(&steel().unwrap(), DENSITY, InfluenceFunction::Linear).unwrap();
    let material = Ordinary::new(model);
    let at = |dx| Symbol::<3>::of(&material, dx, Horizon::Cells(2.2), Quadrature::Exact).unwrap();
    let (nano, kilo) = (at(1e-9), at(1e3));
    let ratio = nano.max_frequency() / kilo.max_frequency();
    assert!((ratio / 1e12 - 1.0).abs() < 1e-9, "{ratio}");
    let product = nano.critical_time_step() * nano.max_frequency();
    assert!((product - 2.0).abs() < 1e-12);
}
