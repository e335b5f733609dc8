//! ParaView files: unstructured points with fields, and time series of them.
//!
//! A small writer of our own: `vtkio` 0.6 dates from 2021 and its 0.7 candidate pulls in a parser
//! with open security advisories; writing is all that is needed.

use crate::error::{Error, Result, finite, write_whole};
use nalgebra::{SMatrix, SVector};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Nodes and their fields at one time, as a VTK XML unstructured grid of vertices (`.vtu`).
#[derive(Debug, Clone)]
pub struct Snapshot<const D: usize> {
    nodes: usize,
    points: Vec<f64>,
    /// Name, components, values.
    fields: Vec<(String, usize, Vec<f64>)>,
}

impl<const D: usize> Snapshot<D> {
    /// Points at these places in metres (usually reference positions; warp by the displacement).
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(positions: &[SVector<f64, D>]) -> Result<Self> {
        let points = padded(positions);
        finite("position", &points, 3)?;
        Ok(Self { nodes: positions.len(), points, fields: Vec::new() })
    }
    fn with(mut self, name: &str, given: usize, parts: usize, values: Vec<f64>) -> Result<Self> {
        if given != self.nodes {
            return Err(Error::Length { field: name.to_owned(), given, nodes: self.nodes });
        }
        finite(name, &values, parts)?;
        self.fields.push((name.to_owned(), parts, values));
        Ok(self)
    }
    /// Adds a scalar field.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NotFinite`].
    pub fn scalar(self, name: &str, values: &[f64]) -> Result<Self> {
        self.with(name, values.len(), 1, values.to_vec())
    }
    /// Adds a vector field (2D vectors get z = 0).
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NotFinite`].
    pub fn vector(self, name: &str, values: &[SVector<f64, D>]) -> Result<Self> {
        self.with(name, values.len(), 3, padded(values))
    }
    /// Adds a tensor field (row by row; 2D tensors get zeros).
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NotFinite`].
    pub fn tensor(self, name: &str, values: &[SMatrix<f64, D, D>]) -> Result<Self> {
        let entry = |m: &SMatrix<f64, D, D>, k: usize| {
            if k / 3 < D && k % 3 < D { m[(k / 3, k % 3)] } else { 0.0 }
        };
        let flat = values.iter().flat_map(|m| (0..9).map(move |k| entry(m, k))).collect();
        self.with(name, values.len(), 9, flat)
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
            self.fields.iter().map(|(name, parts, values)| floats(name, *parts, values)).collect();
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
    /// [`Error::File`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        write_whole(path.as_ref(), &self.encode())
    }
}

fn padded<const D: usize>(values: &[SVector<f64, D>]) -> Vec<f64> {
    values.iter().flat_map(|v| (0..3).map(move |d| if d < D { v[d] } else { 0.0 })).collect()
}

/// A time series: `name_000000.vtu`, … and `name.pvd`, which ParaView opens. The `.pvd` is
/// rewritten after every step, so the series is complete after each of them.
#[derive(Debug)]
pub struct Series {
    folder: PathBuf,
    name: String,
    entries: String,
    count: usize,
}

impl Series {
    /// A series in this folder; replaces an older one of the same name.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn create(folder: impl AsRef<Path>, name: &str) -> Result<Self> {
        let folder = folder.as_ref().to_owned();
        let series = Self { folder, name: name.to_owned(), entries: String::new(), count: 0 };
        series.write_index()?;
        Ok(series)
    }
    /// The `.pvd` file.
    pub fn path(&self) -> PathBuf {
        self.folder.join(format!("{}.pvd", self.name))
    }
    fn write_index(&self) -> Result<()> {
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" \
             byte_order=\"LittleEndian\">\n<Collection>\n{}</Collection>\n</VTKFile>\n",
            self.entries
        );
        write_whole(&self.path(), text.as_bytes())
    }
    /// Adds a step at `time` in seconds.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NotFinite`] for the time.
    pub fn write<const D: usize>(&mut self, time: f64, snapshot: &Snapshot<D>) -> Result<()> {
        finite("time", [&time], 1)?;
        let file = format!("{}_{:06}.vtu", self.name, self.count);
        snapshot.write(self.folder.join(&file))?;
        self.count += 1;
        // Writing to a String cannot fail.
        let _ =
            writeln!(self.entries, "<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{file}\"/>");
        self.write_index()
    }
}
