//! On logarithmic axes a power law is a straight line and its order the slope.
use super::common;

use common::{FIRST, Image, SECOND, folder};
use pd_io::{Error, LinePlot};

fn law(order: i32) -> Vec<(f64, f64)> {
    (0..40).map(|k| 10_f64.powf(-f64::from(k) / 13.0)).map(|h| (h, 3.0 * h.powi(order))).collect()
}

/// Slope of the pixels of a colour (upwards), and their largest distance from that line.
fn slope(image: &Image, colour: [u8; 3]) -> (f64, f64) {
    let points = image.places(colour);
    let points: Vec<_> = points.iter().filter(|(x, _)| *x < 810.0).collect();
    let n = points.len() as f64;
    let mean = |pick: fn(&(f64, f64)) -> f64| points.iter().map(|p| pick(p)).sum::<f64>() / n;
    let (x0, y0) = (mean(|p| p.0), mean(|p| p.1));
    let xy: f64 = points.iter().map(|p| (p.0 - x0) * (p.1 - y0)).sum();
    let xx: f64 = points.iter().map(|p| (p.0 - x0).powi(2)).sum();
    let slope = xy / xx;
    let off = points.iter().map(|p| (p.1 - y0 - slope * (p.0 - x0)).abs()).fold(0.0, f64::max);
    (-slope, off)
}

#[test]
fn orders_are_slopes() {
    let path = folder("log-log").join("convergence.png");
    let plot = LinePlot::new("Convergence", "h [m]", "error").log_log();
    plot.line("order 2", &law(2)).line("order 1", &law(1)).write(&path).expect("plot");
    let image = Image::read(&path);
    let ((second, off_2), (first, off_1)) = (slope(&image, FIRST), slope(&image, SECOND));
    // Dots are six pixels wide; the slopes are in pixels, their ratio is that of the orders.
    assert!(off_2 < 6.0 && off_1 < 6.0, "not straight: {off_2}, {off_1}");
    assert!((second / first - 2.0).abs() < 0.05, "{second} and {first}");
}

#[test]
fn values_without_a_logarithm_are_refused() {
    let path = folder("log-refused").join("plot.png");
    for bad in [(0.0, 1.0), (1.0, 0.0), (-1.0, 1.0), (1.0, -5e-324), (-0.0, 1.0)] {
        let plot =
            LinePlot::new("", "x", "y").line("a", &[(1.0, 1.0)]).line("b", &[(2.0, 2.0), bad]);
        plot.clone().write(&path).expect("linear axes take it");
        std::fs::remove_file(&path).expect("file");
        let told = plot.log_log().write(&path);
        assert!(matches!(told, Err(Error::OffAxis { node: 1, .. })), "{bad:?}: {told:?}");
        assert!(!path.exists(), "nothing is written");
    }
}
