//! Forces in a cloud do not depend on how its nodes are numbered, to the bit: neighbouring nodes may
//! lie in one block and be computed together, or anywhere.
use peridynamics::prelude::*;

/// Numbers 0..n in an order that looks random.
fn shuffled(n: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_key(|i| (*i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29));
    order
}

/// Cells of edge 1, all alike or those of the left half cut in eight; or nodes off their places by
/// up to a tenth, so that no two bonds are alike.
fn cloud(what: &str) -> Points<3> {
    let grid = Grid::lattice(SVector::zeros(), SVector::repeat(1.0), [9, 8, 7]).expect("grid");
    match what {
        "lattice" => Points::from_grid(&grid),
        "refined" => {
            Points::refined(&grid, |x| if x[0] < 4.0 { 0.5 } else { 1.0 }).expect("points")
        }
        _ => {
            let off = |x: SVector<f64, 3>| {
                SVector::from_fn(|d, _| x[d] + 0.1 * (37.0 * x[d] + 17.0 * x[(d + 1) % 3]).sin())
            };
            Points::new(grid.positions().map(off).collect(), vec![1.0; grid.len()]).expect("points")
        }
    }
}

/// The nodes `order` of a cloud, in this order.
fn numbered(points: &Points<3>, order: &[usize]) -> Points<3> {
    let positions = order.iter().map(|&i| *points.position(i)).collect();
    let volumes = order.iter().map(|&i| points.volume(i)).collect();
    Points::new(positions, volumes).expect("points").with_spacing(points.spacing()).expect("points")
}

/// Forces, by the order of the nodes in `points`, of a body with a notch whose bonds may break.
fn forces(points: &Points<3>, order: &[usize], size: f64) -> (Vec<SVector<f64, 3>>, usize) {
    let cloud = numbered(points, order);
    let horizons: Vec<f64> = (0..cloud.len()).map(|i| 2.6 * cloud.edge(i)).collect();
    let family = Cloud::<f64, 3>::graded(&cloud, &horizons, Quadrature::None).expect("family");
    let moduli = Isotropic::from_young_poisson(1e9, 0.2).expect("moduli");
    let solid = LinearSolid::solid(&moduli, 1e3, InfluenceFunction::Gaussian).expect("solid");
    let corner = [-1.0, 3.21, -1.0];
    let notch = Polygon::parallelogram(corner, [5.0, 0.0, 0.0], [0.0, 0.0, 9.0]).expect("notch");
    let policy = Breaking::new(CriticalStretch::new(0.06).expect("criterion")).precracked(notch);
    let mut body = Body::new(family, Ordinary::new(solid), policy).expect("body");
    body.set_displacement(|x| {
        SVector::from_fn(|d, _| size * (0.7 * x[d] + 0.3 * x[(d + 1) % 3]).sin())
    });
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Unchecked(1e-9)).expect("run");
    run.steps_more(1).expect("step");
    drop(run);
    let mut forces = vec![SVector::zeros(); order.len()];
    for (i, &of) in order.iter().enumerate() {
        forces[of] = body.force_density(i);
    }
    (forces, body.broken_bonds())
}

#[test]
fn forces_are_those_of_the_node_whatever_its_number() {
    for what in ["lattice", "refined", "irregular"] {
        let points = cloud(what);
        let n = points.len();
        // Small bonds only; some too large for polynomials; some that break.
        for (size, breaks) in [(1e-3, false), (0.05, false), (0.15, true)] {
            let (expected, broken) = forces(&points, &(0..n).collect::<Vec<_>>(), size);
            assert_eq!(broken > 0, breaks, "{what}, {size}: {broken} bonds broken");
            for order in [(0..n).rev().collect(), shuffled(n)] {
                let (found, bonds) = forces(&points, &order, size);
                assert_eq!(bonds, broken, "{what}, {size}");
                assert!(found == expected, "{what}, {size}: forces differ");
            }
        }
    }
}
