//! Conjugate gradients against the dense Cholesky solution of the same body, every material.
use crate::common;
use common::{OMEGA, RHO, dense_stiffness};
use nalgebra::DVector;
use peridynamics::prelude::*;

/// A plate with a notch in its outline; a block.
fn small<const D: usize>() -> Grid<D> {
    let edges: [f64; D] =
        std::array::from_fn(|d| if D == 2 { [9.0, 7.0][d] } else { [6.0, 5.0, 4.0][d] });
    let grid = Grid::new(&Cuboid::centred(edges.map(|e| e * 1e-3)).expect("box"), 1e-3);
    grid.expect("grid").retain(|x| !(x[0].abs() < 1.1e-3 && x[1] > 2.1e-3)).expect("grid")
}

/// Solves the same problem both ways; returns the largest difference over the largest
/// displacement, or None where both say that the operator is not positive definite.
fn differs<const D: usize, F, M>(family: F, grid: &Grid<D>, material: M) -> Option<f64>
where
    F: Family<f64, D>,
    M: Material<f64, D>,
{
    let left = grid.select(|x| x[0] < grid.position(0)[0] + 1.1e-3);
    let right = grid.select(|x| x[0] > -grid.position(0)[0] - 0.1e-3);
    // Displacements along one component only, on the right, and body forces everywhere.
    let all = grid.select(|_| true);
    let loads = || {
        let loads = Loads::new().clamp::<D>(&left).displacement(&right, D - 1, 2e-6);
        loads.body_force(&right, 0, 3e9).body_force(&all, 1, -5e8)
    };
    let mut body = Body::new(family, material, NoDamage).expect("body");
    let k = dense_stiffness(&mut body);
    let (n, dx) = (k.nrows(), 1e-3);
    assert!((&k - k.transpose()).amax() < 1e-7 * k.amax(), "V K is symmetric");

    let mut u = DVector::<f64>::zeros(n);
    let mut b = DVector::zeros(n);
    let mut free = vec![true; n];
    for node in 0..grid.len() {
        let v = body.volume(node) * dx;
        b[D * node] += if right.contains(node) { 3e9 * v } else { 0.0 };
        b[D * node + 1] -= 5e8 * v;
        for axis in 0..D {
            if left.contains(node) {
                free[D * node + axis] = false;
            } else if right.contains(node) && axis == D - 1 {
                free[D * node + axis] = false;
                u[D * node + axis] = 2e-6 / dx;
            }
        }
    }
    let free: Vec<usize> = (0..n).filter(|&i| free[i]).collect();
    let rest = (&b - &k * &u).select_rows(&free);
    let reduced = k.select_rows(&free).select_columns(&free);
    let reduced = (&reduced + reduced.transpose()) * 0.5;
    let eigenvalues = reduced.clone().symmetric_eigenvalues();
    // Differences of forces leave a larger rest than forces.
    let tolerance = if M::LINEAR { 1e-10 } else { 1e-8 };
    let solver = Statics::new().with_tolerance(tolerance).expect("tolerance");
    let solved = solver.solve(&mut body, loads());
    if eigenvalues.min() < -1e-6 * eigenvalues.max() {
        let error = solved.expect_err("the operator is indefinite");
        assert!(matches!(error, Error::IndefiniteOperator { .. }), "{error}");
        return None;
    }
    let exact = reduced.cholesky().expect("positive definite").solve(&rest);
    for (&i, x) in free.iter().zip(exact.iter()) {
        u[i] = *x;
    }
    solved.expect("solved");
    let got = DVector::from_fn(n, |i, _| body.displacement(i / D)[i % D] / dx);
    Some((got - &u).amax() / u.amax())
}

macro_rules! check {
    ($material:expr, $grid:ident, $d:literal) => {{
        let _ = &$grid;
        let grid = small::<$d>();
        let horizon = Horizon::Cells(if $d == 2 { 3.0 } else { 2.0 });
        let lattice = Lattice::<f64, $d>::new(&grid, horizon, Quadrature::Exact).expect("family");
        let name = stringify!($material);
        let found = differs(lattice, &grid, $material);
        println!("{name}: {found:?}");
        if let Some(difference) = found {
            assert!(difference < 1e-6, "{name}: {difference:e}");
        } else {
            assert!(name.contains("polynomial") || name == "small()", "{name} is stable");
        }
    }};
}

#[test]
fn every_material() {
    crate::for_every_material!(check, 1e-3);
}

/// Volumes and horizons that differ from node to node: V K is symmetric, K is not.
#[test]
fn a_graded_cloud() {
    let grid = small::<2>();
    let wave = |i: usize| ((i * i) as f64).sin();
    let positions: Vec<_> =
        grid.positions().enumerate().map(|(i, x)| x.add_scalar(1e-4 * wave(i))).collect();
    let volumes = (0..grid.len()).map(|i| grid.cell_volume() * (1.0 + 0.3 * wave(i))).collect();
    let points = Points::new(positions, volumes).and_then(|p| p.with_spacing(1e-3));
    let horizons: Vec<f64> = (0..grid.len()).map(|i| 2.6e-3 + 3e-4 * wave(i)).collect();
    let cloud = Cloud::<f64, 2>::graded(&points.expect("points"), &horizons, Quadrature::None);
    let model = PositiveSplit::plane(&common::ply(), RHO, OMEGA).expect("material");
    let found = differs(cloud.expect("cloud"), &grid, Ordinary::linearised(model));
    assert!(found.is_some_and(|d| d < 1e-6), "{found:?}");
}
