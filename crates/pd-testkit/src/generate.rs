//! Grids, clouds and stiffnesses at random, for property tests.

use nalgebra::{Matrix3, Matrix6, SMatrix, SVector};
use pd_core::points::Points;
use pd_core::region::{Ball, Cuboid, Disc, Shape};
use pd_core::{Grid, Result};
use pd_models::Stiffness;
use proptest::prelude::*;

/// Numbers in (−1, 1), the same for the same seed.
pub fn noise(seed: u64, i: usize) -> f64 {
    let mut x = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (i as u64).wrapping_add(0x632b_e59b);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A block of nodes moved up to `jitter` Δx off the places of a lattice along every axis, with
/// volumes spread evenly (in their logarithms) over a factor `spread` around Δx^D.
///
/// # Errors
/// As [`Points::new`].
pub fn cloud<const D: usize>(
    cells: [usize; D],
    spacing: f64,
    jitter: f64,
    spread: f64,
    seed: u64,
) -> Result<Points<D>> {
    let count = cells.iter().product();
    let place = |node: usize| {
        let mut rest = node;
        SVector::from_fn(|d, _| {
            let cell = rest % cells[d];
            rest /= cells[d];
            spacing * (cell as f64 + jitter * noise(seed, D * node + d))
        })
    };
    let cell = spacing.powi(D as i32);
    let volume = |node| cell * spread.powf(0.5 * noise(seed ^ 0xff, node));
    Points::new((0..count).map(place).collect(), (0..count).map(volume).collect())?
        .with_spacing(spacing)
}

/// [`cloud`]s of 5 to 8 nodes (in 3D 4 or 5) along every axis.
pub fn clouds<const D: usize>(
    spacing: f64,
    jitter: f64,
    spread: f64,
) -> impl Strategy<Value = Points<D>> {
    let range = if D == 3 { 4..6_usize } else { 5..9 };
    (prop::collection::vec(range, D), any::<u64>()).prop_filter_map(
        "two nodes at one place",
        move |(cells, seed)| {
            cloud(std::array::from_fn(|d| cells[d]), spacing, jitter, spread, seed).ok()
        },
    )
}

/// Boxes of 8 to 14 cells along both axes with a hole anywhere.
pub fn plates(spacing: f64) -> impl Strategy<Value = Grid<2>> {
    (8.0..14.0, 8.0..14.0, -3.0..3.0, 0.6..2.6_f64).prop_filter_map(
        "no cell left",
        move |(a, b, x, r): (f64, f64, f64, f64)| {
            let hole = Disc::new([x * spacing, 0.0], r * spacing).ok()?;
            let shape = Cuboid::centred([a * spacing, b * spacing]).ok()?;
            Grid::new(&shape.without(hole), spacing).ok()
        },
    )
}

/// Boxes of 6 to 9 cells along every axis with a hole anywhere.
pub fn blocks(spacing: f64) -> impl Strategy<Value = Grid<3>> {
    (6.0..9.0, 6.0..9.0, -2.0..2.0, 0.9..1.9_f64).prop_filter_map(
        "no cell left",
        move |(a, b, x, r): (f64, f64, f64, f64)| {
            let hole = Ball::new([x * spacing, 0.0, 0.0], r * spacing).ok()?;
            let shape = Cuboid::centred([a * spacing, b * spacing, a * spacing]).ok()?;
            Grid::new(&shape.without(hole), spacing).ok()
        },
    )
}

/// The symmetric matrix with these eigenvalues and random axes: those of the QR factor of noise.
fn voigt<const V: usize>(
    values: &[f64],
    q: &SMatrix<f64, V, V>,
    normal: usize,
) -> SMatrix<f64, V, V> {
    let mandel = q * SMatrix::from_diagonal(&SVector::from_fn(|i, _| values[i])) * q.transpose();
    // Mandel to Voigt: shears count √2 times.
    let factor = |i: usize| if i < normal { 1.0 } else { std::f64::consts::FRAC_1_SQRT_2 };
    SMatrix::from_fn(|i, j| 0.5 * (mandel[(i, j)] + mandel[(j, i)]) * factor(i) * factor(j))
}

/// Eigenvalues from `size` down to `size`/`ratio`, both ends among them.
fn eigenvalues(size: f64, ratio: f64, count: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(0.0..1.0_f64, count).prop_map(move |mut powers| {
        (powers[0], powers[1]) = (0.0, 1.0);
        powers.into_iter().map(|p| size * ratio.powf(-p)).collect()
    })
}

/// Plane stiffnesses of any symmetry whose largest eigenvalue is `size` in Pa and whose condition
/// number is `ratio`.
pub fn plane_stiffnesses(size: f64, ratio: f64) -> impl Strategy<Value = Stiffness<2>> {
    (eigenvalues(size, ratio, 3), any::<u64>()).prop_filter_map(
        "not definite to rounding",
        |(values, seed)| {
            let q = Matrix3::from_fn(|i, j| noise(seed, 3 * i + j)).qr().q();
            Stiffness::<2>::from_voigt(voigt(&values, &q, 2)).ok()
        },
    )
}

/// As [`plane_stiffnesses`], in space.
pub fn solid_stiffnesses(size: f64, ratio: f64) -> impl Strategy<Value = Stiffness<3>> {
    (eigenvalues(size, ratio, 6), any::<u64>()).prop_filter_map(
        "not definite to rounding",
        |(values, seed)| {
            let q = Matrix6::from_fn(|i, j| noise(seed, 6 * i + j)).qr().q();
            Stiffness::<3>::from_voigt(voigt(&values, &q, 3)).ok()
        },
    )
}
