//! Static solutions that are known in closed form on the lattice, in 2D and 3D.
//!
//! The force operator of a bulk node is exact on linear fields for every material, and on
//! quadratic ones where the material has the stiffness C exactly: f = div(C:ε). A body held in a
//! collar of two horizons, inside which every node is a bulk node, must find both again.
use crate::common;
use peridynamics::prelude::*;

const DX: f64 = 1e-3;

/// A grid with `inner` free cells along each axis inside a collar, and the set of the collar.
fn collared<const D: usize>(inner: usize, collar: usize) -> (Grid<D>, NodeSet) {
    let cells = inner + 2 * collar;
    let grid = Grid::new(&Cuboid::centred([cells as f64 * DX; D]).expect("box"), DX).expect("grid");
    let edge = 0.5 * inner as f64 * DX;
    let held = grid.select(|x| x.iter().any(|x| x.abs() > edge));
    (grid, held)
}

/// Largest error of the solution over the largest displacement; u is prescribed on the collar, b
/// is the body force everywhere.
fn error<const D: usize, M: Material<f64, D>>(
    material: M,
    u: impl Fn(&SVector<f64, D>) -> SVector<f64, D>,
    b: SVector<f64, D>,
) -> f64 {
    let (grid, held) = collared::<D>(if D == 2 { 12 } else { 5 }, if D == 2 { 6 } else { 4 });
    let family =
        Lattice::new(&grid, Horizon::Cells(if D == 2 { 3.0 } else { 2.0 }), Quadrature::None);
    let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
    let mut loads = Loads::new();
    for node in held.iter() {
        let one = NodeSet::from_nodes([node], grid.len()).expect("node");
        for axis in 0..D {
            loads = loads.displacement(&one, axis, u(&grid.position(node))[axis]);
        }
    }
    let all = grid.select(|_| true);
    for axis in 0..D {
        loads = loads.body_force(&all, axis, b[axis]);
    }
    let solver = Statics::new().with_tolerance(1e-11).expect("tolerance");
    solver.solve(&mut body, loads).expect("solved");
    let size = (0..grid.len()).map(|i| u(&grid.position(i)).norm()).fold(0.0, f64::max);
    let worst = (0..grid.len()).map(|i| (body.displacement(i) - u(&grid.position(i))).norm());
    worst.fold(0.0, f64::max) / size
}

fn gradient<const D: usize>() -> SMatrix<f64, D, D> {
    let h = [[1e-6, 4e-7, -2e-7], [3e-7, -5e-7, 3e-7], [-1e-7, 6e-7, 7e-7]];
    SMatrix::from_fn(|i, j| h[i][j])
}

macro_rules! linear_field {
    ($material:expr, $grid:ident, $d:literal) => {{
        let _ = &$grid;
        let name = stringify!($material);
        // Zero-energy modes, and the unstable calibration, have no unique or no static solution.
        if !(name == "small()"
            || name.contains("finite()")
            || name.contains("Neo")
            || name.contains("polynomial"))
        {
            let found = error::<$d, _>($material, |x| gradient::<$d>() * x, SVector::zeros());
            assert!(found < 1e-8, "{name}: {found:e}");
        }
    }};
}

#[test]
fn homogeneous_strain_of_every_material() {
    crate::for_every_material!(linear_field, DX);
}

/// u = ½ g (x·a)² in direction w: ε is linear, div C:ε constant, and b = −div C:ε.
fn quadratic<const D: usize>(
    c: &Stiffness<D>,
) -> (impl Fn(&SVector<f64, D>) -> SVector<f64, D> + use<D>, SVector<f64, D>) {
    let a = SVector::<f64, D>::from_fn(|d, _| [0.8, -0.5, 0.3][d]);
    let w = SVector::<f64, D>::from_fn(|d, _| [0.4, 1.0, -0.7][d]);
    let g = 1e-3;
    // (C:ε)_ij = C_ijkl w_k a_l g (x·a), so div_i = C_ijkl w_k a_l a_j g.
    let b = SVector::from_fn(|i, _| {
        let mut sum = 0.0;
        for j in 0..D {
            for k in 0..D {
                for l in 0..D {
                    sum -= c.c(i, j, k, l) * w[k] * a[l] * a[j] * g;
                }
            }
        }
        sum
    });
    (move |x: &SVector<f64, D>| w * (0.5 * g * x.dot(&a).powi(2)), b)
}

#[test]
fn quadratic_field_of_the_positive_split() {
    let (u, b) = quadratic(&common::ply());
    let model = PositiveSplit::plane(&common::ply(), 1e3, common::OMEGA).expect("material");
    let found = error::<2, _>(Ordinary::linearised(model), u, b);
    assert!(found < 1e-8, "2D: {found:e}");
    let (u, b) = quadratic(&common::solid());
    let model = PositiveSplit::solid(&common::solid(), 1e3, common::OMEGA).expect("material");
    let found = error::<3, _>(Ordinary::linearised(model), u, b);
    assert!(found < 1e-8, "3D: {found:e}");
}

#[test]
fn quadratic_field_of_correspondence() {
    let (u, b) = quadratic(&common::ply());
    let law = LinearElastic(common::ply());
    let control = WanControl::new(&common::ply(), 1.0).expect("control");
    // What a quadratic field does to the bonds of a bulk node is the same at both ends: the control
    // adds nothing.
    let material = Correspondence::new(law, 1e3, common::OMEGA).expect("m").with_control(control);
    let found = error::<2, _>(material, u, b);
    assert!(found < 1e-8, "{found:e}");
}
