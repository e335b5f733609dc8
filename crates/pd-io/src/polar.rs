//! Polar charts: r(θ) of moduli and wave speeds, the pictures of an elasticity tensor.

use crate::axis::{Axis, extremes};
use crate::canvas::{
    BLACK, Canvas, GLYPH, GREY, LEGEND_ROW, curve_colour, legend_width, text_width,
};
use crate::error::{Error, Result, finite};
use std::f64::consts::TAU;
use std::path::Path;

/// Radius of the chart in pixels, and its upper edge.
const RADIUS: i64 = 240;
const TOP: i64 = 70;
const MARGIN: i64 = 56;

/// Closed curves r(θ) about a point.
#[derive(Debug, Clone)]
pub struct PolarPlot {
    title: String,
    label: String,
    curves: Vec<(String, Vec<(f64, f64)>)>,
}

impl PolarPlot {
    /// With a title and a label of the radius (with its unit).
    pub fn new(title: &str, radius: &str) -> Self {
        Self { title: title.to_owned(), label: radius.to_owned(), curves: Vec::new() }
    }
    /// Adds a curve through points (θ in radians, r ≥ 0), closed by a line from the last to the
    /// first.
    pub fn curve(mut self, name: &str, points: &[(f64, f64)]) -> Self {
        self.curves.push((name.to_owned(), points.to_vec()));
        self
    }
    /// Writes the PNG.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::NotFinite`] and, for a negative radius, [`Error::OffAxis`] (both
    /// with the curve and the point), [`Error::File`], [`Error::Png`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        self.check(path)?;
        let points = self.curves.iter().flat_map(|(_, points)| points);
        let (_, largest) = extremes(points.map(|p| p.1));
        let axis = Axis::linear(0.0, largest.max(0.0)).with_room(0.0, 0.05);

        let names = || self.curves.iter().map(|(name, _)| name.as_str());
        let (right, bottom) = (2 * (MARGIN + RADIUS), TOP + 2 * RADIUS + MARGIN);
        let mut canvas = Canvas::new(
            right + 16 + legend_width(names()) + 16,
            bottom.max(TOP + LEGEND_ROW * self.curves.len() as i64 + 16),
        );
        canvas.text(16, 14, 2, &self.title);
        let centre = ((MARGIN + RADIUS) as f64, (TOP + RADIUS) as f64);
        let at = |angle: f64, place: f64| {
            let r = place * RADIUS as f64;
            (centre.0 + r * angle.cos(), centre.1 - r * angle.sin())
        };
        let circle = |place: f64| -> Vec<_> {
            (0..=360).map(|k| at(TAU * f64::from(k) / 360.0, place)).collect()
        };
        for step in 0..12 {
            let angle = TAU * f64::from(step) / 12.0;
            canvas.polyline(&[centre, at(angle, 1.0)], 1, GREY);
            let label = format!("{}°", 30 * step);
            let (x, y) = at(angle, 1.0 + 22.0 / RADIUS as f64);
            let (x, y) = (x.round() as i64, y.round() as i64);
            canvas.text(x - text_width(&label, 1) / 2, y - GLYPH / 2, 1, &label);
        }
        let ticks = axis.ticks(7);
        for (place, _) in &ticks {
            canvas.polyline(&circle(*place), 1, GREY);
        }
        canvas.polyline(&circle(1.0), 1, BLACK);
        for (k, (_, points)) in self.curves.iter().enumerate() {
            let mut places: Vec<_> = points.iter().map(|p| at(p.0, axis.place(p.1))).collect();
            if let [first, _, ..] = places[..] {
                places.push(first);
            }
            canvas.polyline(&places, 2, curve_colour(k));
        }
        // Over the curves, between two rays: radii must be readable.
        for (place, label) in ticks.iter().filter(|(place, _)| *place > 0.0) {
            let (x, y) = at(TAU * 75.0 / 360.0, *place);
            canvas.text(x.round() as i64 + 3, y.round() as i64 - GLYPH / 2, 1, label);
        }
        canvas.text(right + 16, TOP - 24, 1, &self.label);
        canvas.legend(right + 16, TOP, names());
        canvas.write(path)
    }
    fn check(&self, path: &Path) -> Result<()> {
        if self.curves.iter().all(|(_, points)| points.is_empty()) {
            return Err(Error::Empty { path: path.to_owned(), what: "point" });
        }
        for (name, points) in &self.curves {
            finite(path, name, points.iter().flat_map(|(angle, r)| [angle, r]), 2)?;
            if let Some(node) = points.iter().position(|p| p.1 < 0.0) {
                return Err(Error::OffAxis {
                    path: path.to_owned(),
                    field: name.clone(),
                    node,
                    value: points[node].1,
                    needs: "a radius is not negative",
                });
            }
        }
        Ok(())
    }
}
