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
    /// A line two pixels thick.
    pub(crate) fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: Colour) {
        let steps = (to.0 - from.0).abs().max((to.1 - from.1).abs()).ceil().max(1.0) as i64;
        for k in 0..=steps {
            let t = k as f64 / steps as f64;
            let x = (from.0 + t * (to.0 - from.0)).round() as i64;
            let y = (from.1 + t * (to.1 - from.1)).round() as i64;
            self.fill([x, x + 2], [y, y + 2], colour);
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

/// A number in few characters.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-2..1e4).contains(&value.abs()) {
        let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 4) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.2e}")
    }
}

/// Round numbers that divide a range into about `count` parts.
pub(crate) fn ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    let raw = (high - low) / count as f64;
    let power = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * power).find(|s| *s >= raw);
    let step = step.unwrap_or(raw);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}
