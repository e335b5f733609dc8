//! A crack through a node is refused, with a shift that works.

use nalgebra::{Vector2, Vector3};
use pd_core::crack::{Polygon, Segment, check_clear};
use pd_core::region::Cuboid;
use pd_core::{CrackSurface, Error, Grid};

fn plate() -> Grid<2> {
    let body = Cuboid::new([0.0, 0.0], [0.01, 0.01]).unwrap();
    Grid::new(&body, 0.001).unwrap()
}

/// How far along the normal the error says to shift, after checking that it is no lie.
fn shift_of(grid: &Grid<2>, start: Vector2<f64>, end: Vector2<f64>) -> f64 {
    let crack = Segment::new(start.into(), end.into()).unwrap();
    let Err(Error::CrackThroughNode { node, position, shift }) =
        check_clear(&crack, grid.positions(), 0.001)
    else {
        panic!("not refused")
    };
    assert_eq!(position, grid.position(node).as_slice());
    assert!(crack.distance(&grid.position(node)) < 1e-12);
    let by = Vector2::from_column_slice(&shift);
    assert!(by.perp(&crack.normal()).abs() < 1e-18);
    let moved = Segment::new((start + by).into(), (end + by).into()).unwrap();
    check_clear(&moved, grid.positions(), 0.001).unwrap();
    // none of the other candidates keeps further from the nodes
    let clearance = |part: f64| {
        let by = crack.normal() * (part * 0.001);
        grid.positions().map(|x| crack.distance(&(x - by))).fold(f64::INFINITY, f64::min)
    };
    let along = by.dot(&crack.normal());
    for part in [0.125, 0.25, 0.375, 0.5] {
        assert!(clearance(along / 0.001) > clearance(part) - 1e-12);
    }
    along
}

#[test]
fn shift_avoids_the_nodes() {
    let grid = plate();
    // along a row: half a spacing is between rows
    let half = shift_of(&grid, Vector2::new(0.0, 0.0045), Vector2::new(0.005, 0.0045));
    assert!((half - 0.0005).abs() < 1e-15);
    // at 45° rows are 1/√2 spacings apart, so 3/8 is nearer to the middle
    let diagonal = shift_of(&grid, Vector2::new(0.0, 0.0), Vector2::new(0.01, 0.01));
    assert!((diagonal - 0.000375).abs() < 1e-15);
    // with slope ½ rows are 1/√5 spacings apart and half a spacing is nearly on the next
    shift_of(&grid, Vector2::new(0.0005, 0.0005), Vector2::new(0.0085, 0.0045));
}

#[test]
fn message_says_what_to_do() {
    let grid = Grid::lattice(Vector2::new(0.0, 0.0), Vector2::new(1.0, 1.0), [4, 4]).unwrap();
    let crack = Segment::new([0.5, 2.0], [-3.0, 2.0]).unwrap();
    let message = check_clear(&crack, grid.positions(), 1.0).unwrap_err().to_string();
    let expected = "the crack passes through node 8 at [0.0, 2.0] m, so its side would be chance: \
        shift the crack by [-0.0, -0.5] m to pass between nodes";
    assert_eq!(message, expected);
}

#[test]
fn clear_cracks_pass() {
    let grid = plate();
    // along a row of nodes, but ending before the first
    for (end, y) in [(0.005, 0.004), (0.000_499, 0.0045)] {
        let crack = Segment::new([-0.001, y], [end, y]).unwrap();
        check_clear(&crack, grid.positions(), 0.001).unwrap();
    }
}

#[test]
fn in_space() {
    let grid =
        Grid::lattice(Vector3::new(0.0, 0.0, 0.0), Vector3::new(1.0, 1.0, 1.0), [3, 3, 3]).unwrap();
    let (e1, e2) = (Vector3::new(2.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0));
    let at = |z| Polygon::parallelogram([0.5, 0.5, z], e1.into(), e2.into()).unwrap();
    check_clear(&at(0.5), grid.positions(), 1.0).unwrap();
    let Err(Error::CrackThroughNode { node, shift, .. }) =
        check_clear(&at(1.0), grid.positions(), 1.0)
    else {
        panic!("not refused")
    };
    assert_eq!((grid.cell(node), shift), ([1, 1, 1], vec![0.0, 0.0, 0.5]));
}
