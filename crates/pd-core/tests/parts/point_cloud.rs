//! Point clouds refuse nodes that cannot be, and agree with the grid they come from.

use approx::assert_relative_eq;
use nalgebra::{Vector2, Vector3};
use pd_core::region::{Cuboid, Disc};
use pd_core::{Error, Grid, Points};

#[test]
fn of_a_grid() {
    let disc = Disc::new([0.0, 0.0], 1.0).unwrap();
    let grid = Grid::with_spacing(&disc, [0.1, 0.4]).unwrap();
    let points = Points::from_grid(&grid);
    assert_eq!(points.len(), grid.len());
    for (node, x) in grid.positions().enumerate() {
        assert_eq!((points.position(node), points.volume(node)), (&x, grid.cell_volume()));
    }
    assert_eq!(points.spacing(), 0.1);
    assert_eq!(points.select(|x| x.x > 0.5), grid.select(|x| x.x > 0.5));
    // what the conversion does not check holds
    Points::new(grid.positions().collect(), vec![grid.cell_volume(); grid.len()]).unwrap();
}

#[test]
fn spacing_is_that_of_the_median_volume() {
    let line = |n: usize| (0..n).map(|i| Vector3::new(i as f64, 0.0, 0.0)).collect();
    let points = Points::new(line(3), vec![1e9, 8.0, 1.0]).unwrap();
    assert_relative_eq!(points.spacing(), 2.0, max_relative = 1e-14);
    let points = points.with_spacing(0.3).unwrap();
    assert_eq!((points.spacing(), points.volume(1)), (0.3, 8.0));
    assert!(points.with_spacing(0.0).is_err());
}

#[test]
fn refuses_points_in_the_same_place() {
    let mut positions: Vec<Vector2<f64>> =
        (0..200).map(|i| Vector2::new((i * 37 % 200) as f64, (i % 7) as f64)).collect();
    positions[150] = Vector2::new(-0.0, 2.0);
    positions[31] = Vector2::new(0.0, 2.0);
    let error = Points::new(positions, vec![1.0; 200]).unwrap_err();
    let Error::CoincidentNodes { nodes, ref position } = error else { panic!("{error}") };
    assert_eq!(nodes, [31, 150]);
    assert_eq!(position, &[0.0, 2.0]);
    assert!(error.to_string().starts_with("nodes 31 and 150 are both at [0.0, 2.0] m"), "{error}");
}

#[test]
fn refuses_bad_numbers() {
    let two = || vec![Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0)];
    let uneven = Points::new(two(), vec![1.0]).unwrap_err();
    assert!(matches!(uneven, Error::InvalidValue { what: "number of volumes", value: 1.0, .. }));
    assert!(matches!(Points::<2>::new(vec![], vec![]), Err(Error::InvalidValue { .. })));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Points::new(two(), vec![1.0, bad]).unwrap_err();
        assert!(matches!(error, Error::InvalidNodeValue { node: 1, .. }), "{error}");
        assert!(error.to_string().starts_with("volume V [m^D] of node 1 is"), "{error}");
    }
    for bad in [f64::NAN, f64::NEG_INFINITY] {
        let error = Points::new(vec![Vector2::new(0.0, bad)], vec![1.0]).unwrap_err();
        assert!(matches!(error, Error::InvalidNodeValue { node: 0, .. }), "{error}");
        assert!(error.to_string().starts_with("coordinate [m] of node 0 is"), "{error}");
    }
}

#[test]
fn refined_cells_fill_the_grid() {
    let cube = Cuboid::new([0.0; 3], [4.0; 3]).unwrap();
    let grid = Grid::new(&cube, 1.0).unwrap();
    let wanted = |x: &Vector3<f64>| if x.x < 1.0 { 0.25 } else { 0.6 + x.y };
    let points = Points::refined(&grid, wanted).unwrap();
    assert_relative_eq!((0..points.len()).map(|i| points.volume(i)).sum::<f64>(), 64.0);
    assert_eq!(points.spacing(), 0.25);
    let rows: Vec<_> =
        (0..points.len()).map(|i| points.position(i)).map(|x| [x.z, x.y, x.x]).collect();
    assert!(rows.is_sorted(), "numbered in rows along x");
    for node in 0..points.len() {
        let (x, edge) = (points.position(node), points.edge(node));
        // No wider than asked for, never halved without need, and on the grid of its own edge.
        assert!(edge <= wanted(x) * (1.0 + 1e-9), "{x} {edge}");
        let parent = x.map(|c| ((c / (2.0 * edge)).floor() + 0.5) * 2.0 * edge);
        assert!(edge > 0.9 || wanted(&parent) < 2.0 * edge, "{x} {edge}");
        let place = x / edge - Vector3::repeat(0.5);
        assert!((place - place.map(f64::round)).amax() < 1e-9);
    }
    assert_eq!(Points::refined(&grid, |_| 1.0).unwrap().len(), grid.len());
    for bad in [0.0, f64::NAN] {
        assert!(matches!(Points::refined(&grid, |_| bad), Err(Error::InvalidValue { .. })));
    }
}
