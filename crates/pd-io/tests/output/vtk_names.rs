//! Field names come back from the file as they were given.
use super::common;

use common::folder;
use nalgebra::SVector;
use pd_io::{Error, Snapshot};

/// Values of the attribute called `Name`, entities resolved.
fn names(header: &str) -> Vec<String> {
    let raw = header.split(" Name=\"").skip(1).map(|s| s.split('"').next().expect("end"));
    let entities = [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&#9;", "\t"),
        ("&#10;", "\n"),
        ("&#13;", "\r"),
        ("&amp;", "&"),
    ];
    raw.map(|name| {
        assert!(!name.contains(['<', '>', '\n', '\t', '\r']), "raw {name:?}");
        entities.iter().fold(name.to_owned(), |text, (from, to)| text.replace(from, to))
    })
    .collect()
}

fn point() -> Snapshot<2> {
    Snapshot::new(&[SVector::zeros()])
}

#[test]
fn any_text_is_a_name() {
    let path = folder("vtk-names").join("point.vtu");
    let given = ["a<b", "x & y", "say \"u\"", "&lt;", "two\nlines\ttab\r", "σ₁₁ 'max' > 0", " "];
    let snapshot = given.iter().fold(point(), |s, name| s.scalar(name, &[1.0]));
    snapshot.write(&path).expect("file");
    let bytes = std::fs::read(&path).expect("file");
    let end = bytes.windows(4).position(|w| w == b"\"raw").expect("data");
    let header = std::str::from_utf8(&bytes[..end]).expect("text");
    let read = names(header);
    assert!(given.iter().all(|name| read.iter().any(|r| r == name)), "{read:?}");
    assert_eq!(read.len(), given.len() + 4, "points, connectivity, offsets, types");
}

#[test]
fn names_that_cannot_be_told_apart_or_written_are_refused() {
    let path = folder("vtk-refused").join("point.vtu");
    for name in ["", "bell \u{7}", "\u{0}", "\u{ffff}"] {
        let told = point().scalar(name, &[1.0]).write(&path);
        assert!(matches!(told, Err(Error::Name { .. })), "{name:?}: {told:?}");
    }
    let twice = point().scalar("u", &[1.0]).vector("v", &[SVector::zeros()]);
    let told = twice.vector("u", &[SVector::zeros()]).write(&path);
    assert!(matches!(&told, Err(Error::Name { name, .. }) if name == "u"), "{told:?}");
    assert!(!path.exists(), "nothing is written");
}
