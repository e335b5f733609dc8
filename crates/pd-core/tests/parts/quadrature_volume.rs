//! Exact β: the cells of a lattice fill the disc and the ball, caps have their closed form, and
//! reflections and permutations change no bit.
use approx::assert_relative_eq;
use nalgebra::{SVector, Vector1, Vector2, Vector3};
use pd_core::Quadrature::{self, Exact};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Σβ over the lattice shifted by `shift`, times the volume of a cell.
fn covered<const D: usize>(cell: SVector<f64, D>, shift: SVector<f64, D>, radius: f64) -> f64 {
    let reach = Exact.reach(&cell, radius);
    let count = cell.map(|edge| (reach / edge) as i64 + 1);
    let offsets = count.map(|n| (2 * n + 1) as usize);
    let sum: f64 = (0..offsets.product())
        .map(|code| {
            let mut rest = code;
            let xi = SVector::from_fn(|k, _| {
                let n = (rest % offsets[k]) as i64 - count[k];
                rest /= offsets[k];
                (n as f64 + shift[k]) * cell[k]
            });
            Exact.weight(&xi, &cell, radius)
        })
        .sum();
    sum * cell.product()
}

#[test]
fn the_cells_of_a_lattice_fill_the_horizon() {
    for m in [0.3, 1.0, 2.0, 2.5, 3.015, 4.7, 10.0, 31.6] {
        let area = covered(Vector2::repeat(1.0), Vector2::zeros(), m);
        assert_relative_eq!(area, PI * m * m, max_relative = 1e-12);
    }
    for m in [0.3, 1.0, 2.0, 2.5, 3.015, 4.7, 6.0] {
        let volume = covered(Vector3::repeat(1.0), Vector3::zeros(), m);
        assert_relative_eq!(volume, 4.0 / 3.0 * PI * m.powi(3), max_relative = 1e-12);
    }
    assert_relative_eq!(covered(Vector1::new(0.7), Vector1::new(0.2), 3.0), 6.0, epsilon = 1e-12);
}

#[test]
fn a_wide_cell_holds_a_cap() {
    let (radius, depth) = (2.0, 0.3);
    let cell = Vector3::new(10.0, 12.0, 4.0);
    let cap = PI * depth * depth * (3.0 * radius - depth) / 3.0;
    let beta = Exact.weight(&Vector3::new(0.0, 0.0, 3.7), &cell, radius);
    assert_relative_eq!(beta * cell.product(), cap, max_relative = 1e-12);
    let half_angle = ((radius - depth) / radius).acos();
    let segment = radius * radius * (half_angle - half_angle.sin() * half_angle.cos());
    let cell = Vector2::new(4.0, 10.0);
    let beta = Exact.weight(&Vector2::new(-3.7, 0.0), &cell, radius);
    assert_relative_eq!(beta * cell.product(), segment, max_relative = 1e-12);
}

#[test]
fn a_cell_that_only_touches_makes_no_bond() {
    for m in [1.5, 2.5, 3.5] {
        let dx = 0.1;
        let beta =
            Exact.weight(&Vector3::new((m + 0.5) * dx, 0.0, 0.0), &Vector3::repeat(dx), m * dx);
        assert_eq!(beta, 0.0);
    }
}

#[test]
fn a_neighbour_at_the_horizon_counts_whatever_the_rounding() {
    let cell = Vector2::repeat(1.0);
    for (quadrature, beta) in [(Quadrature::None, 1.0), (Quadrature::LinearRamp, 0.5)] {
        for xi in [3.0, 3.0 + 1e-12, 3.0 - 1e-12] {
            assert_relative_eq!(
                quadrature.weight(&Vector2::new(0.0, xi), &cell, 3.0),
                beta,
                epsilon = 1e-9
            );
        }
        assert_eq!(quadrature.weight(&Vector2::new(0.0, 3.0 + 1e-7), &cell, 3.0), 0.0);
    }
}

#[test]
fn a_ramp_takes_the_edge_along_the_bond() {
    let cell = Vector2::new(1.0, 0.5);
    let beta = |x, y| Quadrature::ExtendedRamp.weight(&Vector2::new(x, y), &cell, 3.0);
    assert_eq!((beta(3.25, 0.0), beta(0.0, 3.125)), (0.25, 0.25));
    assert_eq!((beta(3.5, 0.0), beta(0.0, 3.25), beta(0.0, 0.0)), (0.0, 0.0, 1.0));
}

proptest! {
    #[test]
    fn any_boxes_fill_the_disc(
        edges in [0.2..2.0, 0.2..2.0], shift in [-0.5..0.5, -0.5..0.5], radius in 0.1..4.0,
    ) {
        let area = covered(Vector2::from(edges), Vector2::from(shift), radius);
        prop_assert!((area / (PI * radius * radius) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn any_boxes_fill_the_ball(
        edges in [0.4..2.0, 0.4..2.0, 0.4..2.0], shift in [-0.5..0.5, -0.5..0.5, -0.5..0.5],
        radius in 0.1..2.5,
    ) {
        let volume = covered(Vector3::from(edges), Vector3::from(shift), radius);
        prop_assert!((volume / (4.0 / 3.0 * PI * radius.powi(3)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn reflections_and_permutations_change_no_bit(
        x in -4.0..4.0, y in -4.0..4.0, z in -4.0..4.0, edge in 0.5..2.0,
    ) {
        let xi = Vector3::new(x, y, z);
        let cell = Vector3::new(edge, 1.0, 0.8);
        for quadrature in
            [Quadrature::None, Quadrature::LinearRamp, Quadrature::ExtendedRamp, Exact]
        {
            let beta = quadrature.weight(&xi, &cell, 3.0);
            prop_assert!((0.0..=1.0).contains(&beta));
            prop_assert_eq!(beta, quadrature.weight(&-xi, &cell, 3.0));
            prop_assert_eq!(beta, quadrature.weight(&Vector3::new(x, -y, z), &cell, 3.0));
        }
        let turned = Exact.weight(&xi.zxy(), &cell.zxy(), 3.0);
        prop_assert_eq!(Exact.weight(&xi, &cell, 3.0), turned);
    }
}
