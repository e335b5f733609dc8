//! A chart draws any finite data.
use super::common;

use common::{EXTREME, FIRST, Image, folder};
use pd_io::{LinePlot, PolarPlot};

/// The first curve's pixels left of the legend; that they are there shows that nothing ran away.
fn drawn(path: &std::path::Path) -> usize {
    let image = Image::read(path);
    let frame = (0..image.width).rev().find(|&x| image.at(x, 449) == [20, 20, 20]);
    let right = frame.expect("frame") as f64;
    image.places(FIRST).iter().filter(|(x, _)| *x < right).count()
}

/// Lines between all pairs of these values, and each as a point.
fn draw_all(path: &std::path::Path, values: &[f64], plot: fn(LinePlot) -> LinePlot) {
    for (k, &a) in values.iter().enumerate() {
        for &b in &values[k..] {
            let points = if a == b { vec![(a, a)] } else { vec![(a, b), (b, a), (b, b)] };
            let line = LinePlot::new("any range", "x", "y").line("data", &points);
            plot(line).write(path).expect("plot");
            assert!(drawn(path) >= 4, "{points:?}");
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
