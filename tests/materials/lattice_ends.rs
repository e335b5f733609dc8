//! Blocks of neighbours at both ends of the node arrays are read where they are: lattices of every
//! small size, whose arrays end at every distance behind the last node, have the forces of the same
//! cloud to the last bit. (Without a block behind the last node 12 × 12 nodes did not.)
use crate::common;
use peridynamics::prelude::*;

fn forces<T: Real, F: Family<T, 2>>(family: F, dx: f64) -> Vec<SVector<f64, 2>> {
    let moduli = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
    let one = InfluenceFunction::Constant;
    let solid = LinearSolid::plane(&moduli, PlaneMode::PlaneStress, common::RHO, one);
    let material = Ordinary::linearised(solid.expect("material"));
    let mut body = Body::new(family, material, NoDamage).expect("body");
    body.set_displacement(|x| common::wavy(x, dx, 0.01 * dx));
    body.evaluate().expect("forces");
    (0..body.nodes()).map(|i| body.force_density(i)).collect()
}

fn check<T: Real>() {
    let dx = 1e-3;
    for (wide, high) in (4..48).flat_map(|wide| (4..14).map(move |high| (wide, high))) {
        let shape = Cuboid::centred([wide as f64 * dx, high as f64 * dx]).expect("box");
        let grid = Grid::new(&shape, dx).expect("grid");
        for m in [1.0, 2.0, 3.0] {
            let (m, none) = (Horizon::Cells(m), Quadrature::None);
            let cloud = Cloud::<T, 2>::new(&Points::from_grid(&grid), m, none).expect("cloud");
            let lattice = Lattice::<T, 2>::new(&grid, m, none).expect("lattice");
            let same = forces(lattice, dx) == forces(cloud, dx);
            assert!(same, "{wide} x {high}, {m:?}, {}", T::NAME);
        }
    }
}

#[test]
fn a_lattice_of_any_size_is_the_same_cloud() {
    check::<f64>();
    check::<f32>();
}
