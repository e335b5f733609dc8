//! Nodes run along x first, then y, then z, and every accessor agrees with that.

use nalgebra::{SVector, Vector2, Vector3};
use pd_core::region::{Ball, Cuboid, Disc, Shape};
use pd_core::{Error, Grid};
use proptest::prelude::*;

#[test]
fn full_box() {
    let grid =
        Grid::lattice(Vector3::new(10.0, 20.0, 30.0), Vector3::new(1.0, 2.0, 3.0), [2, 3, 4])
            .unwrap();
    assert_eq!((grid.len(), grid.cells(), grid.cell_volume()), (24, [2, 3, 4], 6.0));
    assert_eq!(grid.origin(), &Vector3::new(10.0, 20.0, 30.0));
    assert_eq!(grid.spacing(), &Vector3::new(1.0, 2.0, 3.0));
    for node in 0..24 {
        let (z, y, x) = (node / 6, node / 2 % 3, node % 2);
        assert_eq!(grid.cell(node), [x, y, z]);
        assert_eq!(grid.node([x, y, z]), Some(node));
        let place = Vector3::new(10.0 + x as f64, 20.0 + 2.0 * y as f64, 30.0 + 3.0 * z as f64);
        assert_eq!(grid.position(node), place);
    }
    assert_eq!(grid.node([2, 0, 0]), None);
    assert_eq!(grid.node([0, 3, 0]), None);
}

#[test]
fn inactive_cells_are_skipped() {
    // 3 × 3 without the middle and the last
    let grid = Grid::lattice(Vector2::new(0.0, 0.0), Vector2::new(1.0, 1.0), [3, 3]).unwrap();
    let grid =
        grid.retain(|x| *x != Vector2::new(1.0, 1.0) && *x != Vector2::new(2.0, 2.0)).unwrap();
    let cells: Vec<_> = (0..grid.len()).map(|node| grid.cell(node)).collect();
    assert_eq!(cells, [[0, 0], [1, 0], [2, 0], [0, 1], [2, 1], [0, 2], [1, 2]]);
    assert_eq!(grid.node([1, 1]), None);
    assert_eq!(grid.node([2, 1]), Some(4));
    // again, on a grid that has tables already
    let grid = grid.retain(|x| x.y > 0.5).unwrap();
    let cells: Vec<_> = (0..grid.len()).map(|node| grid.cell(node)).collect();
    assert_eq!(cells, [[0, 1], [2, 1], [0, 2], [1, 2]]);
    assert_eq!((grid.node([0, 0]), grid.node([2, 1])), (None, Some(1)));
}

fn check_inverse<const D: usize>(grid: &Grid<D>, shape: &impl Shape<D>) {
    let mut last = None;
    for (node, x) in grid.positions().enumerate() {
        let cell = grid.cell(node);
        assert_eq!(grid.node(cell), Some(node));
        assert!(shape.contains(&x));
        assert_eq!(grid.nearest(&x), node);
        let key: Vec<_> = cell.iter().rev().copied().collect();
        assert!(last < Some(key.clone()), "lexicographic");
        last = Some(key);
    }
}

#[test]
fn nodes_and_cells_are_inverse() {
    let disc = Disc::new([0.1, 0.7], 0.5).unwrap();
    check_inverse(&Grid::new(&disc, 0.083).unwrap(), &disc);
    let ball = Ball::new([0.1, 0.7, 0.0], 0.5).unwrap();
    check_inverse(&Grid::with_spacing(&ball, [0.11, 0.17, 0.13]).unwrap(), &ball);
}

#[test]
fn cells_start_at_the_lower_bound_and_their_number_is_rounded() {
    let plate = |x, y| Cuboid::new([-1.0, 2.0], [-1.0 + x, 2.0 + y]).unwrap();
    let grid = Grid::new(&plate(1.0, 0.3), 0.1).unwrap();
    assert_eq!((grid.cells(), grid.len()), ([10, 3], 30));
    assert_eq!(grid.origin(), &Vector2::new(-0.95, 2.05));
    assert_eq!(Grid::new(&plate(1.0, 0.34), 0.1).unwrap().cells(), [10, 3]);
    assert_eq!(Grid::new(&plate(1.0, 0.36), 0.1).unwrap().cells(), [10, 4]);
    // thinner than a cell: still one cell, but its centre is outside
    assert_eq!(Grid::new(&plate(1.0, 0.06), 0.1).unwrap().len(), 10);
    let none = Grid::new(&plate(1.0, 0.04), 0.1);
    assert_eq!(none.unwrap_err(), Error::EmptyGrid { spacing: vec![0.1, 0.1] });
}

#[test]
fn refuses_impossible_grids() {
    let plate = Cuboid::new([0.0, 0.0], [1.0, 1.0]).unwrap();
    for spacing in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        match Grid::new(&plate, spacing) {
            Err(Error::InvalidValue { what: "spacing Δx [m]", value, .. }) => {
                assert!(value == spacing || value.is_nan());
            }
            other => panic!("{other:?}"),
        }
    }
    let many = Grid::new(&plate, 1e-5).unwrap_err();
    assert!(matches!(many, Error::InvalidValue { what: "number of cells", value: 1e10, .. }));
    let empty = Grid::lattice(Vector2::new(0.0, 0.0), Vector2::new(1.0, 1.0), [3, 0]);
    assert!(matches!(empty, Err(Error::InvalidValue { value: 0.0, .. })));
    let apart = Disc::new([5.0, 5.0], 1.0).unwrap();
    assert!(matches!(Grid::new(&plate.intersection(apart), 0.1), Err(Error::InvalidValue { .. })));
    assert!(matches!(
        Grid::new(&plate, 0.1).unwrap().retain(|_| false),
        Err(Error::EmptyGrid { .. })
    ));
}

#[test]
fn regions_follow_their_nodes() {
    let plate = Cuboid::new([0.0, 0.0], [4.0, 2.0]).unwrap();
    let right = Cuboid::new([2.0, 0.0], [4.0, 2.0]).unwrap();
    let corner = Cuboid::new([3.0, 1.0], [4.0, 2.0]).unwrap();
    let grid = Grid::new(&plate, 1.0).unwrap();
    assert_eq!((grid.regions(), grid.region(7)), (vec![0; 8], 0));
    let grid = grid.mark(1, &right).unwrap().mark(7, &corner).unwrap();
    assert_eq!(grid.regions(), [0, 0, 1, 1, 0, 0, 1, 7]);
    let grid = grid.retain(|x| x.x > 1.0 && x.y > 1.0).unwrap();
    assert_eq!(grid.regions(), [0, 1, 7]);
    assert_eq!(grid.region(2), 7);
    let outside = Disc::new([9.0, 9.0], 1.0).unwrap();
    assert_eq!(grid.mark(3, &outside).unwrap_err(), Error::EmptySet { name: "region 3".into() });
}

proptest! {
    #[test]
    fn nearest_is_nearest(x in -2.0..3.0, y in -2.0..3.0) {
        let ring = Disc::new([0.5, 0.5], 0.5).unwrap();
        let ring = ring.without(Disc::new([0.5, 0.5], 0.3).unwrap());
        let grid = Grid::new(&ring, 0.07).unwrap();
        let x: Vector2<f64> = Vector2::new(x, y);
        let distance = |p: SVector<f64, 2>| (p - x).norm();
        let found = distance(grid.position(grid.nearest(&x)));
        prop_assert!(grid.positions().all(|p| distance(p) >= found));
    }
}
