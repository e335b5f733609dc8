//! Homogeneous strain: stress and energy of the continuum.
use crate::common;
use peridynamics::prelude::*;

const STRAIN: [[f64; 3]; 3] = [[1e-3, 4e-4, -2e-4], [4e-4, -5e-4, 3e-4], [-2e-4, 3e-4, 7e-4]];

fn strain<const D: usize>() -> SMatrix<f64, D, D> {
    SMatrix::from_fn(|i, j| STRAIN[i][j])
}

/// Correspondence: C:ε at every node, boundary nodes too.
#[test]
fn correspondence_has_the_stress_of_the_stiffness() {
    let grid = common::ring(1e-3);
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None);
    let law = LinearElastic(common::ply());
    let material = Correspondence::new(law, 1e3, InfluenceFunction::Linear).expect("material");
    let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
    body.set_displacement(|x| strain() * x);
    body.evaluate().expect("forces");
    let exact = common::ply().contract(&strain::<2>());
    for i in 0..body.nodes() {
        assert!((body.stress(i) - exact).norm() < 1e-11 * exact.norm(), "node {i}");
    }
}

/// The positive split: ½ ε:C:ε at every node, whatever the horizon, the weights and the surface.
#[test]
fn positive_split_has_the_energy_of_the_stiffness() {
    for (m, beta) in [(1.5, Quadrature::None), (2.0, Quadrature::Exact), (3.0, Quadrature::None)] {
        let grid = common::ring(1e-3);
        let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(m), beta).expect("family");
        let model = PositiveSplit::plane(&common::ply(), 1e3, InfluenceFunction::Gaussian);
        let material = Ordinary::linearised(model.expect("material"));
        let mut body = Body::new(family, material, NoDamage).expect("body");
        body.set_displacement(|x| strain() * x);
        body.evaluate().expect("forces");
        let exact = common::ply().energy(&strain());
        for (i, w) in body.energy_densities().iter().enumerate() {
            assert!((w / exact - 1.0).abs() < 1e-10, "node {i}, m = {m}: {w:e}, {exact:e}");
        }
    }
    let family =
        Lattice::<f64, 3>::new(&common::block(1e-3), Horizon::Cells(2.0), Quadrature::None);
    let model = PositiveSplit::solid(&common::solid(), 1e3, InfluenceFunction::Gaussian);
    let material = Ordinary::linearised(model.expect("material"));
    let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
    body.set_displacement(|x| strain() * x);
    body.evaluate().expect("forces");
    let exact = common::solid().energy(&strain());
    for (i, w) in body.energy_densities().iter().enumerate() {
        assert!((w / exact - 1.0).abs() < 1e-10, "node {i}: {w:e}, {exact:e}");
    }
}

/// PMB calibrated on the family: the energy of a dilation is exact at every node.
#[test]
fn calibrated_bonds_have_the_energy_of_a_dilation() {
    let moduli = Isotropic::from_young_poisson(7e10, 0.25).expect("moduli");
    let model = Pmb::solid(&moduli, 1e3, InfluenceFunction::Linear).expect("material").on_family();
    let family =
        Lattice::<f64, 3>::new(&common::block(1e-3), Horizon::Cells(3.0), Quadrature::None);
    let material = Ordinary::linearised(model);
    let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
    body.set_displacement(|x| x * 1e-3);
    body.evaluate().expect("forces");
    let exact = 4.5 * moduli.bulk() * 1e-6;
    for w in body.energy_densities() {
        assert!((w / exact - 1.0).abs() < 1e-12, "{w:e}, {exact:e}");
    }
}
