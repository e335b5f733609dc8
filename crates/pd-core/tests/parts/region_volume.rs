//! Regions and combinators hold the volume they should, counted on a fine grid.

use std::f64::consts::PI;

use approx::assert_relative_eq;
use nalgebra::{Vector2, Vector3};
use pd_core::region::{Ball, Cuboid, Cylinder, Disc, Shape, Within};
use pd_core::{Error, Grid};

/// Volume of the cells of edge `dx` whose centres are in the shape.
fn volume<const D: usize>(shape: &impl Shape<D>, dx: f64) -> f64 {
    let grid = Grid::new(shape, dx).unwrap();
    grid.len() as f64 * grid.cell_volume()
}

fn square() -> Cuboid<2> {
    Cuboid::new([0.0, 0.0], [2.0, 2.0]).unwrap()
}

fn disc() -> Disc {
    Disc::new([1.0, 1.0], 0.5).unwrap()
}

#[test]
fn simple_shapes() {
    assert_relative_eq!(volume(&square(), 0.1), 4.0, max_relative = 1e-12);
    assert_relative_eq!(volume(&disc(), 0.002), PI / 4.0, max_relative = 1e-3);
    let ball = Ball::new([0.3, -0.2, 5.0], 0.7).unwrap();
    assert_relative_eq!(volume(&ball, 0.02), 4.0 / 3.0 * PI * 0.343, max_relative = 2e-3);
}

#[test]
fn oblique_cylinder_fills_its_bounds() {
    let (start, end) = (Vector3::new(0.1, 0.2, 0.3), Vector3::new(0.9, 0.5, 1.3));
    let cylinder = Cylinder::new(start.into(), end.into(), 0.25).unwrap();
    let exact = PI * 0.0625 * (end - start).norm();
    // a grid on a larger box must find nothing outside the cylinder's own bounds
    let room = Cuboid::new([-1.0, -1.0, -1.0], [2.0, 2.0, 2.0]).unwrap();
    let grid = Grid::new(&room, 0.02).unwrap().retain(|x| cylinder.contains(x)).unwrap();
    assert_relative_eq!(grid.len() as f64 * grid.cell_volume(), exact, max_relative = 5e-3);
    assert_relative_eq!(volume(&cylinder, 0.02), exact, max_relative = 5e-3);
    let (min, max) = cylinder.bounds();
    for axis in 0..3 {
        let low = grid.positions().map(|x| x[axis]).fold(f64::INFINITY, f64::min);
        let high = grid.positions().map(|x| x[axis]).fold(f64::NEG_INFINITY, f64::max);
        assert!(low >= min[axis] && low < min[axis] + 0.03, "{low} {min}");
        assert!(high <= max[axis] && high > max[axis] - 0.03, "{high} {max}");
    }
}

#[test]
fn combinators() {
    let right = Cuboid::new([1.0, 0.0], [3.0, 1.0]).unwrap();
    assert_relative_eq!(volume(&square().union(right), 0.01), 5.0, max_relative = 1e-12);
    assert_relative_eq!(volume(&square().intersection(right), 0.01), 1.0, max_relative = 1e-12);
    let plate = square().without(disc());
    assert_relative_eq!(volume(&plate, 0.005), 4.0 - PI / 4.0, max_relative = 1e-4);
    assert_eq!(plate.bounds(), square().bounds());
    // nested: the quarter of the perforated plate, then with a plug in the hole
    let quarter = Cuboid::new([1.0, 1.0], [2.0, 2.0]).unwrap();
    let cut = plate.intersection(quarter);
    assert_relative_eq!(volume(&cut, 0.002), 1.0 - PI / 16.0, max_relative = 1e-4);
    assert_relative_eq!(volume(&plate.union(disc()), 0.01), 4.0, max_relative = 1e-12);
}

#[test]
fn many_holes_in_a_loop() {
    let mut plate: Box<dyn Shape<2>> = Box::new(square());
    for i in 0..4 {
        let centre = Vector2::new(0.5 + f64::from(i % 2), 0.5 + f64::from(i / 2));
        plate = Box::new(plate.without(Disc::new(centre.into(), 0.2).unwrap()));
    }
    assert_relative_eq!(volume(&plate, 0.004), 4.0 - 4.0 * PI * 0.04, max_relative = 1e-3);
}

#[test]
fn closure_inside_bounds_only() {
    let half = Within::new(square(), |x: &Vector2<f64>| x.x + x.y < 2.0);
    assert_relative_eq!(volume(&half, 0.001), 2.0, max_relative = 1e-3);
    assert!(!half.contains(&Vector2::new(-0.1, 0.5)));
}

#[test]
fn layers_outside_the_body() {
    let layered = square().extended(1, 0.3, 0.2).unwrap();
    assert_eq!(layered.bounds(), (Vector2::new(0.0, -0.3), Vector2::new(2.0, 2.2)));
    assert!(matches!(square().extended(2, 0.1, 0.1), Err(Error::InvalidValue { value: 2.0, .. })));
    assert!(matches!(
        square().extended(0, -1.5, -1.5),
        Err(Error::InvalidValue { value: -1.0, .. })
    ));
    assert!(square().extended(0, 0.1, f64::NAN).is_err());
}

#[test]
fn refuses_what_is_no_shape() {
    let flat = Cuboid::new([0.0, 1.0], [1.0, 1.0]).unwrap_err();
    assert!(matches!(flat, Error::InvalidValue { what: "edge of a box [m]", value: 0.0, .. }));
    assert!(Cuboid::new([f64::NAN, 0.0], [1.0, 1.0]).is_err());
    assert!(Cuboid::new([f64::NEG_INFINITY, 0.0], [1.0, 1.0]).is_err());
    assert!(Disc::new([0.0, 0.0], 0.0).is_err());
    assert!(Disc::new([0.0, f64::INFINITY], 1.0).is_err());
    let up = [0.0, 0.0, 1.0];
    assert!(Cylinder::new(up, up, 1.0).is_err());
    assert!(Cylinder::new([0.0; 3], up, -1.0).is_err());
}
