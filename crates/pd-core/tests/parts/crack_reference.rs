//! Every bond of the reference bodies is cut or left as the independent code says.

use std::{fs, path::Path};

use nalgebra::SVector;
use pd_core::CrackSurface;
use pd_core::crack::{Polygon, Segment, check_clear};
use serde_json::Value;

fn list<const D: usize>(value: &Value) -> [f64; D] {
    std::array::from_fn(|axis| value[axis].as_f64().unwrap())
}

/// Number of bonds compared.
fn compare<const D: usize>(case: &Value, crack: &dyn CrackSurface<D>, file: &Path) -> usize {
    let rows = |name: &str| case[name].as_array().unwrap();
    let x: Vec<SVector<f64, D>> = rows("x").iter().map(|x| list(x).into()).collect();
    check_clear(crack, x.iter().copied(), case["dx"].as_f64().unwrap()).unwrap();
    let index = |value: &Value| value.as_u64().unwrap() as usize;
    let mut cut = 0;
    let bonds = rows("bond_i").iter().zip(rows("bond_j")).zip(rows("bond_live"));
    for ((i, j), live) in bonds {
        let (i, j, live) = (index(i), index(j), index(live));
        assert_eq!(crack.cuts(&x[i], &x[j]), live == 0, "{} bond {i}-{j}", file.display());
        cut += 1 - live;
    }
    assert_eq!(cut, index(&case["number_cut"]));
    assert!(cut > 0);
    rows("bond_i").len()
}

#[test]
fn bonds_of_the_reference_bodies() {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/pd");
    let (mut segments, mut polygons, mut bonds) = (0, 0, 0);
    for entry in fs::read_dir(directory).unwrap() {
        let file = entry.unwrap().path();
        if file.extension().is_none_or(|extension| extension != "json") {
            continue;
        }
        let case: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
        let Some(crack) = case.get("pre_crack") else { continue };
        if let Some(ends) = crack.get("segment") {
            let crack = Segment::new(list(&ends[0]), list(&ends[1])).unwrap();
            bonds += compare(&case, &crack, &file);
            segments += 1;
        } else {
            let [o, e1, e2] = ["origin", "edge1", "edge2"].map(|name| list(&crack[name]));
            let crack = Polygon::parallelogram(o, e1, e2).unwrap();
            bonds += compare(&case, &crack, &file);
            polygons += 1;
        }
    }
    assert_eq!((segments, polygons, bonds), (13, 6, 9383));
}
