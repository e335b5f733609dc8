//! The same lattice given as a grid and as points yields bitwise equal forces.
use crate::common;

#[test]
fn forces_are_bitwise_equal() {
    for dx in [1.0, 0.1, 1e-3 / 3.0] {
        macro_rules! check {
            ($material:expr, $grid:expr, $d:literal) => {{
                let (grid, horizon, beta) = (&$grid, Horizon::Cells(3.0), Quadrature::LinearRamp);
                let lattice = Lattice::<f64, $d>::new(grid, horizon, beta).expect("family");
                let volumes = vec![grid.cell_volume(); grid.len()];
                let points = Points::new(grid.positions().collect(), volumes).expect("points");
                let points = points.with_spacing(dx).expect("spacing");
                let cloud = Cloud::<f64, $d>::new(&points, horizon, beta).expect("family");
                assert_eq!(
                    Family::<f64, $d>::bonds(&lattice),
                    Family::<f64, $d>::bonds(&cloud),
                    "bonds"
                );
                let mut a = Body::new(lattice, $material, NoDamage).expect("body");
                let mut b = Body::new(cloud, $material, NoDamage).expect("body");
                let u = |x: &SVector<f64, $d>| common::wavy(x, dx, 1e-3 * dx);
                a.set_displacement(u);
                b.set_displacement(u);
                a.evaluate().expect("forces");
                b.evaluate().expect("forces");
                for i in 0..a.nodes() {
                    assert_eq!(a.force_density(i), b.force_density(i), "node {i}, Δx = {dx}");
                }
            }};
        }
        crate::for_every_material!(check, dx);
    }
}
