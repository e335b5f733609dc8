//! Files say what was put in and appear whole.
use super::common;

use common::{Image, folder};
use nalgebra::{SMatrix, SVector};
use pd_io::{ColourMap, Error, FieldMap, History, Series, Snapshot};

/// Numbers of the appended array called `name`.
fn array(bytes: &[u8], name: &str) -> Vec<f64> {
    let marker = b"<AppendedData encoding=\"raw\">\n_";
    let at = bytes.windows(marker.len()).position(|w| w == marker).expect("data") + marker.len();
    let header = std::str::from_utf8(&bytes[..at]).expect("text");
    let line = header.lines().find(|l| l.contains(&format!("Name=\"{name}\""))).expect("array");
    let offset: usize =
        line.split("offset=\"").nth(1).and_then(|s| s.split('"').next()).unwrap().parse().unwrap();
    let data = &bytes[at + offset..];
    let length = u64::from_le_bytes(data[..8].try_into().unwrap()) as usize;
    data[8..8 + length].chunks(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect()
}

#[test]
fn a_series_holds_the_fields_bit_by_bit() {
    let place = folder("series");
    let positions = [SVector::<f64, 2>::new(0.1, 0.2), SVector::<f64, 2>::new(1.0 / 3.0, -7e-9)];
    let stress = [SMatrix::<f64, 2, 2>::new(1.0, 2.0, 3.0, 4.0), SMatrix::identity()];
    let snapshot = Snapshot::new(&positions)
        .scalar("damage", &[0.5, 1e-300])
        .vector("displacement", &positions)
        .tensor("stress", &stress);
    let mut series = Series::create(&place, "plate").expect("series");
    for time in [0.0, 1.5e-6] {
        series.write(time, &snapshot).expect("step");
        let index = std::fs::read_to_string(series.path()).expect("index");
        assert!(index.contains(&format!("timestep=\"{time:e}\"")), "{index}");
    }
    let bytes = std::fs::read(place.join("plate_000001.vtu")).expect("file");
    assert_eq!(array(&bytes, "points"), [0.1, 0.2, 0.0, 1.0 / 3.0, -7e-9, 0.0]);
    assert_eq!(array(&bytes, "damage"), [0.5, 1e-300]);
    assert_eq!(array(&bytes, "stress")[..9], [1.0, 2.0, 0.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
    let left: Vec<_> = std::fs::read_dir(&place).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert!(left.iter().all(|f| !f.to_string_lossy().ends_with(".part")), "{left:?}");
}

#[test]
fn a_history_round_trips() {
    let place = folder("history");
    let path = place.join("history.csv");
    let rows = [[0.1, 1.0 / 3.0], [f64::MIN_POSITIVE, -2.5e300]];
    let mut history = History::create(&path, &["time [s]", "force [N]"]).expect("file");
    for row in &rows {
        history.row(row).expect("row");
    }
    assert!(matches!(history.row(&[1.0]), Err(Error::Length { .. })));
    assert!(matches!(history.row(&[1.0, f64::NAN]), Err(Error::NotFinite { .. })));
    let text = std::fs::read_to_string(&path).expect("text");
    let read: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|x| x.parse().expect("number")).collect())
        .collect();
    assert_eq!(read, rows);
}

#[test]
fn a_map_shows_low_and_high() {
    let place = folder("two");
    let path = place.join("map.png");
    let positions = [SVector::<f64, 2>::new(0.5, 0.5), SVector::<f64, 2>::new(1.5, 0.5)];
    let map = FieldMap::new(&positions, 1.0, &[0.0, 1.0]);
    map.colours(ColourMap::Damage).size(200).write(&path).expect("file");
    let image = Image::read(&path);
    // The map starts 24 pixels from the left and 48 from the top.
    assert_eq!(image.at(24 + 50, 48 + 50), ColourMap::Damage.colour(0.0));
    assert_eq!(image.at(24 + 150, 48 + 50), ColourMap::Damage.colour(1.0));
}
