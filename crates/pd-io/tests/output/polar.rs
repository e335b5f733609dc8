//! Polar charts: radii and angles are true, curves are closed.
use super::common;

use common::{FIRST, Image, SECOND, folder};
use pd_io::{Error, PolarPlot};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Centre of the chart in pixels.
const CENTRE: (f64, f64) = (296.0, 310.0);

/// Radii and angles of the pixels of a colour.
fn places(image: &Image, colour: [u8; 3]) -> Vec<(f64, f64)> {
    let inside = image.places(colour).into_iter().filter(|(x, _)| *x < 592.0);
    // Lines are two pixels thick: their middle is half a pixel on.
    let from_centre = inside.map(|(x, y)| (x + 0.5 - CENTRE.0, CENTRE.1 - y - 0.5));
    from_centre.map(|(x, y)| (x.hypot(y), y.atan2(x).rem_euclid(TAU))).collect()
}

fn curve(r: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    (0..180).map(|k| TAU * f64::from(k) / 180.0).map(|angle| (angle, r(angle))).collect()
}

#[test]
fn radii_and_angles_are_true() {
    let path = folder("polar").join("moduli.png");
    // Two-fold, four-fold and none: a ply along 30°, a weave, an isotropic solid.
    let ply = |angle: f64| 20.0 + 100.0 * (angle - PI / 6.0).cos().powi(4);
    let plot = PolarPlot::new("Young's modulus in the plane", "E [GPa]")
        .curve("ply at 30°", &curve(ply))
        .curve("isotropic", &curve(|_| 60.0))
        .curve("weave", &curve(|angle| 60.0 - 25.0 * (2.0 * angle).sin().powi(2)));
    plot.write(&path).expect("plot");
    let image = Image::read(&path);
    // The largest radius lies 1/1.05 of the way out.
    let pixel = 240.0 / (1.05 * 120.0);
    let circle = places(&image, SECOND);
    assert!(circle.iter().all(|(r, _)| (r - 60.0 * pixel).abs() < 2.5), "no circle");
    for sector in 0..24 {
        let inside = |angle: f64| (angle / TAU * 24.0) as usize == sector;
        assert!(circle.iter().any(|(_, angle)| inside(*angle)), "a gap in sector {sector}");
    }
    for (r, angle) in places(&image, FIRST) {
        // Two pixels across; along the curve r changes by up to |dr/dθ| on two pixels' angle.
        let slack = 2.5 + (ply(angle + 2.0 / r) - ply(angle - 2.0 / r)).abs() * pixel;
        assert!((r - ply(angle) * pixel).abs() < slack, "r = {r} at {angle}");
    }
}

#[test]
fn curves_are_closed() {
    let path = folder("closed").join("square.png");
    let square: Vec<_> = (0..4).map(|k| (FRAC_PI_2 * f64::from(k), 2.0)).collect();
    PolarPlot::new("Square", "r").curve("square", &square).write(&path).expect("plot");
    let drawn = places(&Image::read(&path), FIRST);
    let side = 240.0 / 1.05 / 2_f64.sqrt();
    for quarter in 0..4 {
        let middle = FRAC_PI_2 * (f64::from(quarter) + 0.5);
        let near = drawn.iter().filter(|(_, angle)| (angle - middle).abs() < 0.02);
        let radii: Vec<f64> = near.map(|(r, _)| *r).collect();
        assert!(!radii.is_empty(), "side {quarter} is missing");
        assert!(radii.iter().all(|r| (r - side).abs() < 2.5), "{radii:?}");
    }
}

#[test]
fn the_origin_is_a_radius_and_negative_ones_are_not() {
    let path = folder("polar-refused").join("plot.png");
    let write = |r: f64| {
        PolarPlot::new("", "").curve("E", &[(0.0, 1.0), (1.0, r), (2.0, 1.0)]).write(&path)
    };
    let told = write(-1e-9);
    assert!(matches!(told, Err(Error::OffAxis { node: 1, .. })), "{told:?}");
    assert!(!path.exists(), "nothing is written");
    write(0.0).expect("plot");
}
