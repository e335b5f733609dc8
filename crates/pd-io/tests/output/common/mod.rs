//! Folders and decoded pictures for the tests.
#![allow(dead_code)] // every test uses a part

use std::path::{Path, PathBuf};

/// A new folder in cargo's own for tests; left in place, so that pictures can be looked at.
pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pd-io").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).expect("temporary folder");
    path
}

pub struct Image {
    pub width: usize,
    pub height: usize,
    pixels: Vec<u8>,
}

impl Image {
    pub fn read(path: &Path) -> Self {
        let file = std::io::BufReader::new(std::fs::File::open(path).expect("file"));
        let mut reader = png::Decoder::new(file).read_info().expect("png");
        let mut pixels = vec![0; reader.output_buffer_size().expect("size")];
        let info = reader.next_frame(&mut pixels).expect("frame");
        Self { width: info.width as usize, height: info.height as usize, pixels }
    }
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        let at = 3 * (y * self.width + x);
        [self.pixels[at], self.pixels[at + 1], self.pixels[at + 2]]
    }
    /// The pixels of a rectangle, row by row.
    pub fn part(&self, x: std::ops::Range<usize>, y: std::ops::Range<usize>) -> Vec<[u8; 3]> {
        y.flat_map(|y| x.clone().map(move |x| self.at(x, y))).collect()
    }
    /// Where a colour is.
    pub fn places(&self, colour: [u8; 3]) -> Vec<(f64, f64)> {
        let all = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        all.filter(|&(x, y)| self.at(x, y) == colour).map(|(x, y)| (x as f64, y as f64)).collect()
    }
}

/// Colours of the first two curves of a chart.
pub const FIRST: [u8; 3] = [31, 90, 170];
pub const SECOND: [u8; 3] = [205, 60, 40];

/// Values where differences overflow, vanish or round away.
pub const EXTREME: [f64; 12] = [
    0.0,
    5e-324,
    1e-320,
    f64::MIN_POSITIVE,
    1e-281,
    1e-9,
    1.0,
    1.0 + f64::EPSILON,
    1e15,
    1e281,
    1e308,
    f64::MAX,
];
