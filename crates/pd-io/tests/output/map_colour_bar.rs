//! What the colour bar says.
use super::common;

use common::{EXTREME, Image, folder};
use nalgebra::SVector;
use pd_io::{ColourMap, Error, FieldMap};

fn row(nodes: usize) -> Vec<SVector<f64, 2>> {
    (0..nodes).map(|k| SVector::from([k as f64, 0.0])).collect()
}

/// Pictures of the five labels beside a map of 300 × `height` pixels.
fn labels(image: &Image, height: usize) -> Vec<Vec<[u8; 3]>> {
    let bar = height.max(160);
    let left = 24 + 300 + 24 + 22 + 9;
    let at = |t: f64| 48 + ((1.0 - t) * (bar - 1) as f64).round() as usize - 4;
    let label = |t: f64| image.part(left..image.width, at(t)..at(t) + 8);
    [0.0, 0.25, 0.5, 0.75, 1.0].map(label).to_vec()
}

#[test]
fn labels_differ_even_of_a_constant_field() {
    let place = folder("constant");
    let path = place.join("map.png");
    let fields = EXTREME.iter().flat_map(|&v| [[v; 3], [-v; 3]]);
    let fields = fields.chain([[1e9, 1e9 + 0.5, 1e9 + 1.0], [f64::MIN, 0.0, f64::MAX]]);
    for values in fields {
        for colours in [ColourMap::Viridis, ColourMap::Damage, ColourMap::Diverging] {
            let map = FieldMap::new(&row(3), 1.0, &values).size(300).colours(colours);
            map.write(&path).expect("map");
            let mut pictures = labels(&Image::read(&path), 100);
            pictures.sort();
            pictures.dedup();
            assert_eq!(pictures.len(), 5, "{values:?}, {colours:?}");
        }
    }
}

#[test]
fn white_is_zero() {
    let place = folder("white");
    let path = place.join("map.png");
    let white = ColourMap::Diverging.colour(0.5);
    for values in [[-1.0, 0.0, 4.0], [-4.0, 0.0, 1.0], [0.0, 0.0, 3.0], [0.0, 0.0, f64::MAX]] {
        let map = FieldMap::new(&row(3), 1.0, &values).size(300).colours(ColourMap::Diverging);
        map.write(&path).expect("map");
        let image = Image::read(&path);
        assert_eq!(image.at(24 + 150, 48 + 50), white, "{values:?}");
        for (k, value) in values.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            assert_ne!(image.at(24 + 50 + 100 * k, 48 + 50), white, "{value}");
        }
    }
    // A range that was asked for is taken as it is.
    let map = FieldMap::new(&row(1), 1.0, &[0.0]).size(300).colours(ColourMap::Diverging);
    map.range(0.0, 1.0).write(&path).expect("map");
    assert_eq!(Image::read(&path).at(24 + 150, 48 + 150), ColourMap::Diverging.colour(0.0));
}

#[test]
fn ranges_and_cells_without_a_meaning_are_refused() {
    let place = folder("refused");
    let path = place.join("map.png");
    let map = || FieldMap::new(&row(2), 1.0, &[0.0, 1.0]);
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    for (low, high) in [(nan, 1.0), (0.0, nan), (1.0, 1.0), (2.0, 1.0), (0.0, inf), (-inf, 0.0)] {
        let told = map().range(low, high).write(&path);
        assert!(matches!(told, Err(Error::Range { .. })), "{low} to {high}: {told:?}");
    }
    for cell in [0.0, -0.0, -1.0, nan, inf] {
        let told = FieldMap::new(&row(2), cell, &[0.0, 1.0]).write(&path);
        assert!(matches!(told, Err(Error::Cell { .. })), "{cell}: {told:?}");
    }
    let none = FieldMap::new(&[], 1.0, &[]).write(&path);
    assert!(matches!(none, Err(Error::Empty { .. })), "{none:?}");
    assert!(!path.exists(), "nothing is written");
}

#[test]
fn any_finite_place_and_cell_is_drawn() {
    let place = folder("places");
    let path = place.join("map.png");
    let triples = EXTREME.iter().flat_map(|&x| {
        EXTREME[1..].iter().flat_map(move |&other| [(x, other, 1.0), (x, -x, other)])
    });
    for (x, y, cell) in triples {
        let positions = [SVector::from([x, y]), SVector::from([-y, x])];
        let map = FieldMap::new(&positions, cell, &[0.0, 1.0]).size(64);
        map.write(&path).expect("map");
        let image = Image::read(&path);
        let inside = image.part(24..image.width.min(24 + 64), 48..image.height.min(48 + 64));
        // One of the two may lie on the other; then the pixel is their mean.
        let seen = [0.5, 1.0].map(|t| ColourMap::Viridis.colour(t));
        assert!(inside.iter().any(|c| seen.contains(c)), "{x}, {y}, {cell}");
    }
}
