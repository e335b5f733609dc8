//! Every error names the file, the field and the node.
use super::common;

use common::folder;
use nalgebra::SVector;
use pd_io::{FieldMap, History, LinePlot, PolarPlot, Result, Series, Snapshot};
use std::path::Path;

fn check(path: &Path, told: Result<()>, words: &[&str]) {
    let text = told.expect_err("refused").to_string();
    assert!(text.contains(&path.display().to_string()), "no file in '{text}'");
    for word in words {
        assert!(text.contains(word), "no '{word}' in '{text}'");
    }
}

#[test]
fn errors_name_file_field_and_node() {
    let place = folder("errors");
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let three = [0.0, 1.0, 2.0].map(|x| SVector::<f64, 2>::from([x, 0.0]));
    let mut bad = three;
    bad[1].y = inf;

    let vtu = place.join("plate.vtu");
    let plate = || Snapshot::new(&three);
    check(&vtu, plate().scalar("damage", &[0.0, 0.0, nan]).write(&vtu), &["damage", "node 2"]);
    check(&vtu, plate().vector("velocity", &bad).write(&vtu), &["velocity", "node 1", "inf"]);
    check(&vtu, Snapshot::new(&bad).write(&vtu), &["position", "node 1"]);
    check(&vtu, plate().scalar("damage", &[0.0]).write(&vtu), &["damage", "1 values for 3"]);
    check(&vtu, plate().vector("v", &three[..2]).write(&vtu), &["'v'", "2 values for 3"]);
    let twice = plate().vector("v", &three).vector("v", &three);
    check(&vtu, twice.write(&vtu), &["\"v\""]);

    let png = place.join("map.png");
    let map = |at: &[SVector<f64, 2>], values: &[f64]| FieldMap::new(at, 1.0, values).title("v_y");
    check(&png, map(&three, &[0.0, nan, 0.0]).write(&png), &["v_y", "node 1", "NaN"]);
    check(&png, map(&bad, &[0.0; 3]).write(&png), &["position", "node 1"]);
    check(&png, map(&three, &[0.0; 4]).write(&png), &["v_y", "4 values for 3"]);
    check(&png, map(&three, &[0.0; 3]).range(2.0, 1.0).write(&png), &["from 2 to 1"]);
    check(&png, FieldMap::new(&three, -1.5, &[0.0; 3]).write(&png), &["-1.5"]);
    check(&png, map(&[], &[]).write(&png), &["node"]);

    let line = |points: &[(f64, f64)]| LinePlot::new("", "h [m]", "error").line("L2", points);
    let points = [(1.0, 1.0), (0.0, nan)];
    check(&png, line(&points).write(&png), &["L2", "error", "node 1", "NaN"]);
    check(&png, line(&[(inf, 0.0)]).write(&png), &["L2", "h [m]", "node 0", "inf"]);
    let points = [(1.0, 1.0), (0.5, -2.0)];
    check(&png, line(&points).log_log().write(&png), &["L2", "error", "node 1", "-2"]);
    check(&png, line(&[]).write(&png), &["point"]);

    let curve = |points: &[(f64, f64)]| PolarPlot::new("", "").curve("E", points);
    check(&png, curve(&[(0.0, 1.0), (1.0, -3.0)]).write(&png), &["'E'", "node 1", "-3"]);
    check(&png, curve(&[(0.0, 1.0), (nan, 1.0)]).write(&png), &["'E'", "node 1", "NaN"]);
    check(&png, curve(&[]).write(&png), &["point"]);

    let csv = place.join("history.csv");
    let mut history = History::create(&csv, &["time [s]", "force [N]"]).expect("file");
    history.row(&[0.0, 0.0]).expect("row");
    check(&csv, history.row(&[1.0, nan]), &["force [N]", "node 1", "NaN"]);
    check(&csv, history.row(&[1.0]), &["force [N]", "1 values for 2"]);

    let mut series = Series::create(&place, "plate").expect("series");
    let pvd = series.path();
    check(&pvd, series.write(nan, &plate()), &["time", "node 0", "NaN"]);
    series.write(1.0, &plate()).expect("step");
    check(&pvd, series.write(0.5, &plate()), &["0.5", "1 s"]);
    let step = place.join("plate_000001.vtu");
    check(&step, series.write(2.0, &plate().scalar("T", &[nan; 3])), &["'T'", "node 0"]);
    check(&place, Series::create(&place, "a/b").map(drop), &["a/b"]);

    // A folder that cannot be made: part of the way is a file.
    let under = csv.join("plate.vtu");
    check(&under, plate().write(&under), &[]);
}
