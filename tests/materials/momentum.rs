//! Internal forces add up to zero, to rounding: every material, and graded clouds.
use crate::common;
use peridynamics::prelude::*;

fn unbalanced<const D: usize>(forces: impl Iterator<Item = SVector<f64, D>>) -> f64 {
    let (sum, size) =
        forces.fold((SVector::<f64, D>::zeros(), 0.0), |(sum, size), f| (sum + f, size + f.norm()));
    sum.norm() / size
}

#[test]
fn linear_momentum_is_kept() {
    macro_rules! check {
        ($material:expr, $grid:expr, $d:literal) => {{
            let family = Lattice::<f64, $d>::new(&$grid, Horizon::Cells(3.0), Quadrature::Exact);
            let mut body = Body::new(family.expect("family"), $material, NoDamage).expect("body");
            body.set_displacement(|x| common::wavy(x, 1e-3, 1e-6));
            body.evaluate().expect("forces");
            let residual = unbalanced((0..body.nodes()).map(|i| body.force_density(i)));
            assert!(residual < 1e-13, "{residual:e}");
        }};
    }
    crate::for_every_material!(check, 1e-3);
}

/// Volumes and horizons that vary by node: no ghost forces with the dual horizon.
#[test]
fn dual_horizon_has_no_ghost_forces() {
    let mut positions: Vec<SVector<f64, 2>> = Vec::new();
    let (mut volumes, mut horizons) = (Vec::new(), Vec::new());
    for (count, dx, left) in [(10, 1e-3, 0.0), (20, 5e-4, 1e-2)] {
        for i in 0..count {
            for j in 0..count {
                positions.push([left + (i as f64 + 0.5) * dx, (j as f64 + 0.5) * dx].into());
                volumes.push(dx * dx);
                horizons.push(3.015 * dx);
            }
        }
    }
    let points = Points::new(positions, volumes).expect("points");
    let cloud = Cloud::<f64, 2>::graded(&points, &horizons, Quadrature::None).expect("family");
    let moduli = Isotropic::from_young_poisson(7e10, 0.2).expect("moduli");
    let mode = PlaneMode::PlaneStress;
    let model = LinearSolid::plane(&moduli, mode, 1e3, InfluenceFunction::Gaussian).expect("m");
    let mut body = Body::new(cloud, Ordinary::new(model), NoDamage).expect("body");
    body.set_displacement(|x| common::wavy(x, 1e-3, 1e-6));
    body.evaluate().expect("forces");
    let residual = unbalanced((0..body.nodes()).map(|i| body.force_density(i) * body.volume(i)));
    assert!(residual < 1e-13, "{residual:e}");
}
