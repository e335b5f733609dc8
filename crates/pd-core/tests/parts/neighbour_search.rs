//! The cell list against the naive search, for any cloud and any number of threads.
use nalgebra::{SVector, Vector1, Vector2, Vector3};
use pd_core::search::TOLERANCE;
use pd_core::{Rows, neighbours};
use proptest::prelude::*;

fn naive<const D: usize>(x: &[SVector<f64, D>], radii: &[f64]) -> Rows {
    let mut rows = Rows { start: vec![0], neighbour: vec![] };
    for i in 0..x.len() {
        for j in 0..x.len() {
            let reach = radii[i].max(radii[j]) * (1.0 + TOLERANCE);
            if i != j && reach > 0.0 && (x[j] - x[i]).norm_squared() <= reach.powi(2) {
                rows.neighbour.push(j as u32);
            }
        }
        rows.start.push(rows.neighbour.len());
    }
    rows
}

fn lattice<const D: usize>(side: usize, dx: f64, origin: f64) -> Vec<SVector<f64, D>> {
    let coordinate =
        |code: usize, k: usize| (code / side.pow(k as u32) % side) as f64 * dx + origin;
    (0..side.pow(D as u32)).map(|code| SVector::from_fn(|k, _| coordinate(code, k))).collect()
}

/// Clouds of one, two and three scales far apart, with coincident points.
fn cloud<const D: usize>() -> impl Strategy<Value = Vec<SVector<f64, D>>> {
    let component = prop_oneof![
        8 => -3.0..3.0_f64,
        2 => Just(0.5),
        2 => (-3.0..3.0_f64).prop_map(|x| 1e5 + 0.1 * x),
        1 => (-1.0..1.0_f64).prop_map(|x| 1e9 * x),
    ];
    prop::collection::vec(prop::collection::vec(component, D), 0..120)
        .prop_map(|points| points.into_iter().map(SVector::from_vec).collect())
}

/// One radius, or radii over three decades, none among them.
fn radii() -> impl Strategy<Value = Vec<f64>> {
    let graded = prop_oneof![
        1 => Just(0.0),
        9 => (-3.0..0.5_f64).prop_map(|e| 10_f64.powf(e)),
    ];
    prop_oneof![(0.05..2.0_f64).prop_map(|r| vec![r; 120]), prop::collection::vec(graded, 120),]
}

proptest! {
    #[test]
    fn rows_are_those_of_the_naive_search_1d(x in cloud::<1>(), r in radii()) {
        prop_assert_eq!(neighbours(&x, |i| r[i]), naive(&x, &r));
    }

    #[test]
    fn rows_are_those_of_the_naive_search_2d(x in cloud::<2>(), r in radii()) {
        prop_assert_eq!(neighbours(&x, |i| r[i]), naive(&x, &r));
    }

    #[test]
    fn rows_are_those_of_the_naive_search_3d(x in cloud::<3>(), r in radii()) {
        prop_assert_eq!(neighbours(&x, |i| r[i]), naive(&x, &r));
    }
}

#[test]
fn lattice_points_exactly_at_the_horizon_count() {
    for (dx, origin) in [(0.1, 0.0), (1e-3, 0.37), (1.0 / 3.0, -1e3)] {
        let x: Vec<Vector3<f64>> = lattice(9, dx, origin);
        let rows = neighbours(&x, |_| 3.0 * dx);
        let centre = 4 + 9 * (4 + 9 * 4);
        assert_eq!(rows.row(centre).len(), 122);
        assert_eq!(rows, naive(&x, &vec![3.0 * dx; x.len()]));
    }
}

#[test]
fn a_graded_lattice_sees_both_ways() {
    let x: Vec<Vector2<f64>> = lattice(30, 1.0, 0.0);
    let radius = |i: usize| if i % 30 < 15 { 1.0 } else { 3.0 };
    let rows = neighbours(&x, radius);
    let radii: Vec<f64> = (0..x.len()).map(radius).collect();
    assert_eq!(rows, naive(&x, &radii));
    assert!(rows.row(13 + 30 * 15).contains(&(16 + 30 * 15)));
    for i in 0..x.len() {
        assert!(rows.row(i).iter().all(|&j| rows.row(j as usize).contains(&(i as u32))));
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let x: Vec<Vector3<f64>> = (0..20_000_u32)
        .map(|i| Vector3::new(0.618, 0.755, 0.569).map(|g| (f64::from(i) * g).fract() * 20.0))
        .collect();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| neighbours(&x, |i| if i % 7 == 0 { 1.9 } else { 0.8 }))
    };
    let one = run(1);
    assert!(one.neighbour.len() > 10 * x.len());
    assert_eq!(run(2), one);
    assert_eq!(run(3), one);
}

/// Each of these would take hours, or all memory, with a dense grid or with cells of one size.
#[test]
fn strays_clusters_and_steep_grading_cost_nothing() {
    let mut x: Vec<Vector3<f64>> = lattice(40, 1e-6, 0.0);
    let bulk = neighbours(&x, |_| 2e-6);
    x.extend([1e3, -1e300, f64::MAX].map(Vector3::repeat));
    x.push(Vector3::new(f64::NAN, 0.0, 0.0));
    x.push(Vector3::new(0.0, f64::INFINITY, 0.0));
    let rows = neighbours(&x, |_| 2e-6);
    assert_eq!(rows.neighbour, bulk.neighbour);
    assert_eq!(rows.start.len(), x.len() + 1);

    // Distances grow with the index, from 1 µm to 10 km, and the radii with them.
    let x: Vec<Vector1<f64>> =
        (0..100_000).map(|i| Vector1::new(1e-6 * 10_f64.powf(f64::from(i) * 1e-4))).collect();
    let rows = neighbours(&x, |i| 2.5e-4 * x[i].x);
    assert_eq!(rows.row(50_000), [49_999, 50_001]);
}

#[test]
fn no_points_and_no_radii_give_empty_rows() {
    assert_eq!(neighbours::<2>(&[], |_| 1.0), Rows { start: vec![0], neighbour: vec![] });
    let x = vec![Vector2::new(1.0, 2.0); 100_000];
    for radius in [0.0, -1.0, f64::NAN] {
        let rows = neighbours(&x, |_| radius);
        assert!(rows.neighbour.is_empty() && rows.start.len() == x.len() + 1);
    }
}
