//! Cell centres on a boundary are in, whatever the rounding of their coordinates.

use nalgebra::{Vector2, Vector3};
use pd_core::Grid;
use pd_core::region::{Ball, Cuboid, Disc, Shape};
use proptest::prelude::*;

proptest! {
    /// Centres on a circle through lattice points: the discs are the same wherever they are.
    #[test]
    fn disc_through_centres(x in -9.0..9.0f64, y in -9.0..9.0, dx in 1e-4..2.0) {
        let centre = Vector2::new(x, y);
        let reach = Vector2::repeat(10.5 * dx);
        let plate = Cuboid::new((centre - reach).into(), (centre + reach).into()).unwrap();
        // 5² = 3² + 4²: twelve lattice points on the circle, 81 in the closed disc
        let disc = Disc::new(centre.into(), 5.0 * dx).unwrap();
        let grid = Grid::new(&plate, dx).unwrap();
        prop_assert_eq!(grid.cells(), [21, 21]);
        prop_assert_eq!(grid.select_in(&disc).len(), 81);
        // the rim belongs to the disc and to the plate without it
        prop_assert_eq!(Grid::new(&plate.without(disc), dx).unwrap().len(), 441 - 69);
        let open = grid.select(|p: &Vector2<f64>| (p - centre).norm() < 4.9 * dx);
        prop_assert_eq!(open.len(), 69);
    }

    /// Corners of a box on cell centres, in 3D, where rounding acts on several axes at once.
    #[test]
    fn plate_through_centres(x in -9.0..9.0f64, dx in 1e-3..2.0) {
        let low = Vector3::new(x, -x / 3.0, x / 7.0);
        let body = Cuboid::new(low.into(), (low.add_scalar(9.0 * dx)).into()).unwrap();
        let first = low.add_scalar(0.5 * dx);
        let inner = Cuboid::new((first.add_scalar(2.0 * dx)).into(), (first.add_scalar(5.0 * dx)).into()).unwrap();
        let grid = Grid::new(&body, dx).unwrap().mark(1, &inner).unwrap();
        prop_assert_eq!(grid.regions().iter().filter(|&&region| region == 1).count(), 64);
    }
}

#[test]
fn beyond_the_tolerance_rounding_is_not_the_cause() {
    let at = Vector3::zeros();
    let grid = Grid::lattice(at, Vector3::new(1.0, 1.0, 1.0), [5, 1, 1]).unwrap();
    assert_eq!(grid.select_in(&Ball::new(at.into(), 3.0 - 1e-10).unwrap()).len(), 4);
    assert_eq!(grid.select_in(&Ball::new(at.into(), 3.0 - 1e-8).unwrap()).len(), 3);
}
