//! A write that fails leaves what was there and nothing beside it.
use super::common;

use common::folder;
use nalgebra::SVector;
use pd_io::{Error, LinePlot, Snapshot};
use std::path::Path;

fn point(value: f64) -> Snapshot<2> {
    Snapshot::new(&[SVector::zeros()]).scalar("u", &[value])
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("folder");
    entries.map(|e| e.expect("entry").file_name().to_string_lossy().into_owned()).collect()
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_file_before() {
    let place = folder("full");
    let path = place.join("point.vtu");
    point(1.0).write(&path).expect("file");
    let before = std::fs::read(&path).expect("file");
    // What is written beside the file goes to the device that is always full.
    std::os::unix::fs::symlink("/dev/full", place.join("point.vtu.part")).expect("link");
    let told = point(2.0).write(&path);
    let full = |e: &Error| matches!(e, Error::File { source, .. } if source.kind() == std::io::ErrorKind::StorageFull);
    assert!(told.as_ref().is_err_and(full), "{told:?}");
    assert_eq!(std::fs::read(&path).expect("file"), before);
    assert_eq!(names(&place), ["point.vtu"]);
    point(2.0).write(&path).expect("file");
    assert_ne!(std::fs::read(&path).expect("file"), before);
}

#[test]
fn a_place_that_is_taken_leaves_nothing_beside() {
    let place = folder("taken");
    let path = place.join("folder");
    std::fs::create_dir(&path).expect("folder");
    std::fs::write(path.join("inside"), "x").expect("file");
    let chart = LinePlot::new("", "", "").line("", &[(0.0, 0.0)]);
    for told in [point(1.0).write(&path), chart.write(&path)] {
        assert!(matches!(&told, Err(Error::File { path: p, .. }) if *p == path), "{told:?}");
        assert_eq!(names(&place), ["folder"]);
        assert_eq!(names(&path), ["inside"]);
    }
}

#[test]
fn folders_are_made_and_may_be_the_current_one() {
    let place = folder("deep");
    let path = place.join("a/b/point.vtu");
    point(1.0).write(&path).expect("file");
    assert!(path.is_file());
    let here = format!("pd-io-{}.vtu", std::process::id());
    point(1.0).write(&here).expect("file");
    std::fs::remove_file(&here).expect("file");
}
