//! PNG maps of a nodal field on the (deformed) shape, with a colour bar.

use crate::axis::{Axis, extremes, safe_power};
use crate::canvas::{BLACK, Canvas, Colour, GLYPH, GREY, text_width};
use crate::error::{Error, Result, finite, one_per_node};
use nalgebra::SVector;
use std::path::Path;

/// Colours of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// Dark violet over green to yellow: the same steps in print and for the colour-blind.
    #[default]
    Viridis,
    /// Blue (intact) to red (broken). Where nodes share a pixel it shows the largest value and not
    /// the mean: a crack one node wide stays visible on a fine plate.
    Damage,
    /// Blue, white, red: for fields with a sign; white is 0 unless a range is given.
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

/// A map: every node is a square of its cell's size. A pixel shows the mean over the nodes that
/// share it, weighted by area (of [`ColourMap::Damage`] the largest value).
///
/// What it holds is checked when it is written, so that an error names the file.
#[derive(Debug, Clone)]
pub struct FieldMap {
    positions: Vec<SVector<f64, 2>>,
    cell: f64,
    values: Vec<f64>,
    title: String,
    range: Option<(f64, f64)>,
    colours: ColourMap,
    size: usize,
}

const MARGIN: i64 = 24;
const BAR: i64 = 22;

impl FieldMap {
    /// Of these values at these (deformed) positions, with cells of edge `cell`, in metres.
    pub fn new(positions: &[SVector<f64, 2>], cell: f64, values: &[f64]) -> Self {
        Self {
            positions: positions.to_vec(),
            cell,
            values: values.to_vec(),
            title: String::new(),
            range: None,
            colours: ColourMap::default(),
            size: 640,
        }
    }
    /// Title above the map.
    pub fn title(mut self, title: &str) -> Self {
        title.clone_into(&mut self.title);
        self
    }
    /// Values of the ends of the colour bar (by default the extremes of the field, and of
    /// [`ColourMap::Diverging`] ± the largest modulus).
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }
    /// Colours.
    pub fn colours(mut self, colours: ColourMap) -> Self {
        self.colours = colours;
        self
    }
    /// Longer edge of the map itself in pixels, 64 to 8192.
    pub fn size(mut self, pixels: usize) -> Self {
        self.size = pixels.clamp(64, 8192);
        self
    }
    /// Writes the PNG.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::Length`], [`Error::NotFinite`], [`Error::Cell`],
    /// [`Error::Range`], [`Error::File`], [`Error::Png`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        self.check(path)?;
        let axis = self.axis();
        let raster = Raster::of(self, &axis);
        let (w, h) = (raster.width as i64, raster.height as i64);

        let top = MARGIN + 3 * GLYPH;
        let left = 2 * MARGIN + w;
        let bar_height = h.max(160);
        let labels = axis.quarters();
        let widest = labels.iter().map(|(_, label)| text_width(label, 1)).max().unwrap_or(0);
        let total = left + BAR + 9 + widest + MARGIN;
        let mut canvas = Canvas::new(
            total.max(2 * MARGIN + text_width(&self.title, 2)),
            top + bar_height + MARGIN,
        );
        canvas.text(MARGIN, MARGIN - 10, 2, &self.title);
        for (k, pixel) in raster.pixels.iter().enumerate() {
            if let Some(place) = pixel.place() {
                let (x, y) = (k as i64 % w, k as i64 / w);
                canvas.put(MARGIN + x, top + y, self.colours.colour(place));
            }
        }
        canvas.frame([MARGIN - 1, MARGIN + w + 1], [top - 1, top + h + 1], GREY);

        for row in 0..bar_height {
            let t = 1.0 - (row as f64 + 0.5) / bar_height as f64;
            canvas.fill([left, left + BAR], [top + row, top + row + 1], self.colours.colour(t));
        }
        canvas.frame([left, left + BAR], [top, top + bar_height], BLACK);
        for (place, label) in labels {
            let y = top + ((1.0 - place) * (bar_height - 1) as f64).round() as i64;
            canvas.fill([left + BAR, left + BAR + 5], [y, y + 1], BLACK);
            canvas.text(left + BAR + 9, y - GLYPH / 2, 1, &label);
        }
        canvas.write(path)
    }
    fn check(&self, path: &Path) -> Result<()> {
        let nodes = self.positions.len();
        if nodes == 0 {
            return Err(Error::Empty { path: path.to_owned(), what: "node" });
        }
        let field = if self.title.is_empty() { "map" } else { &self.title };
        one_per_node(path, field, self.values.len(), nodes)?;
        finite(path, field, &self.values, 1)?;
        finite(path, "position", self.positions.iter().flat_map(|p| p.iter()), 2)?;
        if !(self.cell.is_finite() && self.cell > 0.0) {
            return Err(Error::Cell { path: path.to_owned(), cell: self.cell });
        }
        match self.range {
            Some((low, high)) if !(low.is_finite() && high.is_finite() && low < high) => {
                Err(Error::Range { path: path.to_owned(), low, high })
            }
            _ => Ok(()),
        }
    }
    fn axis(&self) -> Axis {
        let (low, high) = self.range.unwrap_or_else(|| {
            let (low, high) = extremes(self.values.iter().copied());
            match self.colours {
                ColourMap::Diverging => (-low.abs().max(high.abs()), low.abs().max(high.abs())),
                ColourMap::Viridis | ColourMap::Damage => (low, high),
            }
        });
        Axis::linear(low, high)
    }
}

/// The pixels of a map.
struct Raster {
    width: usize,
    height: usize,
    pixels: Vec<Pixel>,
}

/// What the nodes of a pixel add up to.
#[derive(Clone, Copy, Default)]
struct Pixel {
    /// Area that nodes cover.
    area: f64,
    /// Places on the colour bar times areas.
    sum: f64,
}

impl Pixel {
    fn place(self) -> Option<f64> {
        (self.area > 0.0).then(|| self.sum / self.area)
    }
}

impl Raster {
    fn of(map: &FieldMap, axis: &Axis) -> Self {
        let all = || map.positions.iter().flat_map(|p| p.iter());
        let unit = 10_f64.powi(safe_power(all().fold(map.cell, |most, x| most.max(x.abs()))));
        let cell = map.cell * unit;
        let (left, right) = extremes(map.positions.iter().map(|p| p.x * unit));
        let (bottom, top) = extremes(map.positions.iter().map(|p| p.y * unit));
        let extent = [right - left + cell, top - bottom + cell];
        let longer = extent[0].max(extent[1]).max(f64::MIN_POSITIVE);
        let pixels = |length: f64| length / longer * map.size as f64;
        let [width, height] = extent.map(|e| (pixels(e).ceil() as usize).max(1));
        // A hundredth of a pixel at least: no node vanishes.
        let edge = pixels(cell).max(0.01);

        let mut raster = Self { width, height, pixels: vec![Pixel::default(); width * height] };
        for (p, &value) in map.positions.iter().zip(&map.values) {
            let x = shares(pixels(p.x * unit - left), edge, width);
            let y = shares(pixels(top - p.y * unit), edge, height);
            // Far outside the range all are the same colour; sums must stay finite.
            let place = axis.place(value).clamp(-1e9, 1e9);
            for (row, high) in y {
                for (column, wide) in x.clone() {
                    raster.add(row * width + column, wide * high, place, map.colours);
                }
            }
        }
        raster
    }
    fn add(&mut self, at: usize, area: f64, place: f64, colours: ColourMap) {
        let pixel = &mut self.pixels[at];
        match colours {
            ColourMap::Damage => {
                let largest = pixel.place().map_or(place, |before| before.max(place));
                *pixel = Pixel { area: 1.0, sum: largest };
            }
            ColourMap::Viridis | ColourMap::Diverging => {
                pixel.area += area;
                pixel.sum += area * place;
            }
        }
    }
}

/// Pixels of a row that a cell from `start` covers, each with the length covered. Every pixel it
/// touches: no seams where cells move apart by less than one.
fn shares(start: f64, edge: f64, pixels: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
    let start = start.min(pixels as f64 - edge);
    let end = start + edge;
    // What rounding pushes over a border is no part of the cell.
    let least = 1e-6 * edge.min(1.0);
    (start as usize..pixels.min(end as usize + 1))
        .map(move |k| (k, end.min((k + 1) as f64) - start.max(k as f64)))
        .filter(move |(_, length)| *length > least)
}
