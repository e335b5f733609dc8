//! Histories and series go on where a checkpoint was written: what came later goes, with it a row
//! that was cut short.
use super::common;
use nalgebra::SVector;
use pd_io::{Error, History, Series, Snapshot};

#[test]
fn history() {
    let path = common::folder("resumed_history").join("history.csv");
    let columns = ["time [s]", "force, total [N]"];
    let write = |history: &mut History, times: std::ops::Range<usize>| {
        times.for_each(|i| history.row(&[i as f64 * 0.1, (i * i) as f64]).expect("row"));
    };
    write(&mut History::create(&path, &columns).expect("table"), 0..9);
    let whole = std::fs::read_to_string(&path).expect("text");
    std::fs::write(&path, format!("{whole}9e-1,8")).expect("cut row");
    write(&mut History::resume(&path, &columns, 5.0 * 0.1).expect("goes on"), 6..9);
    assert_eq!(std::fs::read_to_string(&path).expect("text"), whole);
    let other = History::resume(&path, &["time [s]", "force [N]"], 0.5).expect_err("other columns");
    assert!(matches!(other, Error::Unfit { .. }), "{other:?}");
    assert_eq!(std::fs::read_to_string(&path).expect("text"), whole, "left alone");
}

#[test]
fn series() {
    let folder = common::folder("resumed_series");
    let snapshot = Snapshot::<2>::new(&[SVector::zeros()]);
    let write = |series: &mut Series, times: std::ops::Range<usize>| {
        times.for_each(|i| series.write(i as f64 * 0.1, &snapshot).expect("step"));
    };
    let mut series = Series::create(&folder, "plate").expect("series");
    write(&mut series, 0..5);
    let whole = std::fs::read_to_string(series.path()).expect("index");
    let mut again = Series::resume(&folder, "plate", 2.0 * 0.1).expect("goes on");
    assert_eq!(
        std::fs::read_to_string(series.path()).expect("index").matches("<DataSet").count(),
        3
    );
    write(&mut again, 3..5);
    assert_eq!(std::fs::read_to_string(series.path()).expect("index"), whole);
    assert!(again.write(0.3, &snapshot).is_err(), "times go on increasing");
    let missing = Series::resume(&folder, "beam", 0.2).expect_err("missing");
    assert!(matches!(missing, Error::Unreadable { .. }), "{missing:?}");
}
