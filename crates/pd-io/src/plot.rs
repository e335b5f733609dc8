//! Line charts of histories, profiles and convergence.

use crate::axis::{Axis, extremes};
use crate::canvas::{
    BLACK, Canvas, GLYPH, GREY, LEGEND_ROW, curve_colour, legend_width, text_width,
};
use crate::error::{Error, Result, finite};
use std::path::Path;

/// Edges of the field of a chart in pixels, and its upper edge.
const FIELD: [i64; 2] = [700, 400];
const TOP: i64 = 50;
const GAP: i64 = 16;

/// A chart of lines.
#[derive(Debug, Clone)]
pub struct LinePlot {
    title: String,
    labels: [String; 2],
    lines: Vec<(String, Vec<(f64, f64)>)>,
    /// Of the lines, those that are dots only.
    loose: Vec<bool>,
    log: bool,
}

impl LinePlot {
    /// With a title and axis labels (with units).
    pub fn new(title: &str, x: &str, y: &str) -> Self {
        let labels = [x.to_owned(), y.to_owned()];
        let (lines, loose) = (Vec::new(), Vec::new());
        Self { title: title.to_owned(), labels, lines, loose, log: false }
    }
    /// Adds a line through points; a single point is a dot.
    pub fn line(mut self, name: &str, points: &[(f64, f64)]) -> Self {
        self.lines.push((name.to_owned(), points.to_vec()));
        self.loose.push(false);
        self
    }
    /// Adds points that no line joins.
    pub fn dots(mut self, name: &str, points: &[(f64, f64)]) -> Self {
        self.lines.push((name.to_owned(), points.to_vec()));
        self.loose.push(true);
        self
    }
    /// Logarithmic axes and a dot at every point, for errors over grid spacings: an order of
    /// convergence is a slope.
    pub fn log_log(mut self) -> Self {
        self.log = true;
        self
    }
    /// Writes the PNG.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::NotFinite`], [`Error::OffAxis`] for a value that is not positive
    /// on logarithmic axes (each with the line, the axis and the point), [`Error::File`],
    /// [`Error::Png`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let x_axis = self.axis(path, 0, |p| p.0)?;
        let y_axis = self.axis(path, 1, |p| p.1)?;
        let (x_ticks, y_ticks) = (x_axis.ticks(6), y_axis.ticks(5));

        let widest = y_ticks.iter().map(|(_, label)| text_width(label, 1)).max().unwrap_or(0);
        let left = (widest + 24).max(100);
        let field_x = [left, left + FIELD[0]];
        let field_y = [TOP, TOP + FIELD[1]];
        let names = || self.lines.iter().map(|(name, _)| name.as_str());
        let legend = LEGEND_ROW * self.lines.len() as i64;
        let mut canvas = Canvas::new(
            field_x[1] + GAP + legend_width(names()) + GAP,
            (field_y[1] + 70).max(TOP + legend + GAP),
        );
        canvas.text(left, 14, 2, &self.title);
        let px = |place: f64| field_x[0] as f64 + place * FIELD[0] as f64;
        let py = |place: f64| field_y[1] as f64 - place * FIELD[1] as f64;
        let mut free = 0;
        for (place, label) in x_ticks {
            let at = px(place).round() as i64;
            canvas.fill([at, at + 1], field_y, GREY);
            let start = at - text_width(&label, 1) / 2;
            if start >= free {
                canvas.text(start, field_y[1] + 8, 1, &label);
                free = start + text_width(&label, 1) + GLYPH;
            }
        }
        for (place, label) in y_ticks {
            let at = py(place).round() as i64;
            canvas.fill(field_x, [at, at + 1], GREY);
            canvas.text(left - 8 - text_width(&label, 1), at - GLYPH / 2, 1, &label);
        }
        canvas.frame(field_x, field_y, BLACK);
        let centre = (field_x[0] + field_x[1]) / 2;
        let [x_label, y_label] = &self.labels;
        canvas.text(centre - text_width(x_label, 2) / 2, field_y[1] + 28, 2, x_label);
        canvas.text(8, TOP - 12, 1, y_label);
        for (k, (_, points)) in self.lines.iter().enumerate() {
            let places: Vec<_> =
                points.iter().map(|p| (px(x_axis.place(p.0)), py(y_axis.place(p.1)))).collect();
            if !self.loose[k] {
                canvas.polyline(&places, 2, curve_colour(k));
            }
            for &place in places.iter().filter(|_| self.log || self.loose[k]) {
                canvas.dot(place, curve_colour(k));
            }
        }
        canvas.legend(field_x[1] + GAP, TOP, names());
        canvas.write(path)
    }
    /// The axis over one coordinate of all points.
    fn axis(&self, path: &Path, which: usize, pick: fn(&(f64, f64)) -> f64) -> Result<Axis> {
        for (name, points) in &self.lines {
            let field = format!("{name}: {}", self.labels[which]);
            let values: Vec<f64> = points.iter().map(pick).collect();
            finite(path, &field, &values, 1)?;
            let bad = values.iter().enumerate().find(|(_, value)| self.log && **value <= 0.0);
            if let Some((node, &value)) = bad {
                let (path, needs) = (path.to_owned(), "a logarithmic axis needs values > 0");
                return Err(Error::OffAxis { path, field, node, value, needs });
            }
        }
        let (low, high) = extremes(self.lines.iter().flat_map(|(_, points)| points).map(pick));
        if low > high {
            return Err(Error::Empty { path: path.to_owned(), what: "point" });
        }
        let axis = if self.log { Axis::log(low, high) } else { Axis::linear(low, high) };
        Ok(axis.with_room(0.03, 0.03))
    }
}
