//! A series holds the steps that succeeded, and whole files only.
use super::common;

use common::folder;
use nalgebra::SVector;
use pd_io::{Error, Series, Snapshot};
use std::path::Path;

fn point() -> Snapshot<3> {
    Snapshot::new(&[SVector::zeros()]).scalar("u", &[1.0])
}

/// Times and files in the index; every file of the folder is whole.
fn steps(folder: &Path, series: &Series) -> Vec<(f64, String)> {
    for entry in std::fs::read_dir(folder).expect("folder") {
        let bytes = std::fs::read(entry.expect("entry").path()).expect("file");
        assert!(bytes.ends_with(b"</VTKFile>\n"), "a file is cut");
    }
    let index = std::fs::read_to_string(series.path()).expect("index");
    let value = |line: &str, name: &str| {
        let start = line.split(&format!("{name}=\"")).nth(1).expect("attribute");
        start.split('"').next().expect("end").to_owned()
    };
    let entries = index.lines().filter(|line| line.contains("<DataSet"));
    let read = entries.map(|line| (value(line, "timestep").parse().unwrap(), value(line, "file")));
    let read: Vec<_> = read.collect();
    assert!(read.iter().all(|(_, file)| folder.join(file).is_file()), "{read:?}");
    read
}

#[test]
fn times_increase() {
    let place = folder("times");
    let mut series = Series::create(&place, "plate").expect("series");
    assert_eq!(steps(&place, &series), []);
    series.write(1e-6, &point()).expect("step");
    for time in [1e-6, 0.0, -1.0] {
        let told = series.write(time, &point());
        let same = matches!(told, Err(Error::Time { time: t, last: 1e-6, .. }) if t == time);
        assert!(same, "{told:?}");
    }
    for time in [f64::NAN, f64::INFINITY] {
        let told = series.write(time, &point());
        assert!(matches!(told, Err(Error::NotFinite { node: 1, .. })), "{told:?}");
    }
    series.write(2e-6, &point()).expect("step");
    let wanted = [(1e-6, "plate_000000.vtu".to_owned()), (2e-6, "plate_000001.vtu".to_owned())];
    assert_eq!(steps(&place, &series), wanted);
}

#[test]
fn names_are_plain_file_names() {
    let place = folder("series-names");
    for name in ["", "a/b", "/", "..\\b", "a\nb", "a\0"] {
        let told = Series::create(&place, name);
        assert!(matches!(told, Err(Error::Name { .. })), "{name:?}: {told:?}");
    }
    assert_eq!(std::fs::read_dir(&place).expect("folder").count(), 0);
    let series = Series::create(&place, "K < 1 & \"more\"");
    let mut series = series.expect("series");
    series.write(0.0, &point()).expect("step");
    let index = std::fs::read_to_string(series.path()).expect("index");
    assert!(index.contains("file=\"K &lt; 1 &amp; &quot;more&quot;_000000.vtu\""), "{index}");
}

#[test]
fn a_step_that_is_not_in_the_index_does_not_count() {
    let place = folder("index");
    let mut series = Series::create(&place, "plate").expect("series");
    series.write(0.0, &point()).expect("step");
    let before = steps(&place, &series);
    // Where the index is to be written there is a folder.
    let obstacle = place.join("plate.pvd.part");
    std::fs::create_dir(&obstacle).expect("obstacle");
    let told = series.write(1.0, &point());
    assert!(matches!(told, Err(Error::File { .. })), "{told:?}");
    std::fs::remove_dir(&obstacle).expect("obstacle");
    assert_eq!(steps(&place, &series), before);
    // The same time again is no repetition, and no number is left out.
    series.write(1.0, &point()).expect("step");
    assert_eq!(steps(&place, &series)[1], (1.0, "plate_000001.vtu".to_owned()));
}
