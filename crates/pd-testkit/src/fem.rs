//! Displacement fields of finite elements (`tests/data/fem`), and how far a body is from them.

use nalgebra::SVector;
use pd_core::grid::Grid;
use std::collections::HashMap;
use std::path::Path;

/// The columns of a table `tests/data/fem/NAME.csv` of the workspace, by name.
///
/// # Panics
/// If the file is missing or malformed: a study cannot go on without it.
pub fn table(name: &str) -> HashMap<String, Vec<f64>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/fem");
    let text = std::fs::read_to_string(folder.join(format!("{name}.csv")))
        .unwrap_or_else(|e| panic!("{name}: {e}"));
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().expect("a head line").split(',').collect();
    let mut columns: HashMap<String, Vec<f64>> =
        names.iter().map(|&name| (name.to_owned(), Vec::new())).collect();
    for line in lines {
        for (name, cell) in names.iter().zip(line.split(',')) {
            columns.entry((*name).to_owned()).or_default().push(cell.parse().expect("a number"));
        }
    }
    columns
}

/// A displacement field at points, both in metres.
pub struct Displacements<const D: usize> {
    /// Points.
    pub points: Vec<SVector<f64, D>>,
    /// Displacements there.
    pub u: Vec<SVector<f64, D>>,
}

impl<const D: usize> Displacements<D> {
    /// From a table with the columns x, y (, z) and those named.
    ///
    /// # Panics
    /// As [`table`].
    pub fn read(name: &str, columns: [&str; D]) -> Self {
        let table = table(name);
        let vectors = |names: [&str; D]| -> Vec<SVector<f64, D>> {
            let rows = table[names[0]].len();
            (0..rows).map(|i| SVector::from_fn(|d, _| table[names[d]][i])).collect()
        };
        let axes = std::array::from_fn(|d| ["x", "y", "z"][d]);
        Self { points: vectors(axes), u: vectors(columns) }
    }

    /// Scabbia Eqs. 51, 52 at every point: |u − u_FEM| / max |u_FEM|, with the field `u` of the
    /// nodes of `grid` interpolated between them.
    pub fn differences(&self, grid: &Grid<D>, u: impl Fn(usize) -> SVector<f64, D>) -> Vec<f64> {
        let largest = self.u.iter().map(|u| u.norm()).fold(0.0, f64::max);
        let apart = |(x, fem): (&SVector<f64, D>, &SVector<f64, D>)| {
            (interpolate(grid, &u, x) - fem).norm() / largest
        };
        self.points.iter().zip(&self.u).map(apart).collect()
    }
}

/// The multilinear interpolation of a nodal field at `x`; where a node is missing beside a hole or
/// edge, the others share its weight.
pub fn interpolate<const D: usize>(
    grid: &Grid<D>,
    u: impl Fn(usize) -> SVector<f64, D>,
    x: &SVector<f64, D>,
) -> SVector<f64, D> {
    let place = (x - grid.origin()).component_div(grid.spacing());
    let (mut sum, mut total) = (SVector::zeros(), 0.0);
    for corner in 0..1_usize << D {
        let mut weight = 1.0;
        let cell = std::array::from_fn(|d| {
            let low = (place[d] + 1e-9).floor();
            let part = (place[d] - low).max(0.0);
            let up = corner >> d & 1;
            weight *= if up == 1 { part } else { 1.0 - part };
            (low.max(0.0) as usize) + up
        });
        if let Some(node) = grid.node(cell).filter(|_| weight > 1e-6) {
            sum += u(node) * weight;
            total += weight;
        }
    }
    if total > 0.0 { sum / total } else { u(grid.nearest(x)) }
}
