//! A chart draws any finite data.
mod common;

use common::{EXTREME, FIRST, Image, folder};
use pd_io::{LinePlot, PolarPlot};

/// Width in pixels of what is drawn of the first curve, the legend aside.
fn width(path: &std::path::Path) -> f64 {
    let image = Image::read(path);
    let frame = (0..image.width).rev().find(|&x| image.at(x, 449) == [20, 20, 20]);
    let right = frame.expect("frame") as f64;
    let places = image.places(FIRST).into_iter().map(|(x, _)| x).filter(|x| *x < right);
    let ends = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
    let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), ends);
    high + 1.0 - low
}

/// Lines between all pairs of these values, and each as a point.
fn draw_all(path: &std::path::Path, values: &[f64], plot: fn(LinePlot) -> LinePlot) {
    for (k, &a) in values.iter().enumerate() {
        for &b in &values[k..] {
            let points = if a == b { vec![(a, a)] } else { vec![(a, b), (b, a), (b, b)] };
            let line = LinePlot::new("any range", "x", "y").line("data", &points);
            plot(line).write(path).expect("plot");
            // 700 pixels, 3 % of the data's length free on both sides; or a dot.
            let wanted = if a == b { 6.0 } else { 700.0 / 1.06 };
            assert!((width(path) - wanted).abs() < 4.0, "{points:?}: {} pixels", width(path));
        }
    }
}

#[test]
fn linear_axes() {
    let path = folder("linear").join("plot.png");
    let values: Vec<f64> = EXTREME.into_iter().chain([-5e-324, -1.0, f64::MIN]).collect();
    draw_all(&path, &values, |plot| plot);
}

#[test]
fn logarithmic_axes() {
    let path = folder("logarithmic").join("plot.png");
    draw_all(&path, &EXTREME[1..], LinePlot::log_log);
}

#[test]
fn polar_axes() {
    let path = folder("polar-range").join("plot.png");
    for r in EXTREME {
        for angle in [5e-324, 1.0, f64::MAX] {
            let points = [(angle, r), (-angle, 0.5 * r), (0.0, r)];
            PolarPlot::new("any range", "r").curve("data", &points).write(&path).expect("plot");
            let image = Image::read(&path);
            let inside = image.places(FIRST).iter().filter(|(x, _)| *x < 592.0).count();
            assert!(inside >= 4, "{points:?}");
        }
    }
}
