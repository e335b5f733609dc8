//! The legend lies outside the axes.
use super::common;

use common::{FIRST, Image, SECOND, folder};
use pd_io::{LinePlot, PolarPlot};

/// Names of all lengths, more of them than fit beside the axes.
fn names(count: usize) -> Vec<String> {
    (0..count).map(|k| format!("curve {k} {}", "of a long name ".repeat(k % 5))).collect()
}

#[test]
fn beside_a_line_plot() {
    let place = folder("legend");
    for count in [1, 2, 7, 40] {
        let draw = |file: &str, named: bool| {
            let path = place.join(file);
            let plot = names(count).iter().fold(LinePlot::new("Legend", "x", "y"), |plot, name| {
                // Along the upper and the right edge, where a legend would be.
                let points = [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0)];
                plot.line(if named { name } else { "" }, &points)
            });
            plot.write(&path).expect("plot");
            Image::read(&path)
        };
        let (named, nameless) = (draw(&format!("{count}.png"), true), draw("nameless.png", false));
        // The axes with their labels; the mark of the legend begins right of them.
        let axes = |image: &Image| image.part(0..810, 0..520);
        assert!(axes(&named) == axes(&nameless), "{count} names");
        let lines = 50..50 + 16 * count;
        assert!(named.height >= lines.end && named.width > 816 + 32);
        // Every name is whole: nothing is drawn on the last columns.
        let last = named.part(named.width - 8..named.width, 0..named.height);
        assert!(last.iter().all(|&c| c == [255; 3]));
    }
}

#[test]
fn beside_a_polar_plot() {
    let place = folder("legend-polar");
    let circle = |r: f64| (0..360).map(|k| (f64::from(k).to_radians(), r)).collect::<Vec<_>>();
    let draw = |a: &str, b: &str| {
        let path = place.join(format!("{}.png", a.len()));
        let plot = PolarPlot::new("Legend", "r").curve(a, &circle(1.0)).curve(b, &circle(0.5));
        plot.write(&path).expect("plot");
        Image::read(&path)
    };
    let (named, nameless) = (draw("a rather long name of a curve", "short"), draw("", ""));
    let chart = |image: &Image| image.part(0..600, 0..606);
    assert!(chart(&named) == chart(&nameless));
    for colour in [FIRST, SECOND] {
        let marks = named.places(colour).iter().filter(|(x, _)| *x > 600.0).count();
        assert_eq!(marks, 24 * 3);
    }
}
