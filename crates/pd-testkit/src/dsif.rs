//! Dynamic stress intensity of a crack along y = 0: what the studies of Hattori §6.1 and §6.3 share.

use nalgebra::SVector;
use pd_core::Grid;
use pd_models::Intensity;

/// u(upper face) − u(lower face) at x: between the rows of nodes next to y = 0.
///
/// # Panics
/// If there are no nodes there.
pub fn opening(grid: &Grid<2>, u: impl Fn(usize) -> SVector<f64, 2>, x: f64) -> SVector<f64, 2> {
    let place = (SVector::from([x, 0.0]) - grid.origin()).component_div(grid.spacing());
    let (column, row) = (place[0].floor(), place[1].ceil() as usize);
    let part = place[0] - column;
    let at = |row: usize| {
        let own = |k: f64| u(grid.node([k as usize, row]).expect("nodes beside the crack"));
        own(column) * (1.0 - part) + own(column + 1.0) * part
    };
    at(row) - at(row - 1)
}

/// A history at other times, linear between its samples.
pub fn at_times(samples: &[(f64, Intensity)], times: &[f64]) -> Vec<Intensity> {
    let at = |&t: &f64| {
        let next = samples.partition_point(|s| s.0 < t).clamp(1, samples.len() - 1);
        let ((t0, a), (t1, b)) = (samples[next - 1], samples[next]);
        let part = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
        Intensity { i: a.i + (b.i - a.i) * part, ii: a.ii + (b.ii - a.ii) * part }
    };
    times.iter().map(at).collect()
}

/// Hattori Eq. 38 for K_I and K_II: root of summed squared differences over summed squares.
pub fn errors(got: &[Intensity], reference: &[Intensity]) -> (f64, f64) {
    let norm = |pick: fn(&Intensity) -> f64| {
        let pairs = got.iter().zip(reference);
        let apart: f64 = pairs.map(|(a, b)| (pick(a) - pick(b)).powi(2)).sum();
        (apart / reference.iter().map(|b| pick(b).powi(2)).sum::<f64>()).sqrt()
    };
    (norm(|k| k.i), norm(|k| k.ii))
}

/// Points (t in µs, K in MPa√m) of a history.
pub fn curve(times: &[f64], k: &[Intensity], pick: fn(&Intensity) -> f64) -> Vec<(f64, f64)> {
    times.iter().zip(k).map(|(t, k)| (t * 1e6, pick(k) / 1e6)).collect()
}
