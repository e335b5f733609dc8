//! ParaView files: unstructured points with fields, and time series of them.
//!
//! A small writer of our own: `vtkio` 0.6 dates from 2021 and its 0.7 candidate pulls in a parser
//! with open security advisories; writing is all that is needed.

use crate::error::{Error, Result, finite, one_per_node, write_whole};
use nalgebra::{SMatrix, SVector};
use std::path::{Path, PathBuf};

/// Nodes and their fields at one time, as a VTK XML unstructured grid of vertices (`.vtu`).
///
/// What it holds is checked when it is written, so that an error names the file.
#[derive(Debug, Clone)]
pub struct Snapshot<const D: usize> {
    nodes: usize,
    points: Vec<f64>,
    fields: Vec<Field>,
}

#[derive(Debug, Clone)]
struct Field {
    name: String,
    /// Nodes that were given a value.
    given: usize,
    /// Components.
    parts: usize,
    values: Vec<f64>,
}

impl<const D: usize> Snapshot<D> {
    /// Points at these places in metres (usually reference positions; warp by the displacement).
    pub fn new(positions: &[SVector<f64, D>]) -> Self {
        Self { nodes: positions.len(), points: padded(positions), fields: Vec::new() }
    }
    fn with(mut self, name: &str, given: usize, parts: usize, values: Vec<f64>) -> Self {
        self.fields.push(Field { name: name.to_owned(), given, parts, values });
        self
    }
    /// Adds a scalar field.
    pub fn scalar(self, name: &str, values: &[f64]) -> Self {
        self.with(name, values.len(), 1, values.to_vec())
    }
    /// Adds a vector field (2D vectors get z = 0).
    pub fn vector(self, name: &str, values: &[SVector<f64, D>]) -> Self {
        self.with(name, values.len(), 3, padded(values))
    }
    /// Adds a tensor field (row by row; 2D tensors get zeros).
    pub fn tensor(self, name: &str, values: &[SMatrix<f64, D, D>]) -> Self {
        let entry = |m: &SMatrix<f64, D, D>, k: usize| {
            if k / 3 < D && k % 3 < D { m[(k / 3, k % 3)] } else { 0.0 }
        };
        let flat = values.iter().flat_map(|m| (0..9).map(move |k| entry(m, k))).collect();
        self.with(name, values.len(), 9, flat)
    }
    fn check(&self, path: &Path) -> Result<()> {
        finite(path, "position", &self.points, 3)?;
        for (k, Field { name, given, parts, values }) in self.fields.iter().enumerate() {
            one_per_node(path, name, *given, self.nodes)?;
            finite(path, name, values, *parts)?;
            let reason = if name.is_empty() {
                "is empty: name every field"
            } else if name.chars().any(not_in_xml) {
                "has a character that XML cannot hold: leave it out"
            } else if self.fields[..k].iter().any(|before| before.name == *name) {
                "is given to two fields: readers would show one of them"
            } else {
                continue;
            };
            return Err(Error::Name { path: path.to_owned(), name: name.clone(), reason });
        }
        Ok(())
    }
    /// The file's bytes.
    fn encode(&self) -> Vec<u8> {
        let n = self.nodes;
        let mut data: Vec<u8> = Vec::new();
        let mut append = |bytes: &mut dyn Iterator<Item = [u8; 8]>, count: usize| {
            let offset = data.len();
            data.extend((8 * count as u64).to_le_bytes());
            bytes.for_each(|b| data.extend(b));
            offset
        };
        let array = |name: &str, kind: &str, parts: usize, offset: usize| {
            let name = escaped(name);
            format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{parts}\" \
                 format=\"appended\" offset=\"{offset}\"/>\n"
            )
        };
        let mut floats = |name: &str, parts: usize, values: &[f64]| {
            let offset = append(&mut values.iter().map(|v| v.to_le_bytes()), values.len());
            array(name, "Float64", parts, offset)
        };
        let points = floats("points", 3, &self.points);
        let fields: String =
            self.fields.iter().map(|f| floats(&f.name, f.parts, &f.values)).collect();
        let mut integers = |name: &str, values: &mut dyn Iterator<Item = i64>| {
            let offset = append(&mut values.map(i64::to_le_bytes), n);
            array(name, "Int64", 1, offset)
        };
        let connectivity = integers("connectivity", &mut (0..n as i64));
        let offsets = integers("offsets", &mut (1..=n as i64));
        let types = integers("types", &mut (0..n).map(|_| 1));
        let mut out = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<UnstructuredGrid>\n\
             <Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{n}\">\n\
             <Points>\n{points}</Points>\n\
             <Cells>\n{connectivity}{offsets}{types}</Cells>\n\
             <PointData>\n{fields}</PointData>\n\
             </Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_"
        )
        .into_bytes();
        out.extend(data);
        out.extend(b"\n</AppendedData>\n</VTKFile>\n");
        out
    }
    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NotFinite`], [`Error::Name`] (empty, given twice, or with
    /// control characters), [`Error::File`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        self.check(path)?;
        write_whole(path, &self.encode())
    }
}

fn padded<const D: usize>(values: &[SVector<f64, D>]) -> Vec<f64> {
    values.iter().flat_map(|v| (0..3).map(move |d| if d < D { v[d] } else { 0.0 })).collect()
}

/// Characters that XML 1.0 has no way to write.
fn not_in_xml(c: char) -> bool {
    (c < ' ' && !['\t', '\n', '\r'].contains(&c)) || ['\u{fffe}', '\u{ffff}'].contains(&c)
}

/// A text as the value of an XML attribute (white space by number: readers would turn it into
/// blanks).
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\t' => out.push_str("&#9;"),
            '\n' => out.push_str("&#10;"),
            '\r' => out.push_str("&#13;"),
            c => out.push(c),
        }
    }
    out
}

/// A time series: `name_000000.vtu`, … and `name.pvd`, which ParaView opens. The `.pvd` is
/// rewritten after every step, so the series is complete after each of them.
#[derive(Debug)]
pub struct Series {
    folder: PathBuf,
    name: String,
    times: Vec<f64>,
}

impl Series {
    /// A series in this folder; replaces an older one of the same name.
    ///
    /// # Errors
    /// [`Error::Name`] for a name that is empty or no plain file name, [`Error::File`].
    pub fn create(folder: impl AsRef<Path>, name: &str) -> Result<Self> {
        let series = Self::named(folder.as_ref(), name)?;
        series.write_index(&[])?;
        Ok(series)
    }
    /// Goes on with a series: its steps up to the time `last` in seconds stay, later ones go.
    ///
    /// # Errors
    /// As [`create`](Self::create), [`Error::Unreadable`], and [`Error::Unfit`] for an index that
    /// no series wrote.
    pub fn resume(folder: impl AsRef<Path>, name: &str, last: f64) -> Result<Self> {
        let mut series = Self::named(folder.as_ref(), name)?;
        let path = series.path();
        let index = std::fs::read_to_string(&path).map_err(|e| Error::unreadable(&path, e))?;
        for entry in index.split("<DataSet timestep=\"").skip(1) {
            let time = entry.split('"').next().and_then(|time| time.parse::<f64>().ok());
            let no_time = || Error::unfit(&path, "has a step without a time".to_owned());
            series.times.push(time.ok_or_else(no_time)?);
        }
        series.times.retain(|&time| time <= last);
        series.write_index(&series.times)?;
        Ok(series)
    }
    fn named(folder: &Path, name: &str) -> Result<Self> {
        let folder = folder.to_owned();
        let reason = if name.is_empty() {
            Some("is empty: the files of a series start with it")
        } else if name.contains(['/', '\\']) {
            Some("has a slash: give the folder apart from the name")
        } else if name.chars().any(|c| c.is_control() || not_in_xml(c)) {
            Some("has a control character: leave it out")
        } else {
            None
        };
        if let Some(reason) = reason {
            return Err(Error::Name { path: folder, name: name.to_owned(), reason });
        }
        Ok(Self { folder, name: name.to_owned(), times: Vec::new() })
    }
    /// The `.pvd` file.
    pub fn path(&self) -> PathBuf {
        self.folder.join(format!("{}.pvd", self.name))
    }
    /// File of the step with this number.
    fn file(&self, step: usize) -> String {
        format!("{}_{step:06}.vtu", self.name)
    }
    fn write_index(&self, times: &[f64]) -> Result<()> {
        let entry = |(step, time): (usize, &f64)| {
            let file = escaped(&self.file(step));
            format!("<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{file}\"/>\n")
        };
        let entries: String = times.iter().enumerate().map(entry).collect();
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" \
             byte_order=\"LittleEndian\">\n<Collection>\n{entries}</Collection>\n</VTKFile>\n"
        );
        write_whole(&self.path(), text.as_bytes())
    }
    /// Adds a step at `time` in seconds. If it fails, the series is as before and the step may be
    /// tried again.
    ///
    /// # Errors
    /// [`Error::Time`] unless the time is larger than the last, [`Error::NotFinite`] for the time,
    /// and as [`Snapshot::write`].
    pub fn write<const D: usize>(&mut self, time: f64, snapshot: &Snapshot<D>) -> Result<()> {
        let step = self.times.len();
        if !time.is_finite() {
            let (path, field) = (self.path(), "time".to_owned());
            return Err(Error::NotFinite { path, field, node: step, value: time });
        }
        if let Some(&last) = self.times.last().filter(|&&last| time <= last) {
            return Err(Error::Time { path: self.path(), time, last });
        }
        snapshot.write(self.folder.join(self.file(step)))?;
        self.times.push(time);
        // A step is one only when the index has it.
        self.write_index(&self.times).inspect_err(|_| {
            self.times.pop();
        })
    }
}
