//! Line charts of histories and profiles.

use crate::canvas::{BLACK, Canvas, Colour, GLYPH, GREY, short, text_width, ticks};
use crate::error::{Error, Result, finite};
use std::path::Path;

const COLOURS: [Colour; 6] =
    [[31, 90, 170], [205, 60, 40], [40, 140, 80], [130, 80, 170], [220, 140, 20], [90, 90, 90]];
const SIZE: [i64; 2] = [820, 520];
const FIELD_X: [i64; 2] = [100, 800];
const FIELD_Y: [i64; 2] = [50, 450];

/// A chart of lines.
#[derive(Debug, Clone)]
pub struct LinePlot {
    title: String,
    labels: [String; 2],
    lines: Vec<(String, Vec<(f64, f64)>)>,
}

impl LinePlot {
    /// With a title and axis labels (with units).
    pub fn new(title: &str, x: &str, y: &str) -> Self {
        Self { title: title.to_owned(), labels: [x.to_owned(), y.to_owned()], lines: Vec::new() }
    }
    /// Adds a line through points.
    pub fn line(mut self, name: &str, points: &[(f64, f64)]) -> Self {
        self.lines.push((name.to_owned(), points.to_vec()));
        self
    }
    /// Writes the PNG.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::NotFinite`], [`Error::File`], [`Error::Png`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let all = || self.lines.iter().flat_map(|(_, points)| points);
        if all().next().is_none() {
            return Err(Error::Empty(self.title.clone()));
        }
        for (name, points) in &self.lines {
            finite(name, points.iter().flat_map(|(x, y)| [x, y]), 2)?;
        }
        let range = |pick: fn(&(f64, f64)) -> f64| {
            let (low, high) = all()
                .map(pick)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            let pad = if high > low { 0.03 * (high - low) } else { low.abs().max(1.0) };
            (low - pad, high + pad)
        };
        let ((x0, x1), (y0, y1)) = (range(|p| p.0), range(|p| p.1));
        let px =
            |x: f64| FIELD_X[0] as f64 + (x - x0) / (x1 - x0) * (FIELD_X[1] - FIELD_X[0]) as f64;
        let py =
            |y: f64| FIELD_Y[1] as f64 - (y - y0) / (y1 - y0) * (FIELD_Y[1] - FIELD_Y[0]) as f64;

        let mut canvas = Canvas::new(SIZE[0], SIZE[1]);
        canvas.text(FIELD_X[0], 14, 2, &self.title);
        for x in ticks(x0, x1, 6) {
            let at = px(x).round() as i64;
            canvas.fill([at, at + 1], FIELD_Y, GREY);
            let label = short(x);
            canvas.text(at - text_width(&label, 1) / 2, FIELD_Y[1] + 8, 1, &label);
        }
        for y in ticks(y0, y1, 5) {
            let at = py(y).round() as i64;
            canvas.fill(FIELD_X, [at, at + 1], GREY);
            let label = short(y);
            canvas.text(FIELD_X[0] - 8 - text_width(&label, 1), at - GLYPH / 2, 1, &label);
        }
        canvas.frame(FIELD_X, FIELD_Y, BLACK);
        let centre = (FIELD_X[0] + FIELD_X[1]) / 2;
        let (x_label, y_label) = (&self.labels[0], &self.labels[1]);
        canvas.text(centre - text_width(x_label, 2) / 2, FIELD_Y[1] + 28, 2, x_label);
        canvas.text(8, FIELD_Y[0] - 12, 1, y_label);
        for (k, (name, points)) in self.lines.iter().enumerate() {
            let colour = COLOURS[k % COLOURS.len()];
            for pair in points.windows(2) {
                let place = |p: (f64, f64)| (px(p.0), py(p.1));
                canvas.line(place(pair[0]), place(pair[1]), colour);
            }
            let y = FIELD_Y[0] + 12 + 16 * k as i64;
            let x = FIELD_X[1] - 44 - text_width(name, 1);
            canvas.fill([x, x + 24], [y + 2, y + 5], colour);
            canvas.text(x + 30, y, 1, name);
        }
        canvas.write(path.as_ref())
    }
}
