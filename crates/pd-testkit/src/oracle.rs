//! Reference bodies computed by independent brute-force codes (`tests/data/README.md`).

use nalgebra::SVector;
use pd_core::crack::{CrackSurface, Polygon, Segment};
use pd_core::grid::Grid;
use pd_core::points::Points;
use pd_core::{Horizon, InfluenceFunction, Quadrature};
use serde_json::Value;
use std::path::Path;

/// A reference body and its results.
pub struct Case {
    /// The file as read.
    pub json: Value,
}

/// Numbers of an array, or of an array of arrays, one after the other.
pub fn flat(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(flat).collect(),
        number => number.as_f64().into_iter().collect(),
    }
}

impl Case {
    /// Reads `tests/data/pd/NAME.json` of the workspace.
    ///
    /// # Panics
    /// If the file is missing or malformed: a test cannot go on without it.
    pub fn read(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/pd");
        let text = std::fs::read_to_string(folder.join(format!("{name}.json")))
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        Self { json: serde_json::from_str(&text).expect("valid JSON") }
    }
    /// A number of the case.
    pub fn number(&self, key: &str) -> f64 {
        self.json[key].as_f64().unwrap_or_else(|| panic!("no number {key}"))
    }
    /// Thickness in 2D, 1 in 3D.
    pub fn thickness(&self) -> f64 {
        self.json["thickness"].as_f64().unwrap_or(1.0)
    }
    /// Reference positions in metres.
    pub fn positions<const D: usize>(&self) -> Vec<SVector<f64, D>> {
        flat(&self.json["x"]).chunks(D).map(SVector::from_column_slice).collect()
    }
    /// The nodes as a cloud.
    pub fn points<const D: usize>(&self) -> Points<D> {
        let volumes = flat(&self.json["V"]).iter().map(|v| v / self.thickness()).collect();
        Points::new(self.positions(), volumes)
            .and_then(|p| p.with_spacing(self.number("dx")))
            .expect("valid nodes")
    }
    /// The nodes as a grid with missing nodes; none for irregular nodes.
    pub fn grid<const D: usize>(&self) -> Option<Grid<D>> {
        if self.json["irregular"].as_bool() == Some(true) {
            return None;
        }
        let (positions, dx) = (self.positions::<D>(), self.number("dx"));
        let low = positions.iter().fold(positions[0], |a, b| a.inf(b));
        let high = positions.iter().fold(positions[0], |a, b| a.sup(b));
        let cells = std::array::from_fn(|d| ((high[d] - low[d]) / dx).round() as usize + 1);
        let there = |x: &SVector<f64, D>| positions.iter().any(|p| (p - x).norm() < 0.1 * dx);
        Grid::lattice(low, SVector::repeat(dx), cells).ok()?.retain(there).ok()
    }
    /// Horizon.
    pub fn horizon(&self) -> Horizon {
        Horizon::Metres(self.number("delta"))
    }
    /// Quadrature weights.
    pub fn quadrature(&self) -> Quadrature {
        match self.json["beta_algorithm"].as_str() {
            Some("one") => Quadrature::None,
            Some("lammps") => Quadrature::LinearRamp,
            Some("hhb") => Quadrature::ExtendedRamp,
            Some("exact") => Quadrature::Exact,
            other => panic!("unknown weights {other:?}"),
        }
    }
    /// Influence function.
    pub fn influence(&self) -> InfluenceFunction {
        match self.json["influence"].as_str().or(self.json["c_shape"].as_str()) {
            Some("gauss") => InfluenceFunction::Gaussian,
            Some("linear" | "conical") => InfluenceFunction::Linear,
            _ => InfluenceFunction::Constant,
        }
    }
    /// The pre-crack of a 2D body.
    pub fn segment(&self) -> Segment {
        let v = flat(&self.json["pre_crack"]["segment"]);
        Segment::new([v[0], v[1]], [v[2], v[3]]).expect("valid crack")
    }
    /// The pre-crack of a 3D body.
    pub fn polygon(&self) -> Polygon {
        let get = |key: &str| -> [f64; 3] {
            flat(&self.json["pre_crack"][key]).try_into().expect("three numbers")
        };
        Polygon::parallelogram(get("origin"), get("edge1"), get("edge2")).expect("valid crack")
    }
    /// A field of a group of results.
    pub fn result(&self, group: &str, field: &str) -> Vec<f64> {
        flat(&self.json["results"][group][field])
    }
    /// Displacements of a group of results.
    pub fn displacement<const D: usize>(&self, group: &str) -> Vec<SVector<f64, D>> {
        self.result(group, "u").chunks(D).map(SVector::from_column_slice).collect()
    }
    /// Number of listed bonds that `crack` classifies otherwise than the reference.
    pub fn misjudged_bonds<const D: usize>(&self, crack: &dyn CrackSurface<D>) -> usize {
        let x = self.positions::<D>();
        let list = |key: &str| flat(&self.json[key]);
        let bonds = list("bond_i").into_iter().zip(list("bond_j")).zip(list("bond_live"));
        bonds
            .filter(|((i, j), live)| crack.cuts(&x[*i as usize], &x[*j as usize]) != (*live == 0.0))
            .count()
    }
}

/// Largest difference over the largest magnitude of the reference.
pub fn relative_difference(got: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(got.len(), reference.len(), "number of values");
    let size = reference.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let worst = got.iter().zip(reference).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    if worst.is_nan() || got.iter().any(|x| x.is_nan()) { f64::NAN } else { worst / size }
}
