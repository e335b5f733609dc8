//! A canvas of pixels with rectangles, lines and text (glyphs of the `font8x8` crate: no font
//! files, no system library).

use crate::error::{Error, Result, write_whole};
use font8x8::UnicodeFonts as _;
use std::path::Path;

/// Red, green, blue.
pub(crate) type Colour = [u8; 3];
pub(crate) const BLACK: Colour = [20, 20, 20];
pub(crate) const GREY: Colour = [205, 205, 205];
pub(crate) const WHITE: Colour = [255, 255, 255];
/// Pixels of a glyph at scale 1.
pub(crate) const GLYPH: i64 = 8;
/// Colours of the curves of a chart, in turn.
const CURVES: [Colour; 6] =
    [[31, 90, 170], [205, 60, 40], [40, 140, 80], [130, 80, 170], [220, 140, 20], [90, 90, 90]];
/// Width of the mark before a name of a legend.
const LEGEND_MARK: i64 = 32;
/// Height of a row of a legend.
pub(crate) const LEGEND_ROW: i64 = 16;

/// Colour of a chart's curve.
pub(crate) fn curve_colour(k: usize) -> Colour {
    CURVES[k % CURVES.len()]
}

pub(crate) struct Canvas {
    width: i64,
    height: i64,
    pixels: Vec<u8>,
}

impl Canvas {
    pub(crate) fn new(width: i64, height: i64) -> Self {
        let pixels = WHITE.repeat((width * height) as usize);
        Self { width, height, pixels }
    }
    pub(crate) fn put(&mut self, x: i64, y: i64, colour: Colour) {
        if (0..self.width).contains(&x) && (0..self.height).contains(&y) {
            let at = 3 * (y * self.width + x) as usize;
            self.pixels[at..at + 3].copy_from_slice(&colour);
        }
    }
    /// Fills the rectangle [x0, x1) × [y0, y1).
    pub(crate) fn fill(&mut self, x: [i64; 2], y: [i64; 2], colour: Colour) {
        for row in y[0].max(0)..y[1].min(self.height) {
            for column in x[0].max(0)..x[1].min(self.width) {
                self.put(column, row, colour);
            }
        }
    }
    pub(crate) fn frame(&mut self, x: [i64; 2], y: [i64; 2], colour: Colour) {
        self.fill([x[0], x[1]], [y[0], y[0] + 1], colour);
        self.fill([x[0], x[1]], [y[1] - 1, y[1]], colour);
        self.fill([x[0], x[0] + 1], y, colour);
        self.fill([x[1] - 1, x[1]], y, colour);
    }
    /// A line through points, `thick` pixels thick; a single point is a dot.
    pub(crate) fn polyline(&mut self, points: &[(f64, f64)], thick: i64, colour: Colour) {
        if let [only] = points {
            self.dot(*only, colour);
        }
        for pair in points.windows(2) {
            let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
            let steps = (x1 - x0).abs().max((y1 - y0).abs()).ceil().max(1.0) as i64;
            for k in 0..=steps {
                let t = k as f64 / steps as f64;
                let start = |a: f64, b: f64| (a + t * (b - a) - 0.5 * thick as f64).round() as i64;
                let (x, y) = (start(x0, x1), start(y0, y1));
                self.fill([x, x + thick], [y, y + thick], colour);
            }
        }
    }
    /// The mark of a point.
    pub(crate) fn dot(&mut self, at: (f64, f64), colour: Colour) {
        let (x, y) = (at.0.round() as i64, at.1.round() as i64);
        self.fill([x - 3, x + 3], [y - 3, y + 3], colour);
    }
    /// The names of a chart's curves, one below the other.
    pub(crate) fn legend<'a>(&mut self, x: i64, y: i64, names: impl Iterator<Item = &'a str>) {
        for (k, name) in names.enumerate() {
            let y = y + LEGEND_ROW * k as i64;
            self.fill([x, x + 24], [y + 2, y + 5], curve_colour(k));
            self.text(x + LEGEND_MARK, y, 1, name);
        }
    }
    /// Text with its upper left corner at (x, y).
    pub(crate) fn text(&mut self, x: i64, y: i64, scale: i64, text: &str) {
        for (i, c) in text.chars().enumerate() {
            let glyph = font8x8::BASIC_FONTS
                .get(c)
                .or_else(|| font8x8::LATIN_FONTS.get(c))
                .or_else(|| font8x8::GREEK_FONTS.get(c))
                .unwrap_or([0; 8]);
            for (row, bits) in glyph.iter().enumerate() {
                for column in (0..GLYPH).filter(|k| bits >> k & 1 == 1) {
                    let px = x + scale * (i as i64 * GLYPH + column);
                    let py = y + scale * row as i64;
                    self.fill([px, px + scale], [py, py + scale], BLACK);
                }
            }
        }
    }
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        let mut bytes = Vec::new();
        let encode = |bytes: &mut Vec<u8>| {
            let mut encoder = png::Encoder::new(bytes, self.width as u32, self.height as u32);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.write_header()?.write_image_data(&self.pixels)
        };
        encode(&mut bytes).map_err(|source| Error::Png { path: path.to_owned(), source })?;
        write_whole(path, &bytes)
    }
}

/// Width of a text in pixels.
pub(crate) fn text_width(text: &str, scale: i64) -> i64 {
    text.chars().count() as i64 * GLYPH * scale
}

/// Width of a legend with these names.
pub(crate) fn legend_width<'a>(names: impl Iterator<Item = &'a str>) -> i64 {
    names.map(|name| LEGEND_MARK + text_width(name, 1)).max().unwrap_or(0)
}
