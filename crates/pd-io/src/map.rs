//! PNG maps of a nodal field on the (deformed) shape, with a colour bar.

use crate::canvas::{BLACK, Canvas, Colour, GLYPH, GREY, short, text_width};
use crate::error::{Error, Result, finite};
use nalgebra::SVector;
use std::path::Path;

/// Colours of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// Dark violet over green to yellow: the same steps in print and for the colour-blind.
    #[default]
    Viridis,
    /// Blue (intact) to red (broken).
    Damage,
    /// Blue, white, red: for fields with a sign.
    Diverging,
}

impl ColourMap {
    fn stops(self) -> &'static [Colour] {
        match self {
            Self::Viridis => &[
                [68, 1, 84],
                [72, 40, 120],
                [62, 74, 137],
                [49, 104, 142],
                [38, 130, 142],
                [31, 158, 137],
                [53, 183, 121],
                [109, 205, 89],
                [180, 222, 44],
                [253, 231, 37],
            ],
            Self::Damage => {
                &[[28, 50, 120], [45, 125, 190], [120, 200, 210], [250, 220, 120], [200, 30, 30]]
            }
            Self::Diverging => {
                &[[33, 60, 150], [130, 170, 215], [245, 245, 245], [230, 140, 115], [165, 20, 35]]
            }
        }
    }
    /// Colour of a value in [0, 1].
    pub fn colour(self, t: f64) -> [u8; 3] {
        let stops = self.stops();
        let place = t.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
        let low = (place as usize).min(stops.len() - 2);
        let part = place - low as f64;
        std::array::from_fn(|k| {
            let (a, b) = (f64::from(stops[low][k]), f64::from(stops[low + 1][k]));
            (a + part * (b - a)).round() as u8
        })
    }
}

/// A map: every node is a square of its cell's size.
#[derive(Debug, Clone)]
pub struct FieldMap {
    positions: Vec<SVector<f64, 2>>,
    cell: f64,
    values: Vec<f64>,
    title: String,
    range: Option<(f64, f64)>,
    colours: ColourMap,
    width: usize,
}

const MARGIN: i64 = 24;
const BAR: i64 = 22;

impl FieldMap {
    /// Of these values at these (deformed) positions, with cells of edge `cell`, in metres.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NotFinite`], [`Error::Empty`].
    pub fn new(positions: &[SVector<f64, 2>], cell: f64, values: &[f64]) -> Result<Self> {
        let (given, nodes) = (values.len(), positions.len());
        if given != nodes {
            return Err(Error::Length { field: "map".to_owned(), given, nodes });
        }
        if nodes == 0 {
            return Err(Error::Empty("map".to_owned()));
        }
        finite("map", values, 1)?;
        finite("position", positions.iter().flat_map(|p| p.iter()), 2)?;
        Ok(Self {
            positions: positions.to_vec(),
            cell,
            values: values.to_vec(),
            title: String::new(),
            range: None,
            colours: ColourMap::default(),
            width: 640,
        })
    }
    /// Title above the map.
    pub fn title(mut self, title: &str) -> Self {
        title.clone_into(&mut self.title);
        self
    }
    /// Values of the ends of the colour bar (by default the extremes of the field).
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }
    /// Colours.
    pub fn colours(mut self, colours: ColourMap) -> Self {
        self.colours = colours;
        self
    }
    /// Longer edge of the map itself in pixels.
    pub fn size(mut self, pixels: usize) -> Self {
        self.width = pixels.max(64);
        self
    }
    /// Writes the PNG.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Png`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let half = SVector::<f64, 2>::repeat(0.5 * self.cell);
        let (mut low, mut high) = (self.positions[0] - half, self.positions[0] + half);
        for p in &self.positions {
            low = low.inf(&(p - half));
            high = high.sup(&(p + half));
        }
        let extent = high - low;
        let scale = self.width as f64 / extent.max();
        let (w, h) = ((extent.x * scale).ceil() as i64, (extent.y * scale).ceil() as i64);
        let top = MARGIN + 3 * GLYPH;
        let labels = 11 * GLYPH;
        let total = (w + 3 * MARGIN + BAR + labels).max(2 * MARGIN + text_width(&self.title, 2));
        let bar_height = h.max(160);
        let mut canvas = Canvas::new(total, top + bar_height + MARGIN);
        canvas.text(MARGIN, MARGIN - 10, 2, &self.title);

        let span = |values: &[f64]| {
            values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)))
        };
        let (from, to) = self.range.unwrap_or_else(|| span(&self.values));
        let to = if to > from { to } else { from + from.abs().max(1.0) * 1e-9 };
        for (p, value) in self.positions.iter().zip(&self.values) {
            let pixel = |x: f64| (x * scale).floor() as i64;
            // One pixel of overlap: no seams where the cells move apart by less than that.
            let x = [pixel(p.x - half.x - low.x), pixel(p.x + half.x - low.x) + 1];
            let y = [pixel(high.y - p.y - half.y), pixel(high.y - p.y + half.y) + 1];
            let place = |r: [i64; 2], by: i64, end: i64| [r[0] + by, r[1].min(end) + by];
            let colour = self.colours.colour((value - from) / (to - from));
            canvas.fill(place(x, MARGIN, w), place(y, top, h), colour);
        }
        canvas.frame([MARGIN - 1, MARGIN + w + 1], [top - 1, top + h + 1], GREY);

        let left = 2 * MARGIN + w;
        for row in 0..bar_height {
            let t = 1.0 - (row as f64 + 0.5) / bar_height as f64;
            canvas.fill([left, left + BAR], [top + row, top + row + 1], self.colours.colour(t));
        }
        canvas.frame([left, left + BAR], [top, top + bar_height], BLACK);
        for k in 0..5 {
            let t = f64::from(k) / 4.0;
            let y = top + ((1.0 - t) * (bar_height - 1) as f64).round() as i64;
            canvas.fill([left + BAR, left + BAR + 5], [y, y + 1], BLACK);
            canvas.text(left + BAR + 9, y - GLYPH / 2, 1, &short(from + t * (to - from)));
        }
        canvas.write(path.as_ref())
    }
}
